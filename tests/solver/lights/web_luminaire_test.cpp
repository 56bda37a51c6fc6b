#include "solver/lights/web_luminaire.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/light_sampler.h"
#include "solver/lights/luminaire.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "solver/spaces/lit_sides.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using Lit = test::LitPatches;
constexpr double kPi = std::numbers::pi;

/// Of type C, f(gamma, C in degrees) every 2.5 and 15 degrees. With `opening` [m].
template <class F>
std::shared_ptr<const PhotometricWeb> web_of(const F& f, const Vec3& opening = {}, double end = 90) {
  PhotometricWeb web;
  web.name = "test.ies";
  for (double v = 0; v <= end; v += 2.5) web.vertical.push_back(v);
  for (double h = 0; h <= 360; h += 15) web.horizontal.push_back(h);
  for (const double h : web.horizontal)
    for (const double v : web.vertical) web.candela.push_back(static_cast<float>(f(v, h)));
  web.opening.size = opening;
  web.flux = luminous_flux(web);
  return std::make_shared<const PhotometricWeb>(std::move(web));
}
double cosine(double v, double) { return std::max(0.0, std::cos(v * kPi / 180)); }

PlacedLuminaire lamp_at(const Vec3& position, std::shared_ptr<const PhotometricWeb> web, double scale = 1) {
  return {{"lamp", position, {}, WebLuminaire{std::move(web), {}, Spectrum(scale)}}};
}

void expect_axes(const LuminaireAxes& a, const Vec3& x, const Vec3& y, const Vec3& z) {
  EXPECT_LT(length(a.x - x), 1e-12);
  EXPECT_LT(length(a.y - y), 1e-12);
  EXPECT_LT(length(a.z - z), 1e-12);
}

TEST(Aimed, DownIsAsMeasuredAndRotationIsCounterClockwiseInPlan) {
  expect_axes(aimed(WebType::C, {0, 0, -1}, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  expect_axes(aimed(WebType::C, {0, 0, -1}, 90), {0, 1, 0}, {-1, 0, 0}, {0, 0, 1});
  expect_axes(aimed(WebType::A, {1, 0, 0}, 0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
}
TEST(Aimed, TheLuminaireTurnsTheShortestWayToItsAim) {
  // Towards +y it turns about x: C0 stays, C90 rises.
  expect_axes(aimed(WebType::C, {0, 1, 0}, 0), {1, 0, 0}, {0, 0, 1}, {0, -1, 0});
  expect_axes(aimed(WebType::B, {1, 0, 0}, 0), {0, 0, 1}, {0, 1, 0}, {-1, 0, 0});
  expect_axes(aimed(WebType::C, {0, 0, 1}, 0), {1, 0, 0}, {0, -1, 0}, {0, 0, -1});
  expect_axes(aimed(WebType::A, {0, 1, 0}, 0), {0, 1, 0}, {-1, 0, 0}, {0, 0, 1});  // a headlamp stays upright
  expect_axes(aimed(WebType::A, {-1, 0, 0}, 0), {-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
}
TEST(Aimed, AxesStayARightHandedFrameWithTheBeamAlongAim) {
  RandomStream random(5, 5);
  for (int i = 0; i < 100; ++i) {
    const Vec3 aim = sphere_direction(random.uniform(), random.uniform());
    for (const WebType type : {WebType::C, WebType::A}) {
      const LuminaireAxes a = aimed(type, aim, 360 * random.uniform());
      EXPECT_LT(length(cross(a.x, a.y) - a.z), 1e-12);
      EXPECT_LT(length((type == WebType::A ? a.x : -a.z) - aim), 1e-12);
    }
  }
}

TEST(WebLuminaire, ShinesToC0AndRotationTurnsItTowardsY) {
  // Light towards C0 only: 300 cd at gamma = 45, falling to nothing at C = 90.
  const auto web = web_of([](double, double C) { return 300 * std::max(0.0, std::cos(C * kPi / 180)); });
  Luminaire lamp = lamp_at({0, 0, 3}, web);
  const Vec3 up{0, 0, 1};
  const double exact = 300 * std::cos(kPi / 4) / 18;  // I cos / r2 at 45 degrees from 3 m
  EXPECT_NEAR(open_irradiance(lamp, {3, 0, 0}, up)[0], exact, 1e-6);
  EXPECT_EQ(open_irradiance(lamp, {-3, 0, 0}, up)[0], 0);
  std::get<WebLuminaire>(lamp.kind).axes = aimed(WebType::C, {0, 0, -1}, 90);
  EXPECT_NEAR(open_irradiance(lamp, {0, 3, 0}, up)[0], exact, 1e-6);
  EXPECT_NEAR(open_irradiance(lamp, {3, 0, 0}, up)[0], 0, 1e-6);
}

TEST(WebLuminaire, NearItsOpeningALambertianPanelIsTheAreaThatItIs) {
  // 0.6 m square of luminance 1: irradiance in the middle and off it, from contact to where it is a point.
  const double side = 0.6, z = 2;
  Lights lights;
  lights.luminaires.push_back(lamp_at({0, 0, z}, web_of(cosine, {side, side, 0}), side * side));
  PatchBuilder b(0.5);
  b.rectangle({-50, -50, -5}, {100, 0, 0}, {0, 100, 0});
  const Lit lit(b.build(), lights);
  const std::array<Vec3, 4> panel{Vec3{-0.3, -0.3, z}, {-0.3, 0.3, z}, {0.3, 0.3, z}, {0.3, -0.3, z}};
  const Vec3 up{0, 0, 1};
  for (const double x : {0.0, 0.17, 0.5}) {
    for (const double h : {3.5, 2.9, 1.5, 0.6, 0.3, 0.15, 0.08}) {
      const Vec3 p{x, 0.05, z - h};
      const double exact = kPi * point_to_polygon(p, up, panel);
      // 0.05 % from what is linear between 2.5 degrees, the rest from 4 to 256 points of the opening.
      EXPECT_NEAR(lit.sampler.delta_light(p, up, {}, 7)[0], exact, (h > 0.1 ? 0.002 : 0.005) * exact) << x << " " << h;
    }
    for (const double h : {0.05, 0.01, 1e-3, 1e-6})  // touching: dim at worst, never dazzled
      EXPECT_LT(lit.sampler.delta_light({x, 0.05, z - h}, up, {}, 7)[0], 3 * kPi) << x << " " << h;
  }
}

TEST(WebLuminaire, OneShadowRayOfAPathFindsOnAverageWhatAllRaysOfAGatherFind) {
  Lights lights;
  for (int i = 0; i < 12; ++i)
    lights.luminaires.push_back(lamp_at({i % 4 * 1.0, i / 4 * 1.2, 2.0}, web_of(cosine, {1.2, 0.2, 0}), 10.0 + i));
  std::get<WebLuminaire>(lights.luminaires[3].kind).axes = aimed(WebType::C, normalized({1, 1, -0.5}), 30);
  lights.luminaires.push_back(test::point_lamp({1, 1, 1}, 20));
  for (const bool wall : {false, true}) {
    PatchBuilder b(0.5);
    b.rectangle({-50, -50, 0}, {100, 0, 0}, {0, 100, 0});
    if (wall) b.rectangle({1.3, -1, 0.8}, {0, 4, 0}, {0, 0, 0.7});
    const Lit lit(b.build(), lights);
    RandomStream random(2, 2);
    for (const Vec3& p : {Vec3{1, 1, 0.01}, {3, 0, 1.4}, {0, 5, 0.1}}) {
      for (const Vec3& n : {Vec3{0, 0, 1}, normalized({1, -0.4, 0.2})}) {
        double sum = 0, sum2 = 0;
        constexpr int kRays = 100'000;
        for (int k = 0; k < kRays; ++k) {
          const double pick = random.uniform(), u = random.uniform(), v = random.uniform();
          const LightSample s = lit.sampler.sample(lit.sampler.receiver(p, n), pick, u, v, false);
          const double E = s.irradiance.is_black() ? 0.0 : (s.irradiance * lit.rays.transmittance(p, s.end))[0];
          sum += E, sum2 += E * E;
        }
        const double mean = sum / kRays, error = std::sqrt((sum2 / kRays - mean * mean) / kRays);
        // A penumbra is known to a sixteenth of a lamp that gives up to a third of the light.
        const double steps = wall ? 0.02 : 0.001;
        EXPECT_NEAR(lit.sampler.delta_light(p, n, {}, 7)[0], mean, 4 * error + steps * mean) << wall;
      }
    }
  }
}

/// A closed room of 5 x 4 x 2.8 m with blocks, its ceiling at the lamps' height.
struct Arrived {
  double flux = 0, emitted = 0, escaped = 0, absorbed = 0;
};
Arrived arrived(const Lights& lights) {
  const PatchSet patches = test::room_of_2160_patches().build();
  const RayScene rays(patches);
  const Problem problem{patches, rays, lights};
  const DirectLight direct = direct_light(Illumination(problem), {});
  Arrived a{0, direct.energy.emitted, direct.energy.escaped, direct.energy.absorbed};
  for (std::size_t i = 0; i < patches.patch_count(); ++i) a.flux += patches.area[i] * direct.E[i][0];
  return a;
}

TEST(WebLuminaire, ALargePanelSendsItsWholeFluxIntoTheRoom) {
  Lights lights;
  lights.luminaires.push_back(lamp_at({2.5, 2.0, 2.4}, web_of(cosine, {1.2, 1.2, 0}), 3));
  const Arrived a = arrived(lights);
  const double flux = 3 * test::as_web(lights.luminaires[0]).web->flux;
  EXPECT_NEAR(a.emitted, flux, 1e-9 * flux);
  EXPECT_NEAR(a.flux, flux, 3e-3 * flux);  // 16 rays a patch, edges 256
  EXPECT_NEAR(a.escaped + a.absorbed, 0, 1e-9);
}

TEST(WebLuminaire, FortyLampsThatShareRaysLoseNothing) {
  Lights lights;
  const auto web = web_of(
      [](double v, double C) { return cosine(v, C) * cosine(v, C) * (2 + std::cos(C * kPi / 180)); }, {0.15, 0.15, 0});
  double flux = 0;
  for (int i = 0; i < 40; ++i) {
    lights.luminaires.push_back(lamp_at({0.3 + i % 8 * 0.6, 0.4 + i / 8 * 0.8, 2.4}, web, 1 + i % 3));
    flux += (1 + i % 3) * web->flux;
  }
  const Arrived a = arrived(lights);
  EXPECT_NEAR(a.emitted, flux, 1e-9 * flux);
  EXPECT_NEAR(a.flux, flux, 3e-3 * flux);
  EXPECT_NEAR(a.escaped + a.absorbed, 0, 1e-9);
}

TEST(WebLuminaire, InTheVeryPlaneOfTheCeilingLightsTheRoomAndNotTheRoomAbove) {
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 8, 8).rectangle({0, 0, 3}, {0, 4, 0}, {4, 0, 0}, 8, 8);
  Lights lights;
  lights.luminaires.push_back(lamp_at({2, 2, 3}, web_of(cosine, {0.6, 0.6, 0}), 1));
  const Lit lit(b.build(), lights);
  EXPECT_NEAR(lit.sampler.delta_light({2, 2, lit.rays.lift()}, {0, 0, 1}, {}, 1)[0], 1 / 9.0,
              0.02 / 9);  // 0.6 m at 3 m: 1.3 % less than a point
  EXPECT_GT(lit.sampler.delta_light({3.9, 2, 2.5}, {-1, 0, 0}, {}, 1)[0], 0);
  EXPECT_EQ(lit.sampler.delta_light({2, 2, 3.5}, {0, 0, -1}, {}, 1)[0], 0);
}

}  // namespace
}  // namespace clerestory
