#pragma once
// What a point sees of a planar polygon, as a map from the unit square to directions.

#include <array>
#include <span>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// Directions from p to the part of a polygon above p's horizon.
///
/// Of rectangles, which most windows and lamps are, u and v run along the sides: edges along them (sills, horizons,
/// shelves) pass few cells of a grid. Of other polygons, (u, v) goes to one of the triangles in proportion to its solid
/// angle, and evenly into it. p may lie anywhere: in the polygon's plane it sees nothing. Sources: Urena,
/// Fajardo & King, "An area-preserving parametrization for spherical rectangles", 2013; Arvo, "Stratified sampling of
/// spherical triangles", 1995; triangles too small for it are taken as plane.
class PolygonView {
 public:
  /// triangles  that cover the polygon and do not overlap; corners: its outline.
  PolygonView(const Vec3& p, const Vec3& n, std::span<const std::array<Vec3, 3>> triangles,
              std::span<const Vec3> corners);

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

  /// Of Urena et al., in the frame of the sides around p.
  struct Rectangle {
    Vec3 x, y, z;
    double x0, x1, y0, y1, z0, b0, b1, k;
  };
  bool set_rectangle(const Vec3& p, std::span<const Vec3> corners);
  Sight look_at_rectangle(double u, double v) const;

  std::vector<Part> parts_;  ///< empty for a rectangle
  Rectangle rectangle_{};
  double solid_angle_ = 0;
};

}  // namespace clerestory
