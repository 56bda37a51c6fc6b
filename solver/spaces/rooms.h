#pragma once
// Rooms: where people would say a surface is.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/named_space.h"

namespace clerestory {

struct Rooms {
  std::vector<std::uint32_t> of_patch;  ///< N, a number below names.size()
  std::vector<std::string>
      names;  ///< "outdoors" first, where there is any; then by area, the largest first; last "smaller spaces"
};

/// Rooms that models name by volumes (scene's frame [m]), and the scene by surfaces; these go first.
struct NamedRooms {
  std::span<const NamedSpace> spaces;
  std::span<const NamedSurfaces> by_surface;
};

/// Patches that see each other belong together, but not through glass, in mirrors or through the openings that the sky
/// looks in by; nor where they see little of each other, as through a door. What sees the sky otherwise is outdoors.
/// Surfaces and volumes that are named decide before that.
///
/// Labels are handed on by the majority of what each patch sees (Raghavan et al. 2007), then those that see too much of
/// another are joined to it. The 16,384 largest patches do that, small ones then follow what they see.
/// Same result for any number of threads, and for every seed. Cost: about a hundred thousand rays, and 4 a small patch.
Rooms find_rooms(const Problem& problem, const NamedRooms& named, const Monitor& monitor = {});

}  // namespace clerestory
