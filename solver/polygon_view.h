#pragma once
// What a point sees of a planar polygon, as a map from the unit square to directions.

#include <array>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Directions from p to the part of a polygon above p's horizon, given as triangles that do not overlap.
///
/// Each triangle is cut by the plane through p with normal n; (u, v) goes to what is left of one in proportion to its
/// solid angle, and evenly into it. p may lie anywhere: in the polygon's plane it sees nothing. Cost: 0.2 us a triangle.
/// Source: Arvo, "Stratified sampling of spherical triangles", 1995; triangles too small for it are taken as plane.
class PolygonView {
 public:
  PolygonView(const Vec3& p, const Vec3& n, std::span<const std::array<Vec3, 3>> triangles);

  double solid_angle() const { return solid_angle_; }  ///< [sr], 0: nothing of it is above the horizon

  struct Sight {
    Vec3 direction;    ///< unit
    double per_share;  ///< solid angle there for each share of the unit square, close to solid_angle() [sr]
  };
  /// solid_angle() > 0.
  Sight look(double u, double v) const;

 private:
  struct Part {
    std::array<Vec3, 3> to;  ///< unit, from p to its corners
    double solid_angle, cumulative;
  };
  void add(const Vec3& p, std::array<Vec3, 3> corners);

  std::vector<Part> parts_;
  double solid_angle_ = 0;
};

}  // namespace clerestory
