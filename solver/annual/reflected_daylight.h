#pragma once
// What surfaces send on of each part of the sky and of the sun at each node.

#include <cstddef>
#include <span>
#include <vector>

#include "solver/annual/sky_parts.h"
#include "solver/annual/sun_nodes.h"
#include "solver/methods/kept_transport.h"
#include "solver/model/monitor.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Radiosity of N elements in lanes: sky parts, the ground, sun nodes. Each lane's light is white and 1: radiance of a
/// part [W/(m2 sr)], irradiance of a plane that faces the sun [W/m2].
struct ReflectedDaylight {
  std::size_t lanes = 0;  ///< parts + 1 + nodes
  int channels = 1;
  std::vector<float> B;                          ///< N x channels x lanes
  std::vector<std::vector<MirrorWay>> sun_ways;  ///< of each node, over which mirrors and panes its light comes, too

  std::span<const float> of(std::size_t element, int channel) const {
    return std::span(B).subspan(
        (element * static_cast<std::size_t>(channels) + static_cast<std::size_t>(channel)) * lanes, lanes);
  }
};

/// Balances the transport for all of them, a few lanes at a time: 4 bytes an element, channel and lane.
///
/// kept     of a solve under a sky, complete.
/// patches  that it was solved for, with mirrors and panes: over them the sun comes, too.
/// nodes    directions of the sun.
/// Threads: same bits for any thread count. Cost: 8 to 24 rays an element and node; one balance for 32 lanes.
ReflectedDaylight reflect_daylight(const KeptTransport& kept, const PatchSet& patches, const RayScene& rays,
                                   const SkyParts& parts, std::span<const Vec3> nodes, std::uint64_t seed,
                                   const Monitor& monitor = {});

}  // namespace clerestory
