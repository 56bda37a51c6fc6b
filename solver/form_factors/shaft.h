#pragma once
// Which pairs of patches need no rays, because nothing stands in the shaft between them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Axis-parallel box.
struct Box {
  Vec3 lower, upper;

  static Box around(std::span<const Vec3> points);
  void grow(const Box& other);
};

/// The triangles of a PatchSet that can stand between anything, in a tree of boxes.
///
/// A triangle that has the whole scene on one side of its plane blocks nothing: the walls of a convex room are left out,
/// and what remains is furniture. All tests are safe: what is not listed does not block (touching is not blocking).
class Blockers {
 public:
  explicit Blockers(const PatchSet& patches);

  bool empty() const { return nodes_.empty(); }
  std::size_t triangle_count() const { return triangles_; }
  double touching() const { return touching_; }  ///< distance [m] below which touching is not reaching in
  /// Boxes of blockers that reach into the convex hull of a and b, into `boxes` (cleared first).
  /// Source: Haines & Wallace, "Shaft culling for efficient ray-traced radiosity", 1991.
  void in_shaft(const Box& a, const Box& b, std::vector<Box>& boxes) const;

 private:
  struct Node {
    Box box;
    std::uint32_t right = 0;  ///< the left child follows its parent; 0: a leaf
  };
  std::uint32_t build(std::span<Box> boxes);

  std::vector<Node> nodes_;
  std::size_t triangles_ = 0;
  double touching_ = 0;
};

/// True when the box reaches into the hull of two triangles on the front of both: tested by the planes of both, their
/// common bounding box, and the planes through an edge of one and a corner of the other that hold the hull on one side.
class PairShaft {
 public:
  PairShaft(std::span<const Vec3, 3> p, const Vec3& normal_p, std::span<const Vec3, 3> q, const Vec3& normal_q,
            double touching);
  bool reaches(const Box& box) const;

 private:
  struct HalfSpace {
    Vec3 normal;    ///< the hull lies where dot(normal, x) <= offset
    double offset;
  };
  void hold(const Vec3& normal, double offset) { side_[sides_++] = {normal, offset}; }
  void hold_scaled(const Vec3& normal, const Vec3& point);

  Box bounds_;
  std::array<HalfSpace, 20> side_;
  std::size_t sides_ = 0;
  double touching_;
};

}  // namespace clerestory
