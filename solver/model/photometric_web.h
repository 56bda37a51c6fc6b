#pragma once
// Luminous intensity of a luminaire as a photometric file gives it.

#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// How a goniophotometer counts its angles, V (vertical) and H (horizontal), both in degrees; a unit direction d in the
/// luminaire's own frame, x along the photometric horizontal (C0), z up when it hangs as it was measured:
///   C  V from straight down, H counter-clockwise seen from above:  d = (sin V cos H, sin V sin H, -cos V)
///   B  V from down towards x, H to the right out of that plane:    d = (cos H sin V, -sin H, -cos H cos V)
///   A  V up from the horizontal, H clockwise seen from above:      d = (cos V cos H, -cos V sin H, sin V)
/// Source: ANSI/IESNA LM-63-2002, definitions; EN 13032-1 for C.
enum class WebType { C, B, A };

/// Which part of the angles the file gives; the rest is mirrored.
enum class WebSymmetry { none, rotational, about_0_180, about_90_270, quadrants };

/// Where light comes out: a box or an ellipse of these lengths around the photometric centre; 0: without extent.
struct LuminousOpening {
  Vec3 size;           ///< along the luminaire's x (C0), y (C90) and z [m], >= 0
  bool round = false;  ///< an ellipse seen from below, and not a rectangle
};

/// Intensity by angles, linear between them in both, and nothing outside.
struct PhotometricWeb {
  std::string name;  ///< of the file, without folder
  WebType type = WebType::C;
  WebSymmetry symmetry = WebSymmetry::none;  ///< of the file; the angles below are complete
  std::vector<double> vertical;              ///< n, ascending [deg]
  std::vector<double> horizontal;            ///< m, ascending [deg]; one value: the same all round; C: 0 to 360
  std::vector<float> candela;                ///< m x n: [h * n + v], multiplier and ballast factors applied [cd]
  LuminousOpening opening;

  double flux = 0;       ///< luminous_flux() of this [lm]
  double lamp_flux = 0;  ///< of the bare lamps [lm]; 0: the file gives absolute intensities and says nothing of lamps
  double declared_flux = 0;  ///< of the luminaire, lamp flux x light output ratio [lm]; 0: not said

  /// How the lamp's light depends on the angle by which the luminaire is tilted out of its upright position: factors
  /// at ascending angles; empty when it does not (TILT=NONE).
  std::vector<double> tilt_deg, tilt_factor;
};

/// Direction in the luminaire's frame that `aim` means: gamma = 0 of type C, V = H = 0 of types A and B.
Vec3 beam_axis(WebType type);

/// A luminaire's own axes in the scene, unit and at right angles; as they are here it hangs as it was measured.
struct LuminaireAxes {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};

/// Axes of a luminaire whose beam axis points along `aim`: turned there from upright on the shortest way (from down to
/// up: about x; for type A from ahead to behind: about z), then about aim by rotation_deg, counter-clockwise for who
/// looks along aim from behind the luminaire, so for aim down: counter-clockwise in plan, C0 from +x towards +y.
LuminaireAxes aimed(WebType type, const Vec3& aim, double rotation_deg);

/// Intensity towards the unit direction d of the luminaire's frame [cd].
double candela_towards(const PhotometricWeb& web, const Vec3& d);
/// Largest intensity [cd].
double peak_candela(const PhotometricWeb& web);

/// Flux [lm]: the exact integral of the intensity, linear between the angles, over the sphere.
double luminous_flux(const PhotometricWeb& web);

/// Integrals over [a, b] [rad] of (1 - t) w(x) and t w(x), t = (x - a) / (b - a), w = sine or cosine of x: of intensity
/// that is linear between two angles.
struct AngleWeights {
  double low, high;
};
AngleWeights angle_weights(double a, double b, bool sine);

/// Factor on the light when the luminaire is tilted out of its upright position.
double tilt_factor(const PhotometricWeb& web, double tilt_deg);

}  // namespace clerestory
