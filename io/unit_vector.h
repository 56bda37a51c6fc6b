#pragma once

#include <algorithm>
#include <cmath>

#include "solver/model/vec.h"

namespace clerestory {

/// v / |v|, also where |v|^2 would overflow or vanish: 1e200 and 1e-200 are directions as well. Zero stays zero.
inline Vec3 unit_vector(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest > 0 ? normalized(Vec3{v.x / largest, v.y / largest, v.z / largest}) : v;
}

}  // namespace clerestory
