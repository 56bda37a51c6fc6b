#pragma once
// How much sun falls into each room in an hour, and what that does to light that is known between nodes of the sun.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/annual/reflected_daylight.h"
#include "solver/annual/sun_nodes.h"
#include "solver/annual/sun_on_points.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// Factor on what nodes say of the light that surfaces of a room send on of the sun, rooms x hours by room: a wall,
/// a reveal or glass seen at a slant let in more or less than is linear between nodes.
///
///   factor = 1 + m (D - sum w D_node) / sum w B_node,   m = min over nodes of B_node / D_node
///
/// D: what surfaces of the room send on of the sun that falls on them straight, by rays of this hour; B: of all light.
/// m is what becomes of it by further reflections: light of other origin, as from a ground in the sun, makes the ratio
/// larger. Of what is outdoors 1: nothing there is seen through a gap.
///
/// suns       with sun, ascending; hour_of_sun: of H hours; of_hour: H, among nodes.
/// Threads: same bits for any thread count. Cost: two rays an element that any node's sun reaches, and hour.
std::vector<float> sun_in_rooms(const PatchSet& elements, const RayScene& rays, const ReflectedDaylight& reflected,
                                std::span<const SunOfHour> suns, std::span<const std::size_t> hour_of_sun,
                                std::span<const AmongNodes> of_hour, std::uint64_t seed);

}  // namespace clerestory
