#pragma once
// Where the solution is shown: patches as triangles with vertices shared where the surface is smooth.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/patch_set.h"
#include "solver/model/vec.h"

namespace clerestory {

/// N triangles (cell i is patch i) on P points. Two patches share a point only where the surface goes on smoothly on
/// that side of it: not around corners, not over rims, not past a partition that stands on it, not across materials.
struct VertexLightmap {
  std::vector<std::array<std::uint32_t, 3>> corners;  ///< N, points, counter-clockwise from the lit side
  /// N, by edge k from corner k to the next: the patch met first when turning off this patch's side over that edge,
  /// around corners and rims too; kNone at an open end.
  std::vector<std::array<std::uint32_t, 3>> neighbour;
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::vector<Vec3> position;                 ///< P, local frame of the PatchSet [m]
  std::vector<std::uint32_t> patch_of_point;  ///< P, one of the patches that share the point
  Field E;                                    ///< P, irradiance [W/m2]; filled after the solve
  Field std_error;                            ///< P, standard error of E; empty unless E is a random estimate

  /// Facets around a point that face as one: cosine of 8 degrees, as turning a facet so far changes E by little.
  static constexpr double kAlike = 0.99;
  /// Share of the way to a facet's centroid that a sample is off its point at least: far enough from edges for single
  /// precision rays, too near to be seen.
  static constexpr double kWayToCentroid = 2e-3;
  /// The same where something ends a little off the surface: right under it a slit's light is as bright as outdoors, on
  /// a strip as narrow as the slit, and would be drawn out over all of the elements there.
  static constexpr double kWayFromOutline = 0.25;
  /// What samples keep away from edges, where their facet has the room: four times what single precision loses at the
  /// rim of the model [m].
  double off_edges = 0;
  static constexpr double kOffEdges = 2e-7;  ///< of the model's diagonal
  /// Share of the way to the centroid of a facet of that height over its edges at the point [m].
  static double way_inside(double height, double off_edges) {
    return height > 0 ? std::clamp(3 * off_edges / height, kWayToCentroid, kWayFromOutline) : kWayToCentroid;
  }
  // Where irradiance is gathered, S samples: one for each direction that the facets around a point face, so one for a
  // point of a flat surface. Point p has samples sample_begin[p] .. sample_begin[p + 1] - 1, of weights that sum to 1.
  std::vector<std::uint32_t> sample_begin;  ///< P + 1
  std::vector<Vec3> sample_position;        ///< S, on a facet, a little away from the point: off edges and contacts [m]
  std::vector<Vec3> sample_normal;          ///< S, unit, of that facet
  std::vector<double> sample_weight;        ///< S
};

/// Points' E as the area-weighted mean of the patches that share them.
void average_to_points(const PatchSet& patches, const Field& patch_E, VertexLightmap& lightmap);

}  // namespace clerestory
