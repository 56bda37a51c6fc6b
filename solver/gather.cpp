#include "solver/gather.h"

#include <cmath>

#include "solver/gather_point.h"
#include "solver/methods/path_tracer.h"
#include "solver/model/parallel.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

enum StreamKind : std::uint64_t { kSensorRays = 0x61, kVertexRays = 0x62 };

GatherQuality quality(const SolveOptions& options, RayBudget bundle, AreaBudget area, int lamp_rays, int sun_rays) {
  for (int* rays : {&bundle.rays, &bundle.most_rays}) *rays <<= options.tighten;
  area.most_rays <<= options.tighten;
  return {bundle, area, lamp_rays, sun_rays};
}

GatherQuality sensor_quality(const SolveOptions& options) {
  switch (options.accuracy) {
    case Accuracy::draft:
      return quality(options, {16, 256, 512}, {1, 3, 0.01, 512}, 64, 16);
    case Accuracy::standard:
      return quality(options, {16, 256, 2048}, {2, 6, 0.003, 8192}, 256, 32);
    case Accuracy::fine:
      return quality(options, {16, 1024, 8192}, {2, 6, 0.0015, 16384}, 512, 64);
  }
  return {};
}

/// Paths meet reflected light on their way; a gather looks it up, and bright patches are lamps to it.
Illumination illumination(const Problem& problem, const Solution& solution) {
  if (!solution.std_error.value.empty()) return Illumination(problem);
  Illumination light(problem, solution.B);
  light.look_at_panels();
  return light;
}

struct Place {
  Vec3 p, n;  ///< local frame, lifted
};

/// Calls done(index, E, std_error) for each place, from several threads.
template <class PlaceOf, class Done>
unsigned long long gather(const Illumination& light, const Solution& solution, std::size_t count,
                          const PlaceOf& place_of, const GatherPattern& pattern, int paths, std::uint64_t key,
                          std::string_view stage, const Monitor& monitor, const Done& done) {
  const bool by_paths = !solution.std_error.value.empty();
  std::vector<unsigned long long> rays(count, 0);
  constexpr std::size_t kBlock = 2048;
  for (std::size_t begin = 0; begin < count && !monitor.should_stop(); begin += kBlock) {
    monitor.report(stage, static_cast<double>(begin) / static_cast<double>(count));
    parallel_for(std::min(kBlock, count - begin), 16, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) {
        const Place at = place_of(i);
        if (by_paths) {
          const auto [E, std_error] = trace_paths_at_point(light, at.p, at.n, stream_key(key, i), paths, rays[i]);
          done(i, E, std_error);
        } else {
          done(i, gather_point(light, at.p, at.n, pattern, rays[i]).E, Spectrum(0.0));
        }
      }
    });
  }
  unsigned long long sum = 0;
  for (const auto r : rays) sum += r;
  return sum;
}

}  // namespace

GatherQuality vertex_quality(const SolveOptions& options) {
  switch (options.accuracy) {
    case Accuracy::draft:
      return quality(options, {8, 64, 64}, {0, 1, 0.02, 128}, 32, 8);
    case Accuracy::standard:
      return quality(options, {16, 256, 768}, {1, 3, 0.01, 512}, 128, 16);
    case Accuracy::fine:
      return quality(options, {16, 512, 2048}, {1, 4, 0.005, 2048}, 128, 32);
  }
  return {};
}

PointIrradiance gather_at_sensors(const Problem& problem, const Solution& solution, std::span<const SensorPoint> points,
                                  const SolveOptions& options, const Monitor& monitor) {
  const Illumination light = illumination(problem, solution);
  PointIrradiance result;
  result.E = Field(points.size(), problem.patches.channels);
  if (!solution.std_error.value.empty()) result.std_error = result.E;
  std::vector<char> reached(points.size(), 0);
  result.rays = gather(
      light, solution, points.size(),
      [&](std::size_t i) {
        const Vec3 n = points[i].normal;
        return Place{points[i].position - problem.patches.origin + n * (2 * problem.rays.lift()), n};
      },
      GatherPattern(sensor_quality(options), options.seed), 4 * paths_per_point(options),
      stream_key(options.seed, kSensorRays), "sensors", monitor,
      [&](std::size_t i, const Spectrum& E, const Spectrum& error) {
        result.E.set(i, E);
        if (!result.std_error.value.empty()) result.std_error.set(i, error);
        reached[i] = 1;
      });
  for (const char r : reached) result.complete = result.complete && r;
  return result;
}

unsigned long long gather_at_points(const Problem& problem, const Solution& solution, VertexLightmap& lightmap,
                                    const SolveOptions& options, const Monitor& monitor) {
  const Illumination light = illumination(problem, solution);
  const std::size_t samples = lightmap.sample_position.size(), points = lightmap.position.size();
  Field E(samples, problem.patches.channels), std_error;
  if (!solution.std_error.value.empty()) std_error = E;
  std::vector<char> reached(samples, 0);
  const auto rays = gather(
      light, solution, samples,
      [&](std::size_t i) {
        const Vec3 n = lightmap.sample_normal[i];
        return Place{lightmap.sample_position[i] + n * problem.rays.lift(), n};
      },
      GatherPattern(vertex_quality(options), options.seed), paths_per_point(options),
      stream_key(options.seed, kVertexRays), "vertices", monitor,
      [&](std::size_t i, const Spectrum& value, const Spectrum& error) {
        E.set(i, value);
        if (!std_error.value.empty()) std_error.set(i, error);
        reached[i] = 1;
      });

  if (!std_error.value.empty()) lightmap.std_error = Field(points, problem.patches.channels);
  for (std::size_t p = 0; p < points; ++p) {
    const std::uint32_t begin = lightmap.sample_begin[p], end = lightmap.sample_begin[p + 1];
    Spectrum mean(0.0), variance(0.0);
    bool complete = true;
    for (std::uint32_t i = begin; i < end; ++i) {
      complete = complete && reached[i];
      const double weight = lightmap.sample_weight[i];
      mean += E[i] * weight;
      if (!std_error.value.empty()) variance += std_error[i] * std_error[i] * (weight * weight);
    }
    if (!complete) continue;
    lightmap.E.set(p, mean);
    if (!std_error.value.empty())
      lightmap.std_error.set(p, {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])});
  }
  return rays;
}

std::vector<std::size_t> buried_points(const Problem& problem, std::span<const SensorPoint> points) {
  std::vector<std::size_t> buried;
  constexpr std::uint32_t kRays = 32;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::uint32_t dark = 0;
    const Vec3 p = points[i].position - problem.patches.origin + points[i].normal * (2 * problem.rays.lift());
    const Frame frame(points[i].normal);
    for (std::uint32_t k = 0; k < kRays; ++k) {
      const auto u = sobol4(k, i);
      const Hit hit = problem.rays.first_hit(problem.patches, {p, cosine_direction(frame, u[0], u[1])});
      dark += !hit.escaped() && !hit.patch.valid();
    }
    if (2 * dark > kRays) buried.push_back(i);
  }
  return buried;
}

}  // namespace clerestory
