#pragma once
// What the hierarchical method did, as shapes to look at.

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Lines or triangles, and named values of each.
template <std::size_t Corners>
struct DebugShapes {
  std::vector<std::array<Vec3, Corners>> shapes;  ///< local frame of the PatchSet [m]
  std::vector<std::pair<std::string, std::vector<double>>> values;
};

/// Filled by hierarchical() and hierarchical_field() when asked for; empty where a run was stopped before.
struct HierarchyDebug {
  /// Leaf elements of the transport. level: halvings since the patch; cluster: node of the smallest cluster around it;
  /// links: of its receiver; receiver: number of that, in the order of the tree; irradiance: luminous mean [W/m2].
  DebugShapes<3> hierarchy;
  /// Links of the receiver that has the most, from its centre to those of the nodes it receives from. weight [1];
  /// source_radiosity: luminous mean [W/m2].
  DebugShapes<2> links;
  /// The bundle of the same receiver. landed_radiosity: of the element, or pi L of the sky, luminous mean [W/m2]; 0 in
  /// glass and on sides that take no part. Rays that escape are as long as the longest that do not.
  DebugShapes<2> rays;
  /// Leaves that are shown and whose vertices were gathered. interpolation_error: how far the middle of an edge may lie
  /// off, and std_error: standard error at the vertices, both relative to the irradiance there [1]; level.
  DebugShapes<3> error;
};

}  // namespace clerestory
