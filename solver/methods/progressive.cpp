#include "solver/methods/progressive.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "solver/model/assert.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/spaces/energy.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kLeastRays = 16, kMostRaysAPiece = 4096;
/// The ambient is shot for good when it leaves less than this share of what is unshot. Higher saves rounds but brings
/// noise to dim corners: they get it, and give it back.
constexpr double kAmbientWorthIt = 0.3;

/// Rays first .. first + count - 1 of patch `from`, each carrying `flux` [W].
struct Piece {
  std::uint32_t from, first, count;
  Spectrum flux;
};

/// Of unshot light, which overshooting makes negative in any channel.
double magnitude(const Spectrum& dB) { return luminous_mean({std::abs(dB[0]), std::abs(dB[1]), std::abs(dB[2])}); }

/// State of the light between rounds. Sums run over patches in their order, for the same bits every time.
struct Unshot {
  const PatchSet& patches;
  Field E, dB;
  EnergyBalance on_the_way{};  ///< what has ended between patches, as rays and ambient told; nothing is emitted here

  double flux_at(std::size_t i) const { return patches.area[i] * magnitude(dB[i]); }
  double flux() const {
    double sum = 0;
    for (std::size_t i = 0; i < patches.patch_count(); ++i) sum += flux_at(i);
    return sum;
  }
};

Spectrum divided(const Spectrum& a, const Spectrum& b) {
  return {b[0] > 0 ? a[0] / b[0] : 0, b[1] > 0 ? a[1] / b[1] : 0, b[2] > 0 ? a[2] / b[2] : 0};
}

/// Of each space: the uniform radiosity that carries as much flux as is unshot there.
std::vector<Spectrum> ambient_radiosity(const Unshot& light, const Closure& closure) {
  const PatchSet& p = light.patches;
  std::vector<Spectrum> unshot(closure.spaces), lost(closure.spaces);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    unshot[closure.space[i]] += p.area[i] * light.dB[i];
    lost[closure.space[i]] += p.area[i] * (Spectrum(1.0) - p.scattered(closure.arrives, i));
  }
  for (std::size_t s = 0; s < closure.spaces; ++s) unshot[s] = divided(unshot[s], lost[s]);
  return unshot;
}

Spectrum unshot_after_ambient(const Unshot& light, const Closure& closure, const std::vector<Spectrum>& e,
                              std::size_t i) {
  const Spectrum e_i = e[closure.space[i]];
  return light.dB[i] - e_i + light.patches.scattered(closure.arrives, i) * e_i;
}

/// Shoots the uniform radiosity e of each space from all its patches.
void shoot_ambient(Unshot& light, const Closure& closure, const std::vector<Spectrum>& e) {
  const PatchSet& p = light.patches;
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    const Spectrum e_i = e[closure.space[i]];
    light.dB.set(i, unshot_after_ambient(light, closure, e, i));
    light.E.add(i, closure.arrives[i] * e_i);
    light.on_the_way += where_light_ends(p, i, Spectrum(), e_i, losses(closure, i));
  }
}

/// The same, when that is worth it.
bool shoot_ambient_if_worth_it(Unshot& light, const Closure& closure) {
  const PatchSet& p = light.patches;
  const std::vector<Spectrum> e = ambient_radiosity(light, closure);
  double left = 0;
  for (std::size_t i = 0; i < p.patch_count(); ++i)
    left += p.area[i] * magnitude(unshot_after_ambient(light, closure, e, i));
  if (!(left < kAmbientWorthIt * light.flux())) return false;
  shoot_ambient(light, closure, e);
  return true;
}

/// The patches to shoot in this round, most unshot flux first.
std::vector<std::uint32_t> brightest(const Unshot& light, double share) {
  const std::size_t n = light.patches.patch_count();
  double most = 0;
  for (std::size_t i = 0; i < n; ++i) most = std::max(most, light.flux_at(i));
  std::vector<std::uint32_t> chosen;
  for (std::size_t i = 0; i < n; ++i)
    if (light.flux_at(i) >= share * most && light.flux_at(i) > 0) chosen.push_back(static_cast<std::uint32_t>(i));
  if (share >= 1 && chosen.size() > 1) chosen.erase(chosen.begin() + 1, chosen.end());
  return chosen;
}

struct Landing {
  PatchId patch;
  bool escaped;
};

void trace(const Problem& problem, const Piece& piece, std::uint64_t seed, std::span<Landing> landings,
           std::span<Spectrum> passed) {
  const PatchSet& patches = problem.patches;
  const Frame frame(patches.normal[piece.from]);
  const auto corners = patches.corner_positions(PatchId{piece.from});
  const std::uint64_t key = stream_key(seed, kShots, piece.from);
  for (std::uint32_t k = 0; k < piece.count; ++k) {
    const auto u = sobol4(piece.first + k, key);
    RandomStream random = echo_numbers(key, piece.first + k);
    const Hit hit = one_way(problem.rays, patches,
                            {problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                             cosine_direction(frame, u[0], u[1])},
                            random);
    landings[k] = {hit.patch, hit.escaped()};
    if (!passed.empty()) passed[k] = hit.transmittance;
  }
}

void deposit(Unshot& light, const Piece& piece, std::span<const Landing> landings, std::span<const Spectrum> passed) {
  const PatchSet& p = light.patches;
  const double sent = luminous_mean(piece.flux);
  for (std::size_t k = 0; k < landings.size(); ++k) {
    const auto [q, escaped] = landings[k];
    Spectrum arriving = piece.flux;
    if (!passed.empty()) {
      arriving *= passed[k];
      light.on_the_way.absorbed += sent - luminous_mean(arriving);
    }
    if (escaped) {
      light.on_the_way.escaped += luminous_mean(arriving);
    } else if (!q.valid()) {
      light.on_the_way.absorbed += luminous_mean(arriving);
    } else {
      const double per_area = 1 / p.area[q];
      for (int c = 0; c < p.channels; ++c) {
        const double E = arriving[c] * per_area;
        light.E.at(q, c) += E;
        light.dB.at(q, c) += p.rho.at(q, c) * E;
      }
      for (const auto& [other, share] : p.patches_behind(q))
        light.dB.add(other, p.tau[q] * arriving * (share / p.area[other]));
    }
  }
}

}  // namespace

Solution shoot(const Problem& problem, const DirectLight& direct, const Closure& closure, const ShootOptions& options,
               const Monitor& monitor) {
  const PatchSet& p = problem.patches;
  const std::size_t n = p.patch_count();
  CLERESTORY_ASSERT(direct.E.size(), ==, n);
  CLERESTORY_ASSERT(options.stop_fraction, >, 0);
  Unshot light{p, direct.E, Field(n, p.channels)};
  for (std::size_t i = 0; i < n; ++i) light.dB.set(i, p.M[i] + p.scattered(direct.E, i));

  Solution solution;
  solution.method = "progressive";
  solution.energy = direct.energy;
  solution.energy.emitted += total_flux(p, p.M);
  const double emitted = solution.energy.emitted;
  const double flux_per_ray = light.flux() / (options.rays_per_patch * static_cast<double>(n));
  std::vector<std::uint32_t> next_ray(n, 0);
  std::vector<Landing> landings;
  std::vector<Spectrum> passed;

  double residual = emitted > 0 ? light.flux() / emitted : 0;
  const double first_residual = residual;
  int round = 0;
  for (; residual > options.stop_fraction; ++round) {
    if (round == options.max_rounds) {
      solution.stop = StopReason::iteration_limit;
      break;
    }
    if (monitor.should_stop()) {
      solution.stop = why_stopped(monitor);
      break;
    }
    monitor.report("shoot", std::log(first_residual / residual) / std::log(first_residual / options.stop_fraction));

    const bool uniform = shoot_ambient_if_worth_it(light, closure);
    if (!uniform) {
      std::vector<Piece> pieces;
      std::vector<std::size_t> begin{0};
      for (const std::uint32_t i : brightest(light, options.batch_share)) {
        const double wanted = light.flux_at(i) / flux_per_ray;
        const auto count = static_cast<std::uint32_t>(std::clamp(wanted, double{kLeastRays}, 1e8)) / 16 * 16;
        const Spectrum flux = light.dB[i] * (p.area[i] / count);
        light.dB.set(i, Spectrum(0.0));
        for (std::uint32_t done = 0; done < count; done += kMostRaysAPiece) {
          const std::uint32_t part = std::min(kMostRaysAPiece, count - done);
          pieces.push_back({i, next_ray[i] + done, part, flux});
          begin.push_back(begin.back() + part);
        }
        next_ray[i] += count;
        ++solution.iterations;
      }
      // Blocks bound the memory of rays under way, and the time until the wish to stop is seen.
      constexpr std::size_t kBlock = std::size_t{1} << 21;
      std::size_t first = 0;
      while (first < pieces.size() && (first == 0 || !monitor.should_stop())) {
        std::size_t last = first + 1;
        while (last < pieces.size() && begin[last + 1] - begin[first] <= kBlock) ++last;
        const std::size_t offset = begin[first];
        landings.resize(begin[last] - offset);
        if (problem.rays.has_echoes() || problem.rays.has_mirrors()) passed.resize(landings.size());
        const auto part = [&](auto& all, std::size_t k) {
          return all.empty() ? std::span(all) : std::span(all).subspan(begin[k] - offset, pieces[k].count);
        };
        parallel_for(last - first, 4, [&](std::size_t from, std::size_t to) {
          for (std::size_t k = first + from; k < first + to; ++k)
            trace(problem, pieces[k], options.seed, part(landings, k), part(passed, k));
        });
        for (std::size_t k = first; k < last; ++k) deposit(light, pieces[k], part(landings, k), part(passed, k));
        first = last;
      }
      solution.rays += begin[first];
      for (; first < pieces.size(); ++first) {  // not shot after all
        const Piece& piece = pieces[first];
        light.dB.add(piece.from, piece.flux * (piece.count / p.area[piece.from]));
      }
    }
    residual = light.flux() / emitted;
    solution.log.push_back("round " + std::to_string(round) +
                           (uniform ? ": ambient" : ": " + std::to_string(solution.iterations) + " shots") +
                           ", unshot " + std::to_string(residual));
  }

  // What is not shot by now is spread as ambient light, and balanced as such.
  shoot_ambient(light, closure, ambient_radiosity(light, closure));
  // What overshooting lent to dark corners is taken back by chance, here and there more than was lent.
  for (double& E : light.E.value) E = std::max(0.0, E);
  CLERESTORY_ASSERT(all_finite(light.E), ==, true);
  solution.E = light.E;
  solution.B = Field(n, p.channels);
  // What patches sent and no patch received was counted ray by ray, which balances exactly; the closure's shares would
  // only estimate it.
  constexpr Losses kCounted{};
  for (std::size_t i = 0; i < n; ++i) {
    const Spectrum B = p.M[i] + p.scattered(light.E, i);
    solution.B.set(i, B);
    solution.energy += where_light_ends(p, i, light.E[i], B, kCounted);
  }
  solution.energy += light.on_the_way;
  solution.residual = residual;
  solution.flux_per_ray = flux_per_ray;
  solution.rays += direct.rays + closure.rays;
  return solution;
}

}  // namespace clerestory
