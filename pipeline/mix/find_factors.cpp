#include "pipeline/mix/find_factors.h"

#include <algorithm>

#include "io/scene_file/nearest_name.h"
#include "io/some_of.h"
#include "io/text.h"
#include "pipeline/wording.h"
#include "solver/dimming/dim_to_target.h"
#include "solver/lights/layers.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

bool is_dimmed(const ShownLayer& layer, std::span<const LayerFactor> given) {
  return layer.name != kSkyLayer && layer.name != kSunLayer &&
         std::ranges::find(given, layer.name, &LayerFactor::layer) == given.end();
}

/// "--target 'desk'=500" or "--target 'desk'=200:min".
std::string option_of(const GridTarget& target) {
  return text("--target '", quotable(target.grid), "'=", target.lux, target.of_minimum ? ":min" : "");
}

const MeasuredSensors& sensors_of(const WrittenResult& result, const GridTarget& target) {
  std::vector<std::string_view> known;
  for (const MeasuredSensors& sensors : result.around.sensors) {
    if (sensors.set.name == target.grid && !sensors.layers.value.empty()) return sensors;
    if (!sensors.layers.value.empty()) known.push_back(sensors.set.name);
  }
  const std::string where = result.file + ": " + option_of(target);
  if (known.empty())
    throw InputError(where + ": the result has no sensors; give the scene \"sensors\" and solve it again.");
  const std::string near = suggestion(target.grid, known);
  throw InputError(where + ": there are no sensors of that name; " + near + (near.ends_with('?') ? "" : "."));
}

/// The layers that are dimmed, by one factor each or all by one.
struct Dimmed {
  std::vector<std::size_t> layers;     ///< their numbers
  std::vector<std::size_t> factor_of;  ///< which factor is theirs
  std::vector<double> flux;            ///< of each factor at 1 [lm]
};

Dimmed dimmed_layers(const WrittenResult& result, std::span<const LayerFactor> given, bool by_one_factor) {
  Dimmed dimmed;
  for (std::size_t k = 0; k < result.around.layers.size(); ++k) {
    const ShownLayer& layer = result.around.layers[k];
    if (!is_dimmed(layer, given)) continue;
    dimmed.layers.push_back(k);
    if (!by_one_factor || dimmed.flux.empty()) dimmed.flux.push_back(0);
    dimmed.factor_of.push_back(dimmed.flux.size() - 1);
    dimmed.flux.back() += layer.luminous_flux();
  }
  return dimmed;
}

/// factors  of all layers; what they are for those that are dimmed does not matter
DimTarget target_of(const WrittenResult& result, const Dimmed& dimmed, std::span<const double> factors,
                    const GridTarget& target) {
  const MeasuredSensors& sensors = sensors_of(result, target);
  const std::size_t points = sensors.set.points.size();
  DimTarget out{.lux = target.lux,
                .of_minimum = target.of_minimum,
                .given = std::vector(points, 0.0),
                .of_layer = std::vector(dimmed.flux.size(), std::vector(points, 0.0))};
  for (std::size_t k = 0, next = 0; k < result.around.layers.size(); ++k) {
    const bool free = next < dimmed.layers.size() && dimmed.layers[next] == k;
    const double factor = free ? 1 : factors[k];
    std::vector<double>& to = free ? out.of_layer[dimmed.factor_of[next++]] : out.given;
    const std::vector<double> lux = illuminance_of_layer(result.around, sensors, k);
    for (std::size_t s = 0; s < points; ++s) to[s] += factor * lux[s];
  }
  return out;
}

/// "'ceiling', 'desk' and 3 more"
std::string names_of(const WrittenResult& result, const Dimmed& dimmed) {
  return some_of(dimmed.layers, 4,
                 [&](std::size_t k) { return text("'", quotable(result.around.layers[k].name), "'"); });
}

std::vector<LayerFactor> factors_at(const WrittenResult& result, const Dimmed& dimmed, const DimLevels& found) {
  std::vector<LayerFactor> factors;
  for (std::size_t i = 0; i < dimmed.layers.size(); ++i)
    factors.push_back({result.around.layers[dimmed.layers[i]].name, found.level[dimmed.factor_of[i]]});
  return factors;
}

[[noreturn]] void refuse(const WrittenResult& result, const DimRequest& request, const Dimmed& dimmed,
                         const std::vector<DimTarget>& targets, const DimLevels& found) {
  std::string problem = result.file + ": ";
  if (found.outcome == DimLevels::Outcome::too_uneven) {
    throw InputError(
        text(problem, "--uniformity ", *request.uniformity, " cannot be reached with these targets: the best that ",
             names_of(result, dimmed), " can give is ", rounded(found.best_uniformity, 3), " (at factors ",
             factor_words(factors_at(result, dimmed, found), 3), "); ask for less, or move or add luminaires."));
  }
  bool first = true;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const double best = light_at(targets[t], found.level);
    if (best >= targets[t].lux) continue;
    problem += text(first ? "" : "; ", option_of(request.targets[t]), " cannot be reached: ", names_of(result, dimmed),
                    dimmed.layers.size() > 1 ? " all at " : " at ", request.most,
                    dimmed.layers.size() > 1 ? " give " : " gives ", targets[t].of_minimum ? "at least " : "a mean of ",
                    rounded(best, 4), " lx");
    first = false;
  }
  throw InputError(problem + "; ask for less, or allow more with --max.");
}

}  // namespace

FoundFactors find_factors(const WrittenResult& result, std::span<const LayerFactor> given, const DimRequest& request) {
  const std::vector<double> factors = factors_of(result, given);
  const Dimmed dimmed = dimmed_layers(result, given, request.commission);
  if (dimmed.layers.empty())
    throw InputError(result.file + ": --target: there is no layer to dim; sky and sun cannot be dimmed" +
                     (given.empty() ? std::string() : ", and --set gives the others") + ".");
  std::vector<DimTarget> targets;
  for (const GridTarget& target : request.targets) targets.push_back(target_of(result, dimmed, factors, target));

  const DimLevels found = dim_to_target(dimmed.flux, targets, request.uniformity, request.most);
  if (found.outcome != DimLevels::Outcome::reached) refuse(result, request, dimmed, targets, found);

  FoundFactors out;
  out.factors = factors_at(result, dimmed, found);
  for (std::size_t f = 0; f < dimmed.flux.size(); ++f)
    out.luminous_flux += found.level[f] * dimmed.flux[f], out.full_flux += dimmed.flux[f];
  return out;
}

}  // namespace clerestory
