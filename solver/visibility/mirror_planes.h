#pragma once
// Planes that show images of lights, and the way that the light of an image takes.

#include <array>
#include <cstddef>
#include <cstdint>

#include "solver/model/vec.h"

namespace clerestory {

inline constexpr std::uint32_t kNoPlane = 0xffffffff;  ///< among those that show images

/// A plane with mirrors or panes of glass in it.
struct MirrorPlane {
  Vec3 normal;        ///< unit
  double offset = 0;  ///< dot(normal, x) = offset in the plane [m]
  bool is_glass = false;

  // A rectangle in the plane around all that turns light there.
  Vec3 u, v;                                                      ///< unit, along its sides
  std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};  ///< along u and v [m]

  double height(const Vec3& x) const { return dot(normal, x) - offset; }
  Vec3 image_of(const Vec3& x) const { return x - normal * (2 * height(x)); }
  Vec3 image_of_direction(const Vec3& d) const { return d - normal * (2 * dot(normal, d)); }
  void add(const Vec3& x);
  /// Whether any of the rectangle is in front of a surface at p with normal n.
  bool is_over(const Vec3& p, const Vec3& n) const;
  bool is_within(const Vec3& x, double margin) const;
};

/// Without a rectangle yet.
MirrorPlane mirror_plane(const Vec3& normal, double offset, bool is_glass);

/// Planes that light takes one after another from a light to where its image is seen, by their number; none for the
/// light itself.
struct MirrorWay {
  static constexpr std::size_t kMost = 15;
  std::array<std::uint8_t, kMost> plane{};
  std::uint8_t count = 0;

  bool empty() const { return count == 0; }
  MirrorWay over(std::size_t next) const {
    MirrorWay way = *this;
    way.plane[way.count++] = static_cast<std::uint8_t>(next);
    return way;
  }
  /// Needs: not empty.
  MirrorWay without_last() const {
    MirrorWay way = *this;
    way.plane[--way.count] = 0;
    return way;
  }
  friend auto operator<=>(const MirrorWay&, const MirrorWay&) = default;
};

}  // namespace clerestory
