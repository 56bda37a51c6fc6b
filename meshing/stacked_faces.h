#pragma once
// Faces that are joined in one plane although they were read as lying over each other.

#include "meshing/surface_complex.h"

namespace clerestory {

/// Where the corners of a face lie over a plane as they were read, before welding, in the working frame.
struct HeightAsRead {
  double low, high;
};
HeightAsRead height_as_read(const FaceComplex& complex, const Plane& plane, const Face& face);

/// The distance of b over a when both were read as parallel sheets that are further apart than rounding explains
/// (FaceComplex::rounding) and than they are tilted; else 0: what lies between may be chance.
double gap_between(const FaceComplex& complex, const HeightAsRead& a, const HeightAsRead& b);

}  // namespace clerestory
