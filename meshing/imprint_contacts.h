#pragma once
// Where surfaces touch or cross, both get the line.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "meshing/find_outlines.h"
#include "meshing/surface_complex.h"
#include "solver/model/mesh_report.h"

namespace clerestory {

/// What must be drawn into each plane: sorted, unique, and lines meet only at their ends.
struct Drawing {
  std::vector<Line> lines;
  std::vector<OutlineLine> outlines;  ///< those of the lines that stand for one, sorted and unique too
  std::vector<std::pair<std::uint32_t, std::uint32_t>> points;  ///< group, vertex
  bool settled = true;  ///< false: lines still cross after all, because the model is less exact than its tolerance
};

/// Draws the edges of all faces, the lines along which faces of different planes touch or cross, and outlines, then
/// splits every line at each vertex that lies on it and where lines of one plane cross. New vertices are added to
/// `complex`; points closer than the tolerance become one. Cost: O(F log F) plus the number of pairs of faces whose
/// boxes touch.
Drawing imprint_contacts(FaceComplex& complex, const std::vector<PlaneGroup>& groups, std::span<const Outline> outlines,
                         MeshReport& report);

/// The last step of it, for lines that changed: splits lines at the vertices used by any of them that lie on them.
void split_at_vertices(const FaceComplex& complex, Drawing& drawing);

}  // namespace clerestory
