#pragma once
// Irradiance at many points, from a solved field.

#include <span>
#include <string_view>
#include <vector>

#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
#include "solver/model/sensors.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// Places of sensor points, given in the scene's frame; they and the rays outlive it.
PointOf sensor_points(std::span<const SensorPoint> points, const Vec3& origin, const RayScene& rays);
/// Places of a lightmap's samples; it outlives them.
PointOf sample_points(const VertexLightmap& lightmap, const RayScene& rays);

/// By gather_point() at each of `count` places.
///
/// light   made for a gather, see gather_illumination().
/// layers  null, or layers that sum to this light: with the same rays PointIrradiance::layers, which sum to E.
/// Threads: same bits for any thread count. Cost: 0.1 (draft) to 2 ms (fine) a point and core.
PointIrradiance gather_at(const Illumination& light, std::size_t count, const PointOf& point_of,
                          const GatherPattern& pattern, std::string_view stage, const Monitor& monitor = {},
                          const RowLight* layers = nullptr);

/// Rows of these places, to be kept: irradiance() of them under other light sends no rays. Where they look is chosen
/// for this light. 16 bytes a ray: 5 to 30 kB a sensor.
LightRows gather_rows_at(const Illumination& light, std::size_t count, const PointOf& point_of,
                         const GatherPattern& pattern);

/// Sets lightmap.E (and std_error where there is one) of the points all of whose samples were reached; others keep what
/// lightmap.E held: fill it with average_to_points() before.
void set_points(const PointIrradiance& at_samples, VertexLightmap& lightmap);

}  // namespace clerestory
