#include "solver/annual/reflected_daylight.h"

#include <algorithm>
#include <utility>

#include "solver/hierarchy/sky_views.h"
#include "solver/illumination/find_images.h"
#include "solver/illumination/illumination.h"
#include "solver/model/assert.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/sampling/packed_direction.h"

namespace clerestory {
namespace {

constexpr std::size_t kAtOnce = 32;  ///< lanes, times channels: what is in double meanwhile
// Of all of a lane's flux, most of which may fall on ground and facades outside: what a room has is little of it.
constexpr double kResidual = 1e-6;

/// Straight from parts first, first + 1, ... of the sky, N x (count x channels).
Field straight_from_sky(const KeptTransport& kept, const SkyParts& parts, std::size_t first, std::size_t count) {
  const auto lane_of = [&](const Vec3& d) {
    const std::size_t part = parts.part_of(d);
    return part >= first ? part - first : count;
  };
  Field E = sky_irradiance_by_part(kept.elements, kept.tree, kept.transport, count, lane_of);
  const int channels = kept.elements.channels;
  parallel_for(E.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (const RowEntry& e : kept.direct.rows[i]) {
        if (!e.is_of_sky()) continue;
        const std::size_t lane = lane_of(unpack_direction(e.number()));
        for (int c = 0; c < channels && lane < count; ++c)
          E.at(i, static_cast<int>(lane) * channels + c) += double{e.weight[static_cast<std::size_t>(c)]};
      }
  });
  return E;
}

/// From the sun at each node, straight and over mirrors and panes, N x (nodes x channels).
///
/// patches  with mirrors and panes, which elements leave out.
Field from_suns(const KeptTransport& kept, const PatchSet& patches, const RayScene& rays, std::span<const Vec3> nodes,
                std::uint64_t seed, const Monitor& monitor, std::vector<std::vector<MirrorWay>>& ways) {
  Lights suns;
  std::vector<std::size_t> node_of_sun;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    Lights one;
    one.suns.push_back({Sun{nodes[k], Spectrum(1.0)}});
    add_images(one, patches, rays);
    std::vector<MirrorWay>& own = ways.emplace_back();
    for (PlacedSun& sun : one.suns) {
      if (sun.is_image()) own.push_back(sun.way);
      suns.suns.push_back(std::move(sun));
      node_of_sun.push_back(k);
    }
  }
  std::vector<Layer> all(nodes.size());
  for (Layer& layer : all) layer.lights.resize(suns.suns.size());
  for (std::size_t k = 0; k < node_of_sun.size(); ++k) all[node_of_sun[k]].lights[k] = Spectrum(1.0);
  const Problem problem{kept.elements, rays, suns};
  DirectRows rows;
  direct_light(Illumination(problem), {.shadow_rays = 8, .edge_rays = 16, .sky_rays = 0, .seed = seed}, monitor, &rows);
  return direct_layers(kept.elements, rows, all).delta_light;
}

}  // namespace

ReflectedDaylight reflect_daylight(const KeptTransport& kept, const PatchSet& patches, const RayScene& rays,
                                   const SkyParts& parts, std::span<const Vec3> nodes, std::uint64_t seed,
                                   const Monitor& monitor) {
  CLERESTORY_ASSERT(kept.complete, ==, true);
  const PatchSet& elements = kept.elements;
  const auto channels = static_cast<std::size_t>(elements.channels);
  const std::size_t n = elements.patch_count(), sky = parts.count() + 1, at_once = kAtOnce / channels;
  ReflectedDaylight out;
  out.lanes = sky + nodes.size(), out.channels = elements.channels;
  out.B.resize(n * channels * out.lanes);
  for (std::size_t first = 0, count; first < out.lanes; first += count) {
    monitor.report("reflected", static_cast<double>(first) / static_cast<double>(out.lanes));
    count = std::min(at_once, (first < sky ? sky : out.lanes) - first);
    const Field E =
        first < sky ? straight_from_sky(kept, parts, first, count)
                    : from_suns(kept, patches, rays, nodes.subspan(first - sky, count), seed, monitor, out.sun_ways);
    const Balanced s = balance(elements, kept.tree, kept.transport, Field(n, E.channels), E, {}, kResidual, monitor);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < count; ++k)
        for (std::size_t c = 0; c < channels; ++c)
          out.B[(i * channels + c) * out.lanes + first + k] =
              static_cast<float>(s.B.value[(i * count + k) * channels + c]);
  }
  return out;
}

}  // namespace clerestory
