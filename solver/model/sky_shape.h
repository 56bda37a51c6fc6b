#pragma once
// How the luminance of a sky is spread over its directions, up to a factor.

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {

/// Relative luminance at zenith angle Z, at the angle chi from the sun:
///   L ~ phi(Z) f(chi),   phi(Z) = 1 + a exp(b / cos Z),   f(chi) = k + c exp(d chi) + e cos^2 chi
/// b < 0, so that the horizon stays finite: phi = 1 there.
/// Source: ISO 15469:2004 (k = 1 - c exp(d pi/2)); Perez, Seals & Michalsky 1993 (k = 1).
struct SkyShape {
  double a = 0, b = -1;                ///< gradation from zenith to horizon
  double k = 1, c = 0, d = -1, e = 0;  ///< indicatrix: brightness around the sun

  bool needs_sun() const { return c != 0 || e != 0; }
  /// Neither factor falls below 0, as Perez' may for coefficients at the rim of their range.
  double gradation(double cos_Z) const {
    return std::max(0.0, 1 + (a == 0 ? 0 : a * std::exp(b / std::max(cos_Z, 1e-9))));
  }
  double indicatrix(double chi, double cos_chi) const {
    return std::max(0.0, k + c * std::exp(d * chi) + e * cos_chi * cos_chi);
  }
};

/// CIE general sky `type`, 1 to 15. Source: ISO 15469:2004, CIE S 011, table 1.
SkyShape cie_general_shape(int type);

/// CIE clear sky of 1973 (Kittler), (0.91 + 10 exp(-3 chi) + 0.45 cos^2 chi)(1 - exp(-0.32 / cos Z)).
/// The general type 12 differs from it by less than 0.05 %.
SkyShape cie_clear_shape();

}  // namespace clerestory
