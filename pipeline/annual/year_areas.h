#pragma once
// Rooms and grids of a year: which points they are of, and which blinds are closed in them.

#include <cstdint>
#include <memory>
#include <vector>

#include "pipeline/annual/solve_year.h"
#include "pipeline/annual/window_state.h"

namespace clerestory {

/// Rooms that people use, by what faces up in them within 25 degrees, floors and tables, each point with the area
/// around it; those without any are left out.
std::vector<YearArea> rooms_facing_up(const PatchSet& patches, const VertexLightmap& map);
/// Number among `rooms` of each point's room; rooms.size(): it is in none of them.
std::vector<std::uint32_t> room_of_points(const PatchSet& patches, const VertexLightmap& map,
                                          const std::vector<YearArea>& rooms);

/// One for each set of sensors.
std::vector<YearArea> grids_of(const std::vector<SensorSet>& sets);
/// Number of the set of each sensor.
std::vector<std::uint32_t> set_of_sensors(const std::vector<SensorSet>& sets);

/// Fills YearArea::blinds and closed.
void operate_blinds(const std::vector<std::unique_ptr<WindowState>>& states, std::span<const PlacesOfPoint> points,
                    const YearRules& rules, const Monitor& monitor, std::vector<YearArea>& areas);

/// Figures of all rooms and grids.
void add_up(YearSolved& year);

}  // namespace clerestory
