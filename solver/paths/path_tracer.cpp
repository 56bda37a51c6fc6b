#include "solver/paths/path_tracer.h"

#include <array>
#include <cmath>
#include <numbers>

#include "solver/model/assert.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/paths/way_on.h"
#include "solver/sampling/two_estimators.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {

Spectrum PathSum::std_error() const {
  if (count < 2) return Spectrum(0.0);
  Spectrum e;
  for (int k = 0; k < kMaxChannels; ++k) {
    const double m = sum[k] / count;
    e[k] = std::sqrt(std::max(0.0, (sum_of_squares[k] / count - m * m) / (count - 1)));
  }
  return e;
}

namespace {

/// One shadow ray to a light chosen by u. Of light that bundle rays meet too, the share that is due to shadow rays.
Spectrum one_light(const Illumination& light, const Vec3& p, const Vec3& n, const std::array<double, 3>& u,
                   unsigned long long& rays) {
  const LightSample s = light.sampler.sample(light.sampler.receiver(p, n), u[0], u[1], u[2], false);
  if (s.irradiance.is_black()) return Spectrum(0.0);
  const double weight =
      s.density > 0 ? balance_heuristic(s.density, density_of_ways(light, p, n, normalized(s.end - p))) : 1.0;
  ++rays;
  const RayScene& scene = light.problem.rays;
  return s.irradiance * weight * scene.transmittance_by_mirrors(p, s.end, s.way);
}

/// What glossy surfaces send on of luminaires and suns, by a pair of rays.
Spectrum by_gloss(const Illumination& light, const Vec3& p, const Vec3& n, RandomStream& random,
                  unsigned long long& rays) {
  GlossLight::Numbers u;
  for (auto& four : u)
    for (double& x : four) x = random.uniform();
  rays += GlossLight::kRaysOfPair;
  return light.sampler.gloss().by_one_pair(p, n, u, random).sum();
}

/// The sky by one ray through an opening. Of light that bundle rays meet too, the share that is due to these.
Spectrum through_opening(const Illumination& light, const Vec3& p, const Vec3& n, const std::array<double, 3>& u,
                         unsigned long long& rays) {
  const OpeningSampler::Sample s = light.openings.sample(p, n, u[0], u[1], u[2]);
  const double cos_p = dot(n, s.direction);
  if (!(s.per_choice > 0) || !(cos_p > 0)) return Spectrum(0.0);
  rays += kCostOfOpening;
  const RayScene& scene = light.problem.rays;
  const Spectrum passes = scene.transmittance(p, p + s.direction * (4 * scene.diameter()));
  if (passes.is_black()) return passes;
  const double all = s.preference + light.openings.preference(p, n, s.direction, s.opening) +
                     density_of_ways(light, p, n, s.direction);
  return light.sky(s.direction) * passes * (cos_p * s.per_choice * s.preference / all);
}

}  // namespace

PathStart path_start(const std::array<double, 2>& direction, std::uint32_t k, std::uint64_t key) {
  const auto u = sobol4(k, key + 1), v = sobol4(k, key + 2);
  return {direction, {u[0], u[1], u[2]}, {v[0], v[1], v[2]}, k, key};
}

Spectrum trace_path(const Illumination& light, Vec3 p, Vec3 n, const PathStart& start, RandomStream& random,
                    unsigned long long& rays, const Monitor& monitor) {
  const Problem& problem = light.problem;
  const PatchSet& patches = problem.patches;
  Spectrum E(0.0), throughput(1.0);
  double through_slits = 1;  // what they leave; no reason to end a path that was sent there
  std::array<double, 2> square = start.direction;
  std::array<double, 3> choice = start.light, opening = start.opening;
  constexpr unsigned kBouncesBetween = 1 << 12;  // some milliseconds
  for (unsigned bounce = 1;; ++bounce) {
    if (bounce % kBouncesBetween == 0 && monitor.should_stop()) return E;
    if (!light.sampler.empty()) E += throughput * one_light(light, p, n, choice, rays);
    if (!light.sampler.gloss().empty()) E += throughput * by_gloss(light, p, n, random, rays);
    if (!light.openings.empty()) E += throughput * through_opening(light, p, n, opening, rays);
    const double survival = std::min(1.0, throughput.max() / (kSafe * through_slits));
    if (!(random.uniform() < survival)) return E;
    throughput *= 1 / survival;

    const WayOn way = way_on(light, p, n, square, random);
    if (!(way.factor > 0)) return E;
    throughput *= way.factor;
    if (way.by_slit) through_slits *= std::min(1.0, way.factor);
    const Vec3 d = way.direction;
    const Hit hit = one_way(problem.rays, patches, {p, d}, random);
    ++rays;
    throughput *= hit.transmittance;
    if (hit.escaped()) {
      const double other = hit.reflected || light.openings.empty() ? 0 : light.openings.preference(p, n, d);
      const double weight = balance_heuristic(way.density, other);
      return E + throughput * light.sky(hit.direction({p, d})) * (weight * std::numbers::pi);
    }
    if (!hit.patch.valid()) return E;
    const Spectrum M = patches.M[hit.patch];
    if (!M.is_black()) {
      E += throughput * M * balance_heuristic(way.density, light.sampler.density(hit, p, n, d, false));
    }
    const auto on = patches.scatter(hit.patch, patches.scatters_through(hit.patch) ? random.uniform() : 0);
    throughput *= on.share;
    if (throughput.is_black()) return E;
    n = on.normal;
    p = problem.rays.off_surface(in_plane_of(patches, hit.patch, hit.position({p, d})), n);
    choice = {random.uniform(), random.uniform(), random.uniform()};
    if (!light.openings.empty()) opening = {random.uniform(), random.uniform(), random.uniform()};
    square = {random.uniform(), random.uniform()};
  }
}

PathEstimator::PathEstimator(const Illumination& light)
    : channels_(light.problem.patches.channels),
      trace_([&light](const Vec3& p, const Vec3& n, const PathStart& start, RandomStream& random,
                      unsigned long long& rays,
                      const Monitor& monitor) { return trace_path(light, p, n, start, random, rays, monitor); }) {}

Spectrum trace_replicate(const PathEstimator& estimator, const Vec3& p, const Vec3& n, std::uint64_t key, std::size_t r,
                         int paths, unsigned long long& rays, const Monitor& monitor) {
  CLERESTORY_ASSERT(paths, >, 0);
  const int in_each = (paths + static_cast<int>(kReplicates) - 1) / static_cast<int>(kReplicates);
  const std::uint64_t replicate = stream_key(key, r);
  Spectrum sum(0.0);
  for (int k = 0; k < in_each; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), replicate);
    RandomStream random(replicate, static_cast<std::uint64_t>(k));
    sum += estimator(p, n, path_start({u[0], u[1]}, static_cast<std::uint32_t>(k), replicate), random, rays, monitor);
  }
  return sum / in_each;
}

PathEstimate estimate_of(std::span<const Spectrum, kReplicates> replicates) {
  PathSum all;
  for (const Spectrum& mean : replicates) all.add(mean);
  CLERESTORY_ASSERT(all_finite(all.sum_of_squares), ==, true);
  return {all.mean(), all.std_error()};
}

PathEstimate trace_paths_at_point(const PathEstimator& estimator, const Vec3& p, const Vec3& n, std::uint64_t key,
                                  int paths, unsigned long long& rays, const Monitor& monitor) {
  std::array<Spectrum, kReplicates> replicates;
  for (std::size_t r = 0; r < kReplicates; ++r)
    replicates[r] = trace_replicate(estimator, p, n, key, r, paths, rays, monitor);
  return estimate_of(replicates);
}

PointIrradiance trace_paths_at(const PathEstimator& estimator, std::size_t count, const PointOf& point_of, int paths,
                               std::uint64_t key, std::string_view stage, const Monitor& monitor) {
  PointIrradiance result;
  result.E = result.std_error = Field(count, estimator.channels());
  constexpr std::size_t kBlock = 2048;
  const Blocks blocks = parallel_blocks(count, kBlock, 16, stage, monitor, [&](std::size_t from, std::size_t to) {
    unsigned long long rays = 0;
    for (std::size_t i = from; i < to; ++i) {
      const ReceivingPoint at = point_of(i);
      const auto [E, std_error] = trace_paths_at_point(estimator, at.p, at.n, stream_key(key, i), paths, rays, monitor);
      result.E.set(i, E);
      result.std_error.set(i, std_error);
    }
    return rays;
  });
  result.done = blocks.done, result.rays = blocks.rays;
  return result;
}

}  // namespace clerestory
