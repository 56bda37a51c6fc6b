#pragma once
// The surfaces between the steps of meshing: triangles on shared vertices, planes that hold them, lines that part them.

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "solver/model/ids.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Lengths below which differences are taken for rounding, in the unit of the working frame: there the model's diagonal
/// is 1 and its centre is the origin.
struct Tolerance {
  double contact;  ///< a point closer than this to a line or a plane lies on it
  double
      local_share;  ///< no tolerance is more than this share of the faces it is used on, so that fine detail survives
};
/// Coordinates of single precision files lie within 1e-7 of where they should. Where a model turns out to be less exact
/// (rounded to millimetres, say), it is tried again with the next.
inline constexpr std::array kTolerances{Tolerance{6e-7, 0.01}, Tolerance{5e-6, 0.1}, Tolerance{2e-5, 1},
                                        Tolerance{1e-4, 1}};

struct Face {
  static constexpr std::uint32_t kNone = 0xffffffff;
  std::array<std::uint32_t, 3> corner;  ///< counter-clockwise around the front
  MaterialId material;
  SurfaceId surface;
  std::array<std::uint32_t, 3> read_at{kNone, kNone, kNone};  ///< in FaceComplex::before_welding; kNone: at the corner
};

/// Faces as read, without the defects that a face has by itself. Faces may still overlap, touch and cross each other.
struct FaceComplex {
  std::string file;  ///< that messages name
  Vec3 origin;       ///< of the working frame, in the scene's frame [m]
  double size = 1;   ///< of the unit of the working frame [m]
  Tolerance allowed = kTolerances[0];
  std::vector<Vec3> vertices;
  std::vector<double>
      tolerance;  ///< by vertex: `allowed.contact`, less where small faces meet; a line takes its coarser end's
  std::vector<Face> faces;
  std::vector<Face> flat;  ///< triangles without area whose corners differ: what they close is closed only with them
  std::vector<Vec3> before_welding;  ///< the model's vertices
  double rounding = 0;  ///< what may be chance between coordinates as they were read: that of their number format

  /// Corner k of a face, where it was before it was welded to others.
  const Vec3& as_read(const Face& face, std::size_t k) const {
    return face.read_at[k] == Face::kNone ? vertices[face.corner[k]] : before_welding[face.read_at[k]];
  }
  std::uint32_t add_vertex(const Vec3& p, double tolerance_there) {
    vertices.push_back(p);
    tolerance.push_back(tolerance_there);
    return static_cast<std::uint32_t>(vertices.size()) - 1;
  }
  /// Whether a triangle is higher than what is taken for rounding.
  bool has_area(const std::array<std::uint32_t, 3>& corner) const;
  double line_tolerance(std::uint32_t a, std::uint32_t b) const { return std::max(tolerance[a], tolerance[b]); }
};

using Ends = std::array<std::uint32_t, 2>;  ///< vertices of a line

struct Point2 {
  double x = 0, y = 0;
};

/// What meshing takes of things that lie in one place. Their pairs grow with the square of their number: no building
/// has so many of them, and nobody waits for what has.
struct CrowdLimit {
  std::string_view what;  ///< "pairs of faces lie so close that their boxes touch"
  std::size_t most;

  /// throws  InputError when there are more.
  void check(std::size_t count, const FaceComplex& complex) const;
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

/// A drawn line that stands for the outline of something off the plane, on the side of Plane::n or on the other one.
struct OutlineLine {
  Line line;
  bool above;
  friend auto operator<=>(const OutlineLine&, const OutlineLine&) = default;
};
/// On which sides of its plane a line is such an outline.
enum OutlineSides : std::uint8_t { kNoOutline = 0, kOutlineAbove = 1, kOutlineBelow = 2 };

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
  std::vector<std::uint8_t> outline;                ///< by line, OutlineSides; empty: none is one
  std::vector<std::uint32_t> points;                ///< single points that must become vertices
};

}  // namespace clerestory
