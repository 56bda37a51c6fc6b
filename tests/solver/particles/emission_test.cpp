#include "solver/particles/emission.h"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "solver/lights/luminaire.h"
#include "solver/lights/sun.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/many_lights.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
constexpr double kPi = std::numbers::pi;

/// Intensities that no symmetry helps with, over uneven angles.
WebLuminaire uneven_web(WebType type, bool all_round = false, bool turned = true) {
  PhotometricWeb web;
  web.type = type;
  if (type == WebType::C) {
    web.vertical = {0, 5, 20, 45, 50, 90, 120, 170};
    web.horizontal = {0, 10, 90, 100, 180, 350, 360};
  } else {
    web.vertical = {-80, -30, -10, 0, 2, 40, 90};
    web.horizontal = {-60, -50, 0, 10, 75};
  }
  if (all_round) web.horizontal = {0};
  RandomStream random(7, static_cast<std::uint64_t>(type));
  for (std::size_t k = 0; k < web.vertical.size() * web.horizontal.size(); ++k)
    web.candela.push_back(k % 5 == 2 ? 0.0f : static_cast<float>(100 * random.uniform()));
  if (!all_round && type == WebType::C)
    for (std::size_t v = 0; v < web.vertical.size(); ++v)
      web.candela[(web.horizontal.size() - 1) * web.vertical.size() + v] = web.candela[v];
  web.flux = luminous_flux(web);
  return {std::make_shared<const PhotometricWeb>(std::move(web)),
          turned ? aimed(type, normalized({1, 2, -3}), 40) : LuminaireAxes{}, Spectrum(0.01)};
}

/// Floor of 4 m by 3 m that glows or not.
PatchSet floor_of(double exitance) {
  PatchBuilder b(0.5);
  b.material(0.5, exitance).rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 4, 3);
  return b.build();
}

struct Sent {
  test::LitPatches scene;
  Illumination light;
  Emission emission;
  explicit Sent(PatchSet patches, Lights lights)
      : scene(std::move(patches), std::move(lights)), light(scene.problem), emission(light) {}
  /// Particle k, by points of a sequence.
  Emitted particle(std::uint32_t k) const { return emission.sample(sobol4(k, 3)[0], sobol4(k, 4)); }
};

Lights lamp(std::variant<PointLuminaire, SpotLuminaire, WebLuminaire> kind) {
  Lights lights;
  lights.luminaires.push_back({{"lamp", {1, 1, 2}, {}, std::move(kind)}});
  return lights;
}

class EmissionOf : public testing::TestWithParam<int> {
 protected:
  static Lights lights() {
    const auto spot = [](double inner, double outer) {
      return SpotLuminaire{normalized({1, -1, -2}), Spectrum(30), inner, outer};
    };
    switch (GetParam()) {
      case 0:
        return lamp(PointLuminaire{Spectrum(20)});
      case 1:
        return lamp(spot(0.3, 0.9));
      case 2:
        return lamp(spot(0, 0.5));
      case 3:
        return lamp(spot(0.02, 0.03));  // narrower than glTF's ramp is at least
      case 4:
        return lamp(uneven_web(WebType::C));
      case 5:
        return lamp(uneven_web(WebType::B));
      case 6:
        return lamp(uneven_web(WebType::A));
      case 7:
        return lamp(uneven_web(WebType::C, true));
      case 8:
        return lamp(uneven_web(WebType::B, true));
      default:
        return lamp(uneven_web(WebType::A, true));
    }
  }
};

TEST_P(EmissionOf, ALuminaireFollowsItsIntensity) {
  const Sent sent(floor_of(0), lights());
  const Luminaire& luminaire = sent.scene.lights.luminaires[0];
  // Cells of one solid angle around the main axis; of a narrow beam cells of its cone.
  constexpr int kRings = 30, kAround = 16, kFine = 40, kParticles = 400'000;
  const double top = GetParam() == 3 ? 1 - std::cos(0.03) : 2.0;
  const Frame frame(GetParam() == 3 ? test::as_spot(luminaire).direction : Vec3{0, 0, -1});
  std::vector<double> expected(kRings * kAround, 0.0), found(kRings * kAround, 0.0);
  const double solid_angle = top * 2 * kPi / (kRings * kAround * kFine * kFine);
  for (int i = 0; i < kRings * kFine; ++i)
    for (int j = 0; j < kAround * kFine; ++j) {
      const double s = top * (i + 0.5) / (kRings * kFine), phi = 2 * kPi * (j + 0.5) / (kAround * kFine);
      const double r = std::sqrt(s * (2 - s));
      const Vec3 d = frame.to_world(r * std::cos(phi), r * std::sin(phi), 1 - s);
      expected[static_cast<std::size_t>(i / kFine * kAround + j / kFine)] +=
          luminous_mean(intensity(luminaire, d)) * solid_angle / luminous_mean(power(luminaire)) * kParticles;
    }
  RandomStream random(11, 5);
  for (int k = 0; k < kParticles; ++k) {
    const double pick = random.uniform();
    const std::array<double, 4> u{random.uniform(), random.uniform(), random.uniform(), random.uniform()};
    const Emitted e = sent.emission.sample(pick, u);
    const Vec3& d = e.ray.direction;
    ASSERT_NEAR(length(d), 1, 1e-12);
    ASSERT_NEAR(luminous_mean(e.flux), sent.emission.flux(), 1e-9 * sent.emission.flux());
    ASSERT_NEAR(e.density_direction, sent.emission.density_of_direction(0, d), 1e-12 * e.density_direction);
    const Vec3 side = d - frame.n;
    const double s = dot(side, side) / 2, turn = std::atan2(dot(d, frame.b), dot(d, frame.t)) / (2 * kPi);
    const int ring = std::min(kRings - 1, static_cast<int>(s / top * kRings));
    const int around = std::min(kAround - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * kAround));
    ++found[static_cast<std::size_t>(ring * kAround + around)];
  }
  double chi2 = 0, cells = 0, rest_expected = 0, rest_found = 0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    if (expected[c] < 50) {
      rest_expected += expected[c], rest_found += found[c];
      continue;
    }
    chi2 += std::pow(found[c] - expected[c], 2) / expected[c];
    ++cells;
  }
  EXPECT_NEAR(rest_found, rest_expected, 5 * std::sqrt(rest_expected) + 1);
  // Chi-square has mean n and variance 2 n; the quadrature's own error adds some.
  EXPECT_LT(chi2, cells + 5 * std::sqrt(2 * cells));
}
INSTANTIATE_TEST_SUITE_P(Kinds, EmissionOf, testing::Range(0, 10));

TEST(Emission, ParticlesOfALightAreInProportionToItsFluxAndCarryTheSame) {
  PatchBuilder b(0.5);
  b.material(0.5, 2).rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 4, 3);    // 24 W
  b.material(0.2, 1).rectangle({0, 0, 2.5}, {0, 3, 0}, {4, 0, 0}, 1, 1);  // 12 W
  Lights lights = lamp(PointLuminaire{Spectrum(20)});
  for (int k = 0; k < 200; ++k) lights.luminaires.push_back(test::point_lamp({1 + 0.01 * k, 1, 2}, 0.1 * (k % 3)));
  lights.luminaires.push_back({{"web", {2, 2, 2}, {}, uneven_web(WebType::C)}});
  lights.luminaires.push_back(lights.luminaires[0]);
  lights.luminaires.back().way.count = 1;  // an image
  const Sent sent(b.build(), lights);
  double total = 36;
  for (std::size_t k = 0; k + 1 < lights.luminaires.size(); ++k) total += luminous_mean(power(lights.luminaires[k]));
  EXPECT_NEAR(sent.emission.flux(), total, 1e-12 * total);

  constexpr std::uint32_t kParticles = 1 << 16;
  std::vector<double> of_light(lights.luminaires.size(), 0.0);
  double bright = 0, dim = 0;
  for (std::uint32_t k = 0; k < kParticles; ++k) {
    const Emitted e = sent.particle(k);
    ASSERT_NEAR(luminous_mean(e.flux), total, 1e-9 * total);
    if (e.light != Emitted::kNone) {
      ++of_light[e.light];
      EXPECT_NEAR(e.density_place, sent.emission.probability_of_luminaire(e.light), 1e-15);
    } else {
      ASSERT_TRUE(e.patch.valid());
      ++(sent.scene.patches.normal[e.patch].z > 0 ? bright : dim);
      EXPECT_NEAR(e.density_place, sent.emission.density_of_patch(e.patch), 1e-15);
      EXPECT_NEAR(e.density_place, luminous_mean(sent.scene.patches.M[e.patch]) / total, 1e-12);
    }
  }
  // A Sobol' sequence of 2^16 points errs by a few of them over an interval.
  EXPECT_NEAR(bright / kParticles, 24 / total, 1e-3);
  EXPECT_NEAR(dim / kParticles, 12 / total, 1e-3);
  for (std::size_t k = 0; k + 1 < of_light.size(); ++k)
    EXPECT_NEAR(of_light[k] / kParticles, luminous_mean(power(lights.luminaires[k])) / total, 2e-4) << k;
  EXPECT_EQ(of_light.back(), 0);
  EXPECT_EQ(sent.emission.probability_of_luminaire(static_cast<std::uint32_t>(of_light.size()) - 1), 0);
}

TEST(Emission, NothingIsSentWhereNothingShines) {
  EXPECT_TRUE(Sent(floor_of(0), {}).emission.empty());
  EXPECT_EQ(Sent(floor_of(0), {}).emission.flux(), 0);
}

/// An opening somewhere over the floor: only where to look, whatever is there.
LightArea somewhere(const Vec3& corner, const Vec3& a, const Vec3& b) {
  LightArea o;
  o.corners = {corner, corner + a, corner + a + b, corner + b};
  o.triangles = {{corner, corner + a, corner + a + b}, {corner, corner + a + b, corner + b}};
  o.centre = corner + (a + b) / 2, o.normal = normalized(cross(a, b));
  o.radius = length(a + b) / 2, o.area = length(cross(a, b));
  o.brightness = 1;
  return o;
}

class SkyAndSun : public testing::TestWithParam<bool> {};

TEST_P(SkyAndSun, BringAnOpenFloorItsIrradianceWhereverOpeningsAre) {
  for (const bool with_sky : {false, true})
    for (const bool with_sun : {false, true}) {
      if (!with_sky && !with_sun) continue;
      PatchBuilder b(0.5);
      b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, 4, 3).rectangle({0, 0, -1}, {1, 0, 0}, {0, 0, 2});
      Lights lights;
      if (with_sky) lights.sky = Sky{.model = SkyModel::cie_overcast, .horizontal_irradiance = Spectrum(80, 100, 120)};
      if (with_sun) lights.suns = {{{normalized({0.3, 0.4, 0.8}), Spectrum(500)}}};
      if (GetParam())
        lights.openings = {somewhere({1, 1, 0.2}, {0, 1, 0}, {1, 0, 0}), somewhere({2, 1, 0.1}, {0, 2, 0}, {1.5, 0, 0}),
                           somewhere({1, 1, 0.5}, {0.5, 0, 0}, {0, 0, 0.3})};
      const Sent sent(b.build(), lights);
      // Of the part of the floor that the wall at y = 0 does not stand before: points at x > 2 see all of the sky but
      // little; the exact value is by shadow rays, of another estimator.
      const Problem& problem = sent.scene.problem;
      double landed = 0, squares = 0, all = 0;
      constexpr std::uint32_t kParticles = 200'000;
      for (std::uint32_t k = 0; k < kParticles; ++k) {
        const Emitted e = sent.particle(k);
        all += luminous_mean(e.flux) / kParticles;
        if (e.flux.is_black()) continue;
        const double density = e.light == Emitted::kNone
                                   ? sent.emission.density_of_sky(e.ray.origin, e.ray.direction)
                                   : sent.emission.density_of_sun(e.light, e.ray.origin, e.ray.direction);
        ASSERT_NEAR(e.density_place * e.density_direction, density, 1e-6 * density);
        const Hit hit = problem.rays.first_hit(problem.patches, e.ray);
        if (!hit.patch.valid() || hit.position(e.ray).y < 0.5 || problem.patches.normal[hit.patch].z < 0.5) continue;
        const double w = luminous_mean(e.flux);
        landed += w / kParticles, squares += w * w / kParticles;
      }
      EXPECT_NEAR(all, sent.emission.flux(), 0.01 * sent.emission.flux());
      // The same from the floor: rays to the sky and the sun from points all over it.
      RandomStream random(5, 6);
      double E = 0;
      constexpr int kRays = 100'000;
      for (int k = 0; k < kRays; ++k) {
        const Vec3 p{4 * random.uniform(), 0.5 + 2.5 * random.uniform(), 1e-5};
        const Vec3 d = cosine_direction(Frame({0, 0, 1}), random.uniform(), random.uniform());
        if (with_sky && problem.rays.visible(p, p + d * 50)) E += kPi * luminous_mean(sent.light.sky(d)) / kRays;
        if (!with_sun) continue;
        const Vec3 to_sun = direction_to_sun(lights.suns[0], random.uniform(), random.uniform());
        if (problem.rays.visible(p, p + to_sun * 50)) E += 500 * to_sun.z / kRays;
      }
      const double expected = E * 4 * 2.5, std_error = std::sqrt((squares - landed * landed) / kParticles);
      EXPECT_NEAR(landed, expected, 4 * std_error + 0.004 * expected) << with_sky << with_sun;
      EXPECT_LT(std_error, 0.01 * expected);
    }
}
INSTANTIATE_TEST_SUITE_P(WithAndWithoutOpenings, SkyAndSun, testing::Bool());

TEST(Emission, MostParticlesOfTheSkyEnterARoomByItsOpenings) {
  // A hall whose only opening is a hundredth of what the sky shines on.
  PatchBuilder b(0.5);
  b.box({10, 10, 2}, {10, 0, 0}, {0, 10, 0}, {0, 0, 4}, {4, 4, 2}, false);
  Lights lights;
  lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(100)};
  lights.openings = {somewhere({14, 14, 4}, {0, 1, 0}, {1, 0, 0})};
  const Sent sent(b.build(), lights);
  int through = 0;
  constexpr std::uint32_t kParticles = 10'000;
  for (std::uint32_t k = 0; k < kParticles; ++k) {
    const Emitted e = sent.particle(k);
    if (!e.flux.is_black() && way_out(lights.openings[0], e.ray.origin + e.ray.direction * 50, -e.ray.direction) >= 0)
      ++through;
  }
  EXPECT_GT(through, kParticles * 0.7);
}

}  // namespace
}  // namespace clerestory
