#include <numbers>

#include <gtest/gtest.h>

#include "solver/illumination/direct.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/sky.h"
#include "solver/lights/sun.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

Lights with_sky(SkyModel model, double horizontal, double ground = 0) {
  Lights lights;
  lights.sky = Sky{model, Spectrum(horizontal), ground};
  return lights;
}

/// Irradiance of a plane of normal n under the sky, by stratified directions.
double irradiance(const SkyRadiance& sky, const Vec3& n) {
  double sum = 0;
  constexpr std::uint32_t kRays = 1 << 16;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, 1);
    sum += sky(cosine_direction(Frame(n), u[0], u[1]))[0];
  }
  return kPi * sum / kRays;
}

TEST(SkyRadiance, GivesTheHorizontalIrradianceItIsScaledTo) {
  EXPECT_NEAR(irradiance(SkyRadiance(with_sky(SkyModel::uniform, 100)), {0, 0, 1}), 100, 1e-3);
  EXPECT_NEAR(irradiance(SkyRadiance(with_sky(SkyModel::cie_overcast, 100)), {0, 0, 1}), 100, 1e-3);
}

TEST(SkyRadiance, OfAnOvercastSkyLightsAFacadeByTheClosedForm) {
  // (pi/6 + 4/9) / (7 pi/9) of the horizontal irradiance; the uniform sky gives one half.
  EXPECT_NEAR(irradiance(SkyRadiance(with_sky(SkyModel::cie_overcast, 1)), {0, -1, 0}), 0.3961770778, 1e-4);
  EXPECT_NEAR(irradiance(SkyRadiance(with_sky(SkyModel::uniform, 1)), {1, 0, 0}), 0.5, 1e-4);
}

TEST(SkyRadiance, BelowTheHorizonIsTheGroundLitBySkyAndSun) {
  Lights lights = with_sky(SkyModel::uniform, 50, 0.2);
  lights.suns.push_back({{normalized({0, -1, 1}), Spectrum(200)}});
  EXPECT_NEAR(SkyRadiance(lights)(normalized({1, 0, -0.1}))[0], 0.2 / kPi * (50 + 200 / std::sqrt(2.0)), 1e-9);
}

TEST(Sun, IsADiscOfHalfADegreeAroundItsDirection) {
  const Sun sun{normalized({0.3, -0.5, 0.8}), Spectrum(1)};
  double widest = 0;
  Vec3 mean;
  for (std::uint32_t k = 0; k < 4096; ++k) {
    const auto u = sobol4(k, 2);
    const Vec3 d = direction_to_sun(sun, u[0], u[1]);
    EXPECT_NEAR(length(d), 1, 1e-12);
    widest = std::max(widest, std::asin(length(cross(d, sun.direction))) * 180 / kPi);
    mean += d / 4096;
  }
  EXPECT_NEAR(widest, kSunDiameterDeg / 2, 1e-3);
  EXPECT_NEAR(length(cross(mean, sun.direction)), 0, 1e-6);
}

TEST(PointLights, FluxIsTheIntegralOfTheIntensity) {
  const Luminaire spot = test::spot_lamp({}, normalized({1, 2, -1}), 30, 0.3, 0.7);
  const Luminaire point = test::point_lamp({}, 100);
  double spot_sum = 0, point_sum = 0;
  constexpr std::uint32_t kRays = 1 << 16;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, 3);
    const Vec3 d = sphere_direction(u[0], u[1]);
    spot_sum += intensity(spot, d)[0];
    point_sum += intensity(point, d)[0];
  }
  EXPECT_NEAR(4 * kPi * spot_sum / kRays, power(spot)[0], 1e-3 * power(spot)[0]);
  EXPECT_NEAR(4 * kPi * point_sum / kRays, 100, 1e-9);
}

TEST(PointLights, IrradianceFallsWithTheSquareOfTheDistanceAndTheCosine) {
  const Luminaire lamp = test::point_lamp({0, 0, 3}, 4 * kPi * 1000);  // 1000 W/sr
  EXPECT_NEAR(open_irradiance(lamp, {0, 0, 0}, {0, 0, 1})[0], 1000.0 / 9, 1e-9);
  EXPECT_NEAR(open_irradiance(lamp, {4, 0, 0}, {0, 0, 1})[0], 1000.0 / 25 * 0.6, 1e-9);
  EXPECT_EQ(open_irradiance(lamp, {0, 0, 4}, {0, 0, 1})[0], 0);
}

TEST(DirectLight, OfALampInAClosedRoomIsItsWholeFlux) {
  const PatchSet patches = test::room_of_2160_patches().build();
  const RayScene rays(patches);
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({2.5, 2.0, 2.4}, 70));
  const Problem problem{patches, rays, lights};
  const DirectLight direct = direct_light(Illumination(problem), {.shadow_rays = 64});
  double arrived = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) arrived += patches.area[i] * direct.E[i][0];
  EXPECT_NEAR(arrived, 70, 70 * 1e-3);  // 64 stratified points on each of 2,160 patches
  EXPECT_NEAR(direct.energy.emitted, 70, 1e-9);
  EXPECT_NEAR(direct.energy.escaped, 0, 1e-9);
}

TEST(DirectLight, OfTheSunIsItsNormalIlluminanceTimesTheCosineWhereNothingShades) {
  test::PatchBuilder b;
  b.rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 40, 40).rectangle({4, 4, 2}, {2, 0, 0}, {0, 2, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights;
  lights.suns.push_back({{{0, 0, 1}, Spectrum(800)}});
  const Problem problem{patches, rays, lights};
  const DirectLight direct = direct_light(Illumination(problem), {.shadow_rays = 64});
  double on_floor = 0;
  for (std::size_t i = 0; i < 3200; ++i) on_floor += patches.area[i] * direct.E[i][0];
  EXPECT_NEAR(direct.E[0][0], 800, 800 * 2e-5);  // the rim of the disc stands 0.27 degrees off
  // The roof of 2 x 2 m takes its own area of light, whatever the disc does to the edge of its shadow.
  EXPECT_NEAR(on_floor, 800 * (100 - 4), 800 * 4 * 0.01);
}

TEST(DirectLight, OfTheSunThroughASmallHoleLosesNothingOnCoarsePatches) {
  // The spot of 0.3 x 0.3 m covers 3 % of a floor patch: most first looks miss it, and must not count as dark for that.
  test::PatchBuilder b;
  b.rectangle({0, 0, 0}, {10, 0, 0}, {0, 10, 0}, 4, 4);
  b.rectangle({0, 0, 0.2}, {10, 0, 0}, {0, 4, 0}).rectangle({0, 4.3, 0.2}, {10, 0, 0}, {0, 5.7, 0});
  b.rectangle({0, 4, 0.2}, {4, 0, 0}, {0, 0.3, 0}).rectangle({4.3, 4, 0.2}, {5.7, 0, 0}, {0, 0.3, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights;
  lights.suns.push_back({{{0, 0, 1}, Spectrum(800)}});
  const Problem problem{patches, rays, lights};
  const Illumination light(problem);
  double sum = 0, sum_of_squares = 0;
  constexpr int kSeeds = 2000;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const DirectLight direct = direct_light(light, {.seed = static_cast<std::uint64_t>(seed)});
    double on_floor = 0;
    for (std::size_t i = 0; i < 32; ++i) on_floor += patches.area[i] * direct.E[i][0];
    sum += on_floor / kSeeds, sum_of_squares += on_floor * on_floor / kSeeds;
  }
  const double std_error = std::sqrt((sum_of_squares - sum * sum) / (kSeeds - 1));
  EXPECT_NEAR(sum, 800 * 0.3 * 0.3, 4 * std_error);
}

}  // namespace
}  // namespace clerestory
