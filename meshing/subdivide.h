#pragma once
// Planar regions -> conforming, well-shaped triangles.

#include <span>
#include <vector>

#include "meshing/surface_complex.h"
#include "solver/model/material.h"
#include "solver/model/mesh_report.h"
#include "solver/model/monitor.h"

namespace clerestory {

struct MeshTriangle {
  std::array<std::uint32_t, 3> corner;     ///< counter-clockwise around the front
  Sheet sheet;                             ///< above: seen from the front
  std::array<std::uint8_t, 2> outlines{};  ///< by Side, bit k: an outline runs along the edge from corner k to the next
};

/// Constrained Delaunay refinement of all regions, with edges of at most `longest` (unit of the working frame).
///
/// Lines are first divided evenly. Then triangles that are too long or whose smallest angle is below 25 degrees get a
/// vertex at their circumcentre; where that would fall beyond or too close to a line, the line is to be halved instead.
/// Halvings that any region asked for are made in all regions that share the line, and another round begins: so regions
/// agree on every shared line by construction. Angles are bettered only down to a fifth of `longest`, so that needles
/// and small gaps cost a bounded number of triangles.
/// New vertices are appended to complex.vertices. Threads: same result for any number.
/// Source: Ruppert, "A Delaunay refinement algorithm for quality 2-dimensional mesh generation", 1995.
std::vector<MeshTriangle> subdivide(FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                    std::span<const Material> materials, const std::vector<PlanarDomain>& domains,
                                    double longest, MeshReport& report, const Monitor& monitor);

/// About how many triangles `subdivide` will give [1].
double estimate_triangles(const FaceComplex& complex, const std::vector<PlanarDomain>& domains, double area,
                          double longest);

}  // namespace clerestory
