#pragma once
// What a luminaire sends to a triangle, by solid angle: exact however near it is.

#include <array>
#include <vector>

#include "solver/lights/beam.h"
#include "solver/sampling/spherical_triangle.h"

namespace clerestory {

/// Whether points spread evenly over the triangle would miss how the light of the luminaire varies there: it is near,
/// for the triangle's size, or its beam is narrow as seen from there.
bool wants_view(const Luminaire& luminaire, const Beam& beam, const std::array<Vec3, 3>& corners);

/// A triangle as it is seen from a point of a luminaire: the flux that goes there, when nothing blocks,
///   integral of I over the solid angle of the triangle,
/// which is I times the solid angle where the intensity is even. Else the spherical triangle is halved until the
/// intensity at corners and middle tells its mean: the sum over a closed room is the luminaire's flux within 1e-3.
class LuminaireView {
 public:
  /// corners  counter-clockwise seen from the side of the normal (unit). All outlive it.
  LuminaireView(const Luminaire& luminaire, const Beam& beam, const std::array<Vec3, 3>& corners, const Vec3& normal)
      : luminaire_(luminaire), beam_(beam), corners_(corners), normal_(normal) {}

  /// Looks from point q of the luminaire. Returns the flux [W], luminous mean; 0 from the plane and from behind it.
  /// is_one_of_many: more roughly, for a mean over many points.
  double look_from(const Vec3& q, bool is_one_of_many = false);
  /// Point of the triangle, distributed like the flux that look_from() found > 0 (where it is seen all but edge-on, in
  /// less than 1e-6 sr, nearly so).
  Vec3 lit_point(double u, double v) const;

 private:
  struct Cell {
    SphericalTriangle to;
    std::array<double, 3> I;  ///< at the corners [W/sr]
    double solid_angle;
    double flux = 0, bend = 0;  ///< bend: intensity at the middle less the mean of the corners [W/sr]
    double cumulative = 0;
  };
  Cell cell(const SphericalTriangle& to, const std::array<double, 3>& I) const;
  /// Where a cell lies in a beam: no light gets there, or the edge of a spot runs through it.
  enum class Place { outside, inside, on_edge };
  Place place_of(const Cell& cell) const;
  double intensity_towards(const Vec3& d) const;
  void add(const Cell& whole);

  const Luminaire& luminaire_;
  const Beam& beam_;
  const std::array<Vec3, 3>& corners_;
  Vec3 normal_, q_;
  double most_off_ = 0;  ///< flux that a cell may be wrong by [W]
  double flat_ = 0;      ///< bend that the formula for a cell is trusted with [W/sr]
  std::vector<Cell> cells_, waiting_;
};

}  // namespace clerestory
