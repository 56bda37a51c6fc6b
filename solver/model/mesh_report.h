#pragma once
// What meshing found and repaired, and how good the patches are.

#include <cstddef>

#include "solver/model/vec.h"

namespace clerestory {

struct MeshReport {
  Vec3 lower, upper;     ///< extent of the model, scene frame [m]
  double tolerance = 0;  ///< points closer than this to a line or plane were taken to lie on it [m]
  std::size_t input_faces = 0, input_triangles = 0;
  // Repairs, as counts.
  std::size_t welded_vertices = 0;      ///< vertices that fell together with another
  std::size_t non_finite_faces = 0;     ///< dropped: a corner is NaN or infinite
  std::size_t degenerate_faces = 0;     ///< dropped: zero area
  std::size_t duplicate_faces = 0;      ///< dropped: the same corners again, wound the same way
  std::size_t opposite_faces = 0;       ///< joined: the same corners, wound the other way, now one two-sided face
  std::size_t overlapping_regions = 0;  ///< coplanar surfaces that covered each other and were cut apart
  std::size_t t_junctions = 0;          ///< vertices found inside another face's edge, now shared
  std::size_t imprinted_contacts = 0;   ///< lines where surfaces touch or cross, now edges of both
  std::size_t imprinted_outlines = 0;   ///< lines over which something ends a little off a surface, now edges of it
  std::size_t simplified_parts = 0;     ///< parts whose finest facets were merged
  std::size_t simplified_faces = 0;     ///< faces that went with that
  double simplified_by = 0;             ///< no surface was moved farther by it [m]
  std::size_t non_manifold_edges = 0;   ///< edges of more than two faces (not a defect by itself)
  std::size_t boundary_edges = 0;       ///< edges of one face
  std::size_t planar_regions = 0;       ///< polygons with holes after joining coplanar faces of one material
  // Quality of the triangles.
  std::size_t triangles = 0;
  double max_element = 0;                            ///< bound on the longest edge that was in force [m]
  double longest_edge = 0, shortest_edge = 0;        ///< [m]
  double worst_angle_deg = 0, median_angle_deg = 0;  ///< smallest angle of a triangle: worst and median
};

}  // namespace clerestory
