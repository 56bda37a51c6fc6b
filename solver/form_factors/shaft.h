#pragma once
// Which pairs of patches need no rays, because nothing stands in the shaft between them.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/box.h"
#include "solver/model/patch_set.h"
#include "solver/model/vec.h"

namespace clerestory {

/// A triangle that can stand between others.
struct Blocker {
  std::array<Vec3, 3> corner;
  Vec3 normal;        ///< unit
  double offset = 0;  ///< of its plane, dot(normal, x) = offset
};

/// A convex polygon of opaque triangles in one plane: the side of a box, a wall without a door.
struct Screen {
  Vec3 normal;  ///< unit
  double offset = 0;
  struct Edge {
    Vec3 inward;  ///< unit, in the plane
    double offset = 0;
  };
  std::vector<Edge> edges;
  Box box;

  /// True when every segment between the triangles crosses the inside of the polygon: it hides one from the other.
  bool hides(std::span<const Vec3, 3> p, std::span<const Vec3, 3> q, double touching) const;
};

/// The triangles of a PatchSet that can stand between anything, in a tree of boxes.
///
/// A triangle that has the whole scene on one side of its plane blocks nothing: the walls of a convex room are left
/// out, and what remains is furniture. All tests are safe: what is not listed does not block (touching is not
/// blocking).
class Blockers {
 public:
  explicit Blockers(const PatchSet& patches);

  bool empty() const { return nodes_.empty(); }
  std::size_t triangle_count() const { return triangles_.size(); }
  double touching() const { return touching_; }  ///< distance [m] below which touching is not reaching in
  /// Triangles whose boxes reach into the convex hull of a and b, into `found` (cleared first).
  /// Source: Haines & Wallace, "Shaft culling for efficient ray-traced radiosity", 1991.
  void in_shaft(const Box& a, const Box& b, std::vector<const Blocker*>& found) const;
  /// Screens that reach into the convex hull of a and b. What they hide needs no rays either.
  void screens_in_shaft(const Box& a, const Box& b, std::vector<const Screen*>& found) const;

 private:
  struct Node {
    Box box;
    std::uint32_t right = 0;    ///< an inner node's; its left child follows it
    std::uint32_t blocker = 0;  ///< a leaf's
  };
  std::uint32_t build(std::size_t begin, std::size_t end);
  void find_screens(const PatchSet& patches, const std::vector<std::uint8_t>& blocks);

  std::vector<Node> nodes_;
  std::vector<Blocker> triangles_;
  std::vector<Screen> screens_;
  double touching_ = 0;
};

/// Where light between two triangles may pass: the hull of both on the front of both, by the planes of both, their
/// common bounding box, and the planes through an edge of one and a corner of the other that hold the hull on one side.
class PairShaft {
 public:
  PairShaft(std::span<const Vec3, 3> p, const Vec3& normal_p, std::span<const Vec3, 3> q, const Vec3& normal_q,
            double touching);
  /// False when the triangle is proven to block nothing of the pair.
  bool reached_by(const Blocker& blocker) const;

 private:
  struct Bound {
    Vec3 normal;  ///< the hull lies where dot(normal, x) <= offset
    double offset;
  };
  void hold(const Vec3& normal, double offset) { side_[sides_++] = {normal, offset}; }

  Box bounds_;
  std::array<Vec3, 6> corner_;
  std::array<Bound, 20> side_;
  std::size_t sides_ = 0;
  double touching_;
};

}  // namespace clerestory
