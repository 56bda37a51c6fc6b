#include "solver/hierarchy/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/two_estimators.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::size_t kParts = 4;
constexpr int kRaysOfLuminaire = 4;  // to a luminaire near by, whose light differs between parts by more than they miss
constexpr int kDirections = 16, kPairs = 16,
              kPoints = 8;        // of each part: one packet each, and half of one for delta light
constexpr int kMostHalvings = 4;  // of an element in one call
constexpr double kSigmas = 3;     // one probe in 400 takes its own noise for light, and halves an element in vain
constexpr double kFewestPatches = 2000,
                 kMostPatches = 10'000;  // by judgement: what one element may get wrong, see refine.h
constexpr double kDark = 0.25;           // of the median E: darker ones count as if they had that

/// Values of the same sample in each part, summed so that differences of parts and their errors follow.
struct Paired {
  std::array<double, kParts> sum{};
  std::array<std::array<double, kParts>, kParts> square{};  ///< sum of (value_s - value_t)^2
  int count = 0;

  void add(const std::array<double, kParts>& x) {
    ++count;
    for (std::size_t s = 0; s < kParts; ++s) {
      sum[s] += x[s];
      for (std::size_t t = s + 1; t < kParts; ++t) square[s][t] += (x[s] - x[t]) * (x[s] - x[t]);
    }
  }
  double mean(std::size_t s) const { return sum[s] / count; }
  /// Of mean(s) - mean(t).
  double variance(std::size_t s, std::size_t t) const {
    const double d = (sum[s] - sum[t]) / count;
    return std::max(0.0, square[s][t] / count - d * d) / (count - 1);
  }
};

std::array<std::array<Vec3, 3>, kParts> parts_of(const std::array<Vec3, 3>& c) {
  const Vec3 ab = (c[0] + c[1]) / 2, bc = (c[1] + c[2]) / 2, ca = (c[2] + c[0]) / 2;
  return {{{c[0], ab, ca}, {c[1], bc, ab}, {c[2], ca, bc}, {ab, bc, ca}}};
}

}  // namespace

Variation irradiance_variation(const Illumination& light, const Field& B, const std::array<Vec3, 3>& corners,
                               const Vec3& normal, std::uint64_t key, unsigned long long& rays) {
  const Problem& problem = light.problem;
  const PatchSet& patches = problem.patches;
  const auto parts = parts_of(corners);
  const auto lifted = [&](const Vec3& p) { return problem.rays.off_surface(p, normal); };
  const Frame frame(normal);
  const int pairs = light.sampler.has_bright_patches() ? kPairs : 0;

  Paired bundle;
  std::array<double, kParts> value;
  for (int k = 0; k < kDirections; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Vec3 d = cosine_direction(frame, u[0], u[1]);
    for (std::size_t s = 0; s < kParts; ++s) {
      const Vec3 x = lifted(point_on_triangle(parts[s], u[2], u[3]));
      Echo echo;
      const Hit hit = problem.rays.first_hit(patches, {x, d}, &echo);
      value[s] = 0;
      const auto take = [&](const Hit& h, double weight) {
        if (h.escaped())
          value[s] += std::numbers::pi * luminous_mean(light.sky(h.direction({x, d})) * h.transmittance);
        else if (h.patch.valid())
          value[s] += weight * luminous_mean(B[h.patch] * h.transmittance);
      };
      // All parts share the numbers.
      follow_echo(problem.rays, patches, echo, key, static_cast<std::uint64_t>(k), [&](const Hit& h) { take(h, 1); });
      if (!hit.patch.valid()) {
        take(hit, 1);
        continue;
      }
      const double other = pairs > 0 ? pairs * light.sampler.density(hit, x, normal, d, true) : 0;
      const double weight = balance_heuristic(kDirections * dot(normal, d) / std::numbers::pi, other);
      take(hit, weight);
    }
    bundle.add(value);
  }
  rays += kDirections * kParts;

  Paired bright;
  if (pairs > 0) {
    std::array<std::array<double, kParts>, kPairs> found{};
    const std::uint64_t pick = mix_bits(key), place = mix_bits(pick);
    struct Load {
      double* found;
      double light;
    };
    auto shadows = shadow_rays<Load>(problem.rays, [&](const Load& load, const Spectrum& passes) {
      *load.found = load.light * luminous_mean(passes);
    });
    for (std::size_t s = 0; s < kParts; ++s)
      for (std::uint32_t k = 0; k < kPairs; ++k) {
        const auto u = sobol4(k, pick), v = sobol4(k, place);
        const Vec3 from = lifted(point_on_triangle(parts[s], v[0], v[1]));
        const LightSample sample = light.sampler.sample(light.sampler.receiver(from, normal), u[0], u[1], u[2], true);
        if (!(sample.density > 0)) continue;
        const double cos_p = std::max(0.0, dot(normal, normalized(sample.end - from))) / std::numbers::pi;
        const double sent =
            pairs * luminous_mean(B[sample.patch]) * cos_p / (kDirections * cos_p + pairs * sample.density);
        if (sent > 0) shadows.send(from, sample.end, {&found[k][s], sent});
      }
    shadows.trace();
    for (const auto& x : found) bright.add(x);
    rays += kPairs * kParts;
  }

  Paired delta;
  if (!problem.lights.empty()) {
    const std::uint64_t place = mix_bits(key + 1);
    for (int k = 0; k < kPoints; ++k) {
      const auto v = sobol4(static_cast<std::uint32_t>(k), place);
      for (std::size_t s = 0; s < kParts; ++s)
        value[s] = luminous_mean(light.sampler.delta_light(lifted(point_on_triangle(parts[s], v[0], v[1])), normal,
                                                           {.opening_rays = kRaysOfLuminaire, .gloss_rays = 4},
                                                           mix_bits(place + static_cast<std::uint64_t>(k))));
      delta.add(value);
    }
    rays += kPoints * kParts;
  }

  Variation result;
  std::array<double, kParts> E{};
  for (std::size_t s = 0; s < kParts; ++s)
    for (const Paired* p : {&bundle, &bright, &delta})
      if (p->count > 0) E[s] += p->mean(s);
  for (std::size_t s = 0; s < kParts; ++s) {
    result.E += E[s] / kParts;
    for (std::size_t t = s + 1; t < kParts; ++t) {
      double variance = 0;
      for (const Paired* p : {&bundle, &bright, &delta})
        if (p->count > 0) variance += p->variance(s, t);
      result.difference = std::max(result.difference, std::abs(E[s] - E[t]) - kSigmas * std::sqrt(variance));
    }
  }
  return result;
}

namespace {

/// What counts in a room.
struct Scale {
  double area = 0;  ///< A0 [m2]
  double dark = 0;  ///< irradiance below which an element counts as if it had that
};

/// By room. leaves: with the irradiance E.
std::vector<Scale> scales_of(const PatchSet& patches, const PatchSet& leaves, const Field& E) {
  std::vector<Scale> scales(patches.room_count());
  std::vector<double> count(scales.size());
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    scales[patches.room_of(i)].area += patches.area[i];
    ++count[patches.room_of(i)];
  }
  struct Lit {
    std::uint32_t room;
    double light, area;
  };
  std::vector<Lit> lit(leaves.patch_count());
  std::vector<double> half(scales.size());
  for (std::size_t i = 0; i < lit.size(); ++i) {
    lit[i] = {leaves.room_of(i), luminous_mean(E[i]), leaves.area[i]};
    half[lit[i].room] += leaves.area[i] / 2;
  }
  std::ranges::sort(lit, {}, [](const Lit& l) { return std::pair(l.room, l.light); });
  for (const Lit& l : lit) {  // up to the median
    if (half[l.room] > 0) scales[l.room].dark = kDark * l.light;
    half[l.room] -= l.area;
  }
  for (std::size_t r = 0; r < scales.size(); ++r) scales[r].area /= std::clamp(count[r], kFewestPatches, kMostPatches);
  return scales;
}

double triangle_area(const std::array<Vec3, 3>& c) { return length(cross(c[1] - c[0], c[2] - c[0])) / 2; }

}  // namespace

std::size_t refine(ElementMesh& mesh, const Illumination& light, const Field& E, const Field& B,
                   const RefineOptions& options, unsigned long long& rays, const Monitor& monitor) {
  const PatchSet& patches = mesh.patches();
  const std::vector<Scale> scales = scales_of(patches, light.problem.patches, E);
  std::vector<std::uint32_t> candidates = mesh.leaves(), marked;
  std::size_t halved = 0;
  for (int pass = 0; pass < kMostHalvings && !candidates.empty() && !monitor.should_stop(); ++pass) {
    std::vector<float> stake(candidates.size(), 0.0f);
    std::vector<unsigned long long> spent(candidates.size(), 0);
    parallel_for(candidates.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end && !monitor.should_stop(); ++k) {
        const std::uint32_t e = candidates[k];
        if (mesh[e].penumbra) continue;  // as it should be
        const PatchId p{std::size_t{mesh[e].patch}};
        const double edge = mesh.longest_edge(e);
        const auto corners = mesh.corner_positions(e);
        const Scale& scale = scales[patches.room_of(p)];
        const double weight = luminous_mean(patches.albedo(p)) * triangle_area(corners) / scale.area;
        // Little varies by more than twice its mean between four parts.
        if (edge < 2 * options.shortest_edge.of(patches, p) || 2 * weight < options.tolerance / 2) continue;
        const Variation v = irradiance_variation(light, B, corners, patches.normal[p],
                                                 stream_key(options.seed, kVariationProbe, e), spent[k]);
        if (v.difference > options.tolerance * v.E &&
            weight * v.difference > options.tolerance / 2 * std::max(v.E, scale.dark))
          stake[k] = static_cast<float>(weight * v.difference);
      }
    });
    for (const auto r : spent) rays += r;
    if (monitor.should_stop()) break;
    marked.clear();
    std::vector<std::pair<float, std::uint32_t>> by_stake;
    for (std::size_t k = 0; k < candidates.size(); ++k)
      if (stake[k] > 0) by_stake.emplace_back(-stake[k], candidates[k]);
    // An element brings its neighbour with it, and a few more.
    const std::size_t room = options.most_elements > mesh.leaf_count() ? options.most_elements - mesh.leaf_count() : 0;
    if (by_stake.size() > room / 4) {
      std::sort(by_stake.begin(), by_stake.end());
      by_stake.resize(room / 4);
    }
    for (const auto& [s, e] : by_stake) marked.push_back(e);
    if (marked.empty()) break;
    halved += marked.size();
    const std::size_t before = mesh.size();
    mesh.split(marked);
    candidates.clear();
    for (std::size_t e = before; e < mesh.size(); ++e)
      if (mesh[e].is_leaf()) candidates.push_back(static_cast<std::uint32_t>(e));
  }
  return halved;
}

}  // namespace clerestory
