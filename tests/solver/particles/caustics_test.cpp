// Caustics of curved mirrors in the sun against closed forms: the mirrors stand as facets, the light as particles.

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/particles/photon_map.h"
#include "tests/support/curved_mirrors.h"
#include "tests/support/lit_patches.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/send_photons.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi, kSunlight = 500, kReflectance = 0.9;
constexpr std::array kCaustic{ParticleWay::turned};

/// What mirrors send on, from a sun in that direction.
std::vector<Landing> caustic(PatchSet patches, const Vec3& to_sun, std::size_t particles) {
  Lights lights;
  lights.suns = {{{normalized(to_sun), Spectrum(kSunlight)}}};
  const test::LitPatches scene(std::move(patches), std::move(lights));
  return test::send_photons(Illumination(scene.problem), particles, kCaustic, 1);
}

double flux_of(const std::vector<Landing>& landings) {
  double sum = 0;
  for (const Landing& l : landings) sum += double{l.flux[0]};
  return sum;
}

TEST(Caustic, OfACylinderIsTheNephroidOfTheClosedForm) {
  constexpr double kEnd = test::CylinderMirror::kEnd, kHeight = test::CylinderMirror::kHeight;
  const std::vector<Landing> landings = caustic(test::cylinder_mirror(400, kReflectance).build(), {1, 0, 1}, 3'000'000);
  const double per_angle = kReflectance * kSunlight * std::sin(kPi / 4);
  const double all = per_angle * 2 * std::sin(kEnd) * kHeight;
  EXPECT_NEAR(flux_of(landings), all, 0.003 * all);  // 300,000 particles of strata

  // Flux by squares of 0.05 m; those that the edge of the light or the bright line crosses are left out: there the
  // sun's diameter counts.
  constexpr int kSquares = 24, kGrid = 2000;
  constexpr double kSide = 0.05;
  const auto square = [](double x, double y) {
    const int i = static_cast<int>((x + 1.1) / kSide), j = static_cast<int>((y + 0.6) / kSide);
    return i >= 0 && i < kSquares && j >= 0 && j < kSquares ? i * kSquares + j : -1;
  };
  std::vector<double> expected(kSquares * kSquares, 0.0), found(expected.size(), 0.0);
  std::vector<bool> is_smooth(expected.size(), true);
  for (int i = 0; i < kGrid; ++i)
    for (int j = 0; j < kGrid; ++j) {
      const double a = -kEnd + 2 * kEnd * (i + 0.5) / kGrid, s = kHeight * (j + 0.5) / kGrid;
      const int k = square(-std::cos(a) + s * std::cos(2 * a), std::sin(a) - s * std::sin(2 * a));
      if (k < 0) continue;
      expected[static_cast<std::size_t>(k)] += per_angle * std::cos(a) * 2 * kEnd / kGrid * kHeight / kGrid;
      const bool at_edge = std::min({i, j, kGrid - 1 - i, kGrid - 1 - j}) < 10;
      if (at_edge || std::abs(std::cos(a) - 2 * s) < 0.1) is_smooth[static_cast<std::size_t>(k)] = false;
    }
  for (const Landing& l : landings)
    if (const int k = square(double{l.position[0]}, double{l.position[1]}); k >= 0)
      found[static_cast<std::size_t>(k)] += double{l.flux[0]};
  int count = 0;
  const double of_particle = double{landings.front().flux[0]};
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (!is_smooth[k] || !(expected[k] > 0)) continue;
    EXPECT_NEAR(found[k], expected[k], 0.02 * expected[k] + 4 * std::sqrt(of_particle * expected[k])) << k;
    ++count;
  }
  EXPECT_GT(count, 50);
}

TEST(Caustic, OfAParaboloidGoesToItsFocus) {
  // All that passes within the rim of the disc is what of r lies between its shadow and where r' is its radius.
  constexpr double kF = test::Paraboloid::kFocus, kH = test::Paraboloid::kDiscHeight, kDisc = test::Paraboloid::kDisc;
  const std::vector<Landing> landings = caustic(test::paraboloid(50, 120, kReflectance).build(), {0, 0, 1}, 2'000'000);

  const auto& passes_at = test::Paraboloid::passes_at;
  // r of r': r^2 (r' / 4 f) + r (f - h) - r' f = 0
  const auto comes_from = [&](double passed) {
    const double a = passed / (4 * kF), c = kF - kH;
    return (-c + std::sqrt(c * c + 4 * a * passed * kF)) / (2 * a);
  };
  ASSERT_NEAR(passes_at(comes_from(0.15)), 0.15, 1e-12);
  const double sun = kReflectance * kSunlight * kPi;
  const auto expected = [&](double r0, double r1) {  // between two radii of the disc
    const double from = std::max(kDisc, comes_from(r0)), to = comes_from(r1);
    return to > from ? sun * (to * to - from * from) : 0.0;
  };
  const auto found = [&](double r0, double r1) {
    double sum = 0;
    for (const Landing& l : landings) {
      const double r = std::hypot(double{l.position[0]}, double{l.position[1]});
      if (r >= r0 && r < r1) sum += double{l.flux[0]};
    }
    return sum;
  };
  // The shadow of the disc ends at r' = 0.105 m: rings outside of it. Chords of 26 mm turn light by up to 0.013 rad,
  // which is 3 mm here.
  EXPECT_NEAR(found(0, 0.095), 0, 0.001 * sun);
  for (const double r : {0.12, 0.14, 0.16})
    EXPECT_NEAR(found(r, r + 0.02), expected(r, r + 0.02), 0.02 * expected(r, r + 0.02)) << r;
  EXPECT_NEAR(flux_of(landings), expected(0, kDisc), 0.01 * expected(0, kDisc));
}

}  // namespace
}  // namespace clerestory
