#include "solver/gather/gather.h"

#include <cmath>

#include "solver/gather/gather_point.h"
#include "solver/illumination/caustic_light.h"
#include "solver/model/parallel.h"

namespace clerestory {

PointOf sensor_points(std::span<const SensorPoint> points, const Vec3& origin, const RayScene& rays) {
  return [points, origin, &rays](std::size_t i) {
    const Vec3 n = points[i].normal;
    return ReceivingPoint{rays.beside_surfaces(points[i].position - origin, n), n};
  };
}

PointOf sample_points(const VertexLightmap& lightmap, const RayScene& rays) {
  return [&lightmap, &rays](std::size_t i) {
    const Vec3 n = lightmap.sample_normal[i];
    return ReceivingPoint{rays.off_surface(lightmap.sample_position[i], n), n};
  };
}

PointIrradiance gather_at(const Illumination& light, std::size_t count, const PointOf& point_of,
                          const GatherPattern& pattern, std::string_view stage, const Monitor& monitor,
                          const RowLight* layers) {
  PointIrradiance result;
  const std::size_t lanes = layers ? layers->lanes() : 0;
  result.E = Field(count, light.problem.patches.channels);
  if (layers) result.layers = Field(count, static_cast<int>(lanes));
  constexpr std::size_t kBlock = 2048;
  const Blocks blocks = parallel_blocks(count, kBlock, 16, stage, monitor, [&](std::size_t from, std::size_t to) {
    unsigned long long rays = 0;
    LightRow row;
    std::vector<double> delta_light(lanes);
    for (std::size_t i = from; i < to; ++i) {
      const ReceivingPoint at = point_of(i);
      const GatheredLight found = gather_point(light, at.p, at.n, pattern, rays, layers ? &row : nullptr);
      result.E.set(i, found.E);
      if (layers)
        add_layers(found, row, *layers, 1, std::span(result.layers.value).subspan(i * lanes, lanes), delta_light);
    }
    return rays;
  });
  result.done = blocks.done, result.rays = blocks.rays;
  if (light.problem.lights.caustics.legs.empty()) return result;
  const CausticIrradiance caustics = caustic_irradiance(light.problem, result.done, point_of, layers != nullptr);
  for (std::size_t i = 0; i < result.done; ++i) {
    result.E.add(i, caustics.E[i]);
    if (layers) layers->add(caustics.rows[i], lanes_of(result.layers, i).data());
  }
  return result;
}

LightRows gather_rows_at(const Illumination& light, std::size_t count, const PointOf& point_of,
                         const GatherPattern& pattern) {
  std::vector<LightRow> row(count);
  parallel_for(count, 16, [&](std::size_t from, std::size_t to) {
    unsigned long long rays = 0;
    for (std::size_t i = from; i < to; ++i) {
      const ReceivingPoint at = point_of(i);
      gather_point(light, at.p, at.n, pattern, rays, &row[i]);
    }
  });
  LightRows rows;
  std::size_t entries = 0;
  for (const LightRow& r : row) entries += r.size();
  rows.entries.reserve(entries);
  for (LightRow& r : row) {
    rows.append(r);
    r = {};
  }
  return rows;
}

void set_points(const PointIrradiance& at_samples, VertexLightmap& lightmap) {
  const std::size_t points = lightmap.position.size();
  const bool has_error = !at_samples.std_error.value.empty();
  if (has_error) lightmap.std_error = Field(points, at_samples.E.channels);
  for (std::size_t p = 0; p < points; ++p) {
    const std::uint32_t begin = lightmap.sample_begin[p], end = lightmap.sample_begin[p + 1];
    if (end > at_samples.done) break;
    Spectrum mean(0.0), variance(0.0);
    for (std::uint32_t i = begin; i < end; ++i) {
      const double weight = lightmap.sample_weight[i];
      mean += at_samples.E[i] * weight;
      if (has_error) variance += at_samples.std_error[i] * at_samples.std_error[i] * (weight * weight);
    }
    lightmap.E.set(p, mean);
    if (has_error) lightmap.std_error.set(p, {std::sqrt(variance[0]), std::sqrt(variance[1]), std::sqrt(variance[2])});
  }
}

}  // namespace clerestory
