#pragma once
// Where faces of different planes touch or cross.

#include <array>
#include <cstdint>
#include <vector>

#include "meshing/surface_complex.h"

namespace clerestory {

/// The line that two faces have in common, a point where they only touch.
struct Contact {
  std::uint32_t face_a, face_b;  ///< a < b
  std::array<Vec3, 2> end;
  double tolerance;  ///< within which the smaller of the faces is exact
};

/// group_of: of each face, the number of its plane. Those that share an edge, or only a corner, are left out.
/// returns  sorted by their faces
/// throws   InputError where more touch than a building has: see CrowdLimit
std::vector<Contact> find_contacts(const FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                   const std::vector<std::uint32_t>& group_of);

}  // namespace clerestory
