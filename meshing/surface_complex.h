#pragma once
// The surfaces between the steps of meshing: triangles on shared vertices, planes that hold them, lines that part them.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/ids.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Tolerances, in the unit of the working frame: the model's diagonal is 1 there, its centre is the origin.
/// Coordinates of single precision files lie within 1e-7 of where they should.
inline constexpr double kWeld = 2e-7;     ///< points closer than this are one point
inline constexpr double kContact = 4e-7;  ///< a point closer than this to a line or a plane lies on it
/// No tolerance is larger than this share of the faces it is used on, so that fine detail of a large model survives.
inline constexpr double kLocalShare = 0.01;

struct Face {
  std::array<std::uint32_t, 3> corner;  ///< counter-clockwise around the front
  MaterialId material;
  SurfaceId surface;
};

/// Faces as read, without the defects that a face has by itself. Faces may still overlap, touch and cross each other.
struct FaceComplex {
  Vec3 origin;      ///< of the working frame, in the scene's frame [m]
  double size = 1;  ///< of the unit of the working frame [m]
  std::vector<Vec3> vertices;
  std::vector<Face> faces;
};

struct Point2 {
  double x = 0, y = 0;
};

/// A plane with a frame: (t, b) in the plane, n normal to it.
struct Plane {
  Vec3 origin, t, b, n;
  double distance(const Vec3& p) const { return dot(p - origin, n); }
  Point2 flatten(const Vec3& p) const { return {dot(p - origin, t), dot(p - origin, b)}; }
  Vec3 lift(const Point2& p) const { return origin + t * p.x + b * p.y; }
};

/// Faces that lie in one plane and hang together, whatever their material and whichever way they face.
struct PlaneGroup {
  Plane plane;
  std::vector<std::uint32_t> faces;
};

/// A straight line between two vertices that is drawn in a plane group.
struct Line {
  std::uint32_t group, a, b;  ///< a < b
  friend auto operator<=>(const Line&, const Line&) = default;
};
inline Line line(std::uint32_t group, std::uint32_t a, std::uint32_t b) {
  return a < b ? Line{group, a, b} : Line{group, b, a};
}

/// What a part of a plane shows on its two sides; + is the side of Plane::n.
struct Sheet {
  MaterialId material_above, material_below;
  SurfaceId surface_above, surface_below;
  bool flipped = false;  ///< the front of the face that was drawn here is the side below
  bool joined = false;   ///< two faces of opposite winding lie here: both sides are fronts
  friend bool operator==(const Sheet&, const Sheet&) = default;
};

/// A group ready to be meshed.
struct PlanarDomain {
  std::uint32_t group = 0;
  std::vector<std::array<std::uint32_t, 2>> lines;  ///< that meet only at their ends
  std::vector<std::uint32_t> points;                ///< single points that must become vertices
};

}  // namespace clerestory
