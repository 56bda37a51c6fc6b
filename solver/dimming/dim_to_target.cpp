#include "solver/dimming/dim_to_target.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/dimming/linear_programme.h"
#include "solver/model/assert.h"

namespace clerestory {
namespace {

double mean_of(const std::vector<double>& lux) {
  return std::accumulate(lux.begin(), lux.end(), 0.0) / static_cast<double>(lux.size());
}

/// Adds "sum over k of light[k] d_k + given >= at_least", in units of the target.
void add_condition(LinearProgramme& p, std::span<const double> light, double given, double at_least, double lux) {
  for (const double E : light) p.A.push_back(E / lux);
  p.at_least.push_back((at_least - given) / lux);
}

/// All targets, and this uniformity (0: none).
LinearProgramme programme_of(std::span<const double> flux_lm, std::span<const DimTarget> targets, double uniformity,
                             double most) {
  const std::size_t D = flux_lm.size();
  const double all_flux = std::accumulate(flux_lm.begin(), flux_lm.end(), 0.0);
  LinearProgramme p;
  for (const double flux : flux_lm) p.cost.push_back(all_flux > 0 ? flux / all_flux : 0);
  p.upper.assign(D, most);
  for (const DimTarget& t : targets) {
    const double given = mean_of(t.given);
    std::vector<double> mean(D), light(D);
    for (std::size_t k = 0; k < D; ++k) mean[k] = mean_of(t.of_layer[k]);
    if (!t.of_minimum) add_condition(p, mean, given, t.lux, t.lux);
    if (!t.of_minimum && uniformity == 0) continue;
    for (std::size_t s = 0; s < t.given.size(); ++s) {
      for (std::size_t k = 0; k < D; ++k) light[k] = t.of_layer[k][s];
      if (t.of_minimum) add_condition(p, light, t.given[s], t.lux, t.lux);
      if (uniformity == 0) continue;
      for (std::size_t k = 0; k < D; ++k) light[k] -= uniformity * mean[k];
      add_condition(p, light, t.given[s] - uniformity * given, 0, t.lux);
    }
  }
  return p;
}

/// Illuminance of the sensors at these levels [lx], S values.
std::vector<double> dimmed(const DimTarget& t, std::span<const double> level) {
  std::vector<double> lux = t.given;
  for (std::size_t k = 0; k < level.size(); ++k)
    for (std::size_t s = 0; s < lux.size(); ++s) lux[s] += level[k] * t.of_layer[k][s];
  return lux;
}

/// Least over mean of the worst grid.
double uniformity_of(std::span<const DimTarget> targets, std::span<const double> level) {
  double worst = 1;
  for (const DimTarget& t : targets) {
    const std::vector<double> lux = dimmed(t, level);
    if (const double mean = mean_of(lux); mean > 0) worst = std::min(worst, std::ranges::min(lux) / mean);
  }
  return worst;
}

}  // namespace

double light_at(const DimTarget& t, std::span<const double> level) {
  const std::vector<double> lux = dimmed(t, level);
  return t.of_minimum ? std::ranges::min(lux) : mean_of(lux);
}

DimLevels dim_to_target(std::span<const double> flux_lm, std::span<const DimTarget> targets,
                        std::optional<double> uniformity, double most) {
  for ([[maybe_unused]] const DimTarget& t : targets) CLERESTORY_ASSERT(t.of_layer.size(), ==, flux_lm.size());
  DimLevels found;
  // Light only adds: what all lamps together do not reach, none of them do.
  found.level.assign(flux_lm.size(), most);
  if (!std::ranges::all_of(targets,
                           [&](const DimTarget& t) { return light_at(t, found.level) >= t.lux * (1 - 1e-9); })) {
    found.outcome = DimLevels::Outcome::too_dark;
    return found;
  }
  const auto solved = [&](double u) { return least_cost(programme_of(flux_lm, targets, u, most)); };
  const double wanted = uniformity.value_or(0);
  double possible = uniformity_of(targets, found.level);
  if (const auto level = solved(wanted)) {
    found.level = *level;
  } else if (possible < wanted) {  // else all at `most` do it: no solution is then a matter of rounding
    // The largest that there is a solution for, by halves: what is at least u even is so for all less.
    found.outcome = DimLevels::Outcome::too_uneven;
    double impossible = wanted;
    while (impossible - possible > 1e-4) {
      const double u = (possible + impossible) / 2;
      if (const auto levels_of_u = solved(u)) {
        found.level = *levels_of_u;
        possible = std::max(u, std::min(uniformity_of(targets, found.level), impossible));
      } else {
        impossible = u;
      }
    }
    found.best_uniformity = possible;
  }
  for (double& d : found.level) d = std::clamp(d < 1e-9 * most ? 0.0 : d, 0.0, most);
  return found;
}

}  // namespace clerestory
