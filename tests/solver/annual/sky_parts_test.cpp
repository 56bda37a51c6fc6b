// Parts of the sky against closed forms, and against the sky itself.

#include "solver/annual/sky_parts.h"

#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "solver/lights/sky.h"
#include "solver/model/solar_position.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

class SkyPartsOf : public testing::TestWithParam<std::size_t> {
 protected:
  SkyParts parts{GetParam()};
};

TEST_P(SkyPartsOf, CountsAreTregenzasAndReinharts) {
  EXPECT_EQ(parts.count(), GetParam());
  EXPECT_EQ(parts.ground(), GetParam());
}

TEST_P(SkyPartsOf, APlaneSeesPiOfThemAndGround) {
  double sum = 0;
  for (std::size_t k = 0; k < parts.count(); ++k) sum += parts.on_horizontal(k);
  EXPECT_NEAR(sum, kPi, 1e-12);
  for (const double tilt_deg : {0.0, 30.0, 90.0, 150.0, 180.0}) {
    const double t = tilt_deg * kPi / 180;
    const std::vector<float> seen = parts.on_plane({std::sin(t), 0, std::cos(t)});
    ASSERT_EQ(seen.size(), parts.count() + 1);
    const double sky = std::accumulate(seen.begin(), seen.end() - 1, 0.0);
    EXPECT_NEAR(sky, kPi * (1 + std::cos(t)) / 2, 1e-5) << tilt_deg;  // sums of floats
    EXPECT_NEAR(sky + seen.back(), kPi, 1e-5) << tilt_deg;
  }
  const std::vector<float> level = parts.on_plane({0, 0, 1});
  for (std::size_t k = 0; k < parts.count(); ++k) EXPECT_NEAR(level[k], parts.on_horizontal(k), 1e-6) << k;
}

TEST_P(SkyPartsOf, APartHoldsItsMiddleAndNothingBelowTheHorizon) {
  for (std::size_t k = 0; k < parts.count(); ++k) EXPECT_EQ(parts.part_of(parts.middle(k)), k);
  EXPECT_EQ(parts.part_of({0, 0, 1}), parts.count() - 1) << "the cap";
  EXPECT_EQ(parts.part_of({0, 1, 0}), 0u);
  EXPECT_EQ(parts.part_of(normalized(Vec3{0.3, 0.2, -1e-9})), parts.ground());
  EXPECT_EQ(parts.part_of({0, 0, -1}), parts.ground());
}

TEST_P(SkyPartsOf, LookingAtASkyKeepsItsHorizontalIrradianceAndItsRadiance) {
  // Perez' sky of a clear hour, sun at 40 degrees: steep around the sun, so parts near it are left out of the second.
  const SkyShape shape{.a = -0.6, .b = -0.3, .k = 1, .c = 12, .d = -3.5, .e = 0.4};
  const Vec3 sun = scene_direction({40, 150});
  std::vector<float> radiance(parts.count());
  parts.look_at(shape, sun, 120, radiance);
  double sum = 0;
  for (std::size_t k = 0; k < parts.count(); ++k) sum += radiance[k] * parts.on_horizontal(k);
  EXPECT_NEAR(sum, 120, 120 * 1e-5);

  Lights lights;
  lights.sky = Sky{.model = SkyModel::cie_general,
                   .horizontal_irradiance = Spectrum(120),
                   .ground_reflectance = 0,
                   .shape = shape,
                   .sun = sun};
  const SkyRadiance sky(lights);
  // The mean of a part differs from its middle by a second-order term: parts of 12 degrees, 6 or 3.
  const double bound = GetParam() == 145 ? 0.08 : GetParam() == 577 ? 0.025 : 0.015;
  for (std::size_t k = 0; k < parts.count(); ++k) {
    const Vec3 d = parts.middle(k);
    if (dot(d, sun) > std::cos(25 * kPi / 180) || d.z < 0.2) continue;
    EXPECT_NEAR(radiance[k], sky(d)[0], bound * sky(d)[0]) << k;
  }
}

TEST_P(SkyPartsOf, AUniformSkyIsEven) {
  std::vector<float> radiance(parts.count());
  parts.look_at({}, {0, 0, 1}, 10, radiance);
  for (const float L : radiance) EXPECT_NEAR(L, 10 / kPi, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(All, SkyPartsOf, testing::ValuesIn(kSkyPartCounts));

}  // namespace
}  // namespace clerestory
