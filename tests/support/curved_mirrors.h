#pragma once
// Curved mirrors as facets, of which closed forms tell where they throw the sun.

#include <cmath>
#include <numbers>

#include "tests/support/room_with_blocks.h"

namespace clerestory::test {

/// A part of a cylinder of radius 1 m, 50 degrees to either side of -x and 0.5 m high, open towards +x, on a black
/// floor. The sun at 45 degrees over +x that meets it at the angle a from its middle and the height s over a plane goes
/// on in plan along (-cos 2 a, sin 2 a) by s:
///   x = -cos a + s cos 2 a,  y = sin a - s sin 2 a,   E = rho E_sun sin 45 cos a / |cos a - 2 s|
struct CylinderMirror {
  static constexpr double kEnd = 50 * std::numbers::pi / 180, kHeight = 0.5;
};
inline PatchBuilder cylinder_mirror(int facets, double reflectance) {
  PatchBuilder b(0);
  b.rectangle({-1.2, -1.2, 0}, {2.4, 0, 0}, {0, 2.4, 0});
  b.mirror(reflectance);
  const auto at = [&](int k) {
    const double a = CylinderMirror::kEnd * (2.0 * k / facets - 1);
    return Vec3{-std::cos(a), std::sin(a), 0};
  };
  for (int k = 0; k < facets; ++k) b.rectangle(at(k), at(k + 1) - at(k), {0, 0, CylinderMirror::kHeight});
  return b;
}

/// z = r^2 / (4 f) to the rim, the sun in its axis; a black disc half-way to the focus looks down. Light of r passes
/// its height at r' = r (f - h) / (f - z).
struct Paraboloid {
  static constexpr double kFocus = 0.5, kDiscHeight = 0.25, kDisc = 0.2, kRim = 0.5;
  static double passes_at(double r) { return r * (kFocus - kDiscHeight) / (kFocus - r * r / (4 * kFocus)); }
};
inline PatchBuilder paraboloid(int rings, int around, double reflectance) {
  PatchBuilder b(0);
  const auto turned = [&](int k) { return 2 * std::numbers::pi * k / around; };
  const auto on_disc = [&](int k) {
    return Vec3{Paraboloid::kDisc * std::cos(turned(k)), Paraboloid::kDisc * std::sin(turned(k)),
                Paraboloid::kDiscHeight};
  };
  for (int k = 0; k < around; ++k) b.triangle({0, 0, Paraboloid::kDiscHeight}, on_disc(k + 1), on_disc(k));
  b.mirror(reflectance);
  const auto at = [&](int ring, int k) {
    const double r = Paraboloid::kRim * ring / rings;
    return Vec3{r * std::cos(turned(k)), r * std::sin(turned(k)), r * r / (4 * Paraboloid::kFocus)};
  };
  for (int ring = 0; ring < rings; ++ring)
    for (int k = 0; k < around; ++k) {
      if (ring > 0) b.triangle(at(ring, k), at(ring + 1, k), at(ring, k + 1));
      b.triangle(at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1));
    }
  return b;
}

}  // namespace clerestory::test
