#pragma once
// p -> A p + b in double precision: node transforms and the way from a file's frame into the scene's.

#include <array>

#include "solver/model/vec.h"

namespace clerestory {

struct Affine {
  std::array<Vec3, 3> A{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};  ///< by rows
  Vec3 b;

  Vec3 direction(const Vec3& d) const { return {dot(A[0], d), dot(A[1], d), dot(A[2], d)}; }
  Vec3 point(const Vec3& p) const { return direction(p) + b; }
  double determinant() const { return dot(A[0], cross(A[1], A[2])); }
  bool mirrors() const { return determinant() < 0; }
};

/// outer(inner(p))
inline Affine operator*(const Affine& outer, const Affine& inner) {
  Affine both;
  for (std::size_t r = 0; r < 3; ++r) {
    both.A[r] = outer.A[r].x * inner.A[0] + outer.A[r].y * inner.A[1] + outer.A[r].z * inner.A[2];
  }
  both.b = outer.point(inner.b);
  return both;
}

}  // namespace clerestory
