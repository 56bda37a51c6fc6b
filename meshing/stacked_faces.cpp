#include "meshing/stacked_faces.h"

#include <algorithm>

#include "solver/model/box.h"

namespace clerestory {

HeightAsRead height_as_read(const FaceComplex& complex, const Plane& plane, const Face& face) {
  HeightAsRead height{Box::kHuge, -Box::kHuge};
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = plane.distance(complex.as_read(face, k));
    height.low = std::min(height.low, d), height.high = std::max(height.high, d);
  }
  return height;
}

double gap_between(const FaceComplex& complex, const HeightAsRead& a, const HeightAsRead& b) {
  const double least = std::max(complex.rounding, (a.high - a.low) + (b.high - b.low));
  if (b.low - a.high > least) return b.low - a.high;
  if (a.low - b.high > least) return b.high - a.low;
  return 0;
}

}  // namespace clerestory
