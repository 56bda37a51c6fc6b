#pragma once
// Directions of a luminaire's light, exactly in proportion to its intensity.

#include <vector>

#include "solver/model/light_spec.h"
#include "solver/sampling/cumulative_table.h"

namespace clerestory {

/// Directions of a photometric web: a cell between its angles by the flux that goes there, in the cell by inverting
/// what its intensity, linear in both angles, sums up to. 12 bytes for each intensity of the web.
class WebDirections {
 public:
  explicit WebDirections(const PhotometricWeb& web);

  /// Unit direction in the luminaire's frame, of density candela_towards() / flux.
  Vec3 sample(double u, double v) const;

 private:
  /// Intensity at the corners of a cell: of the angle that directions lie closer together by, at its lower and upper
  /// end, and of the other one.
  struct Cell {
    double a, b, c, d;  ///< ends of the one angle, and of the other [rad]
    double f_ac, f_bc, f_ad, f_bd;
  };
  Cell cell(std::size_t number) const;

  const PhotometricWeb& web_;
  std::vector<double> horizontal_;  ///< of the web, or its ends where it is the same all round [deg]
  CumulativeTable cells_;           ///< h * (vertical - 1) + v
};

/// The same of equal intensity, and of a spot: unit, in the scene's frame.
Vec3 sample_direction(const PointLuminaire& luminaire, double u, double v);
Vec3 sample_direction(const SpotLuminaire& luminaire, double u, double v);
Vec3 sample_direction(const WebLuminaire& luminaire, const WebDirections& directions, double u, double v);

}  // namespace clerestory
