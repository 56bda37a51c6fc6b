// The mean of the light of several times, and what of it is of which.

#include "solver/lights/layers_of_times.h"

#include <numbers>

#include <gtest/gtest.h>

#include "solver/model/light_of_times.h"
#include "solver/model/perez.h"
#include "solver/model/solar_position.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

/// Perez' sky and a sun at an elevation; from 0 down both are dark.
LightSpec day(double elevation_deg, double azimuth_deg) {
  LightSpec light;
  const Vec3 sun = scene_direction({elevation_deg, azimuth_deg});
  const bool up = elevation_deg > 0;
  light.sky = Sky{.model = SkyModel::perez,
                  .horizontal_irradiance = Spectrum(up ? 50 + elevation_deg : 0),
                  .ground_reflectance = 0.3,
                  .shape = perez_shape({.direct_normal = up ? 500.0 : 0.0,
                                        .diffuse_horizontal = up ? 120.0 : 0.0,
                                        .zenith_angle = (90 - elevation_deg) * kPi / 180,
                                        .day_of_year = {}}),
                  .sun = sun};
  if (up) light.suns.push_back({sun, Spectrum(10 * elevation_deg)});
  return light;
}
const std::vector<LightSpec> kDay = {day(-5, 80), day(12, 110), day(40, 180), day(25, 250)};

Lights placed(const LightSpec& spec) {
  Lights lights;
  for (const Luminaire& luminaire : spec.luminaires) lights.luminaires.push_back({luminaire});
  lights.sky = spec.sky;
  for (const Sun& sun : spec.suns) lights.suns.push_back({sun});
  lights.times = spec.times;
  return lights;
}

const std::vector<Vec3> kDirections = {{0, 0, 1},
                                       normalized(Vec3{0.2, -0.9, 0.3}),
                                       normalized(Vec3{-0.5, 0.5, 0.1}),
                                       normalized(Vec3{0.4, 0.4, -0.5}),
                                       scene_direction({40, 180})};

TEST(LightOfTimes, TheMeanOfSkiesIsThatOfTheirRadiancesGroundIncluded) {
  const SkyRadiance mean(placed(mean_over_times({}, kDay)));
  for (const Vec3& d : kDirections) {
    double expected = 0;
    for (const LightSpec& time : kDay) expected += SkyRadiance(placed(time))(d)[0] / 4;
    EXPECT_NEAR(mean(d)[0], expected, 1e-12 * expected) << d.x << " " << d.y << " " << d.z;  // rounding
  }
}

TEST(LightOfTimes, SkiesThatAreAllTheSameAreOne) {
  LightSpec time;
  time.sky = Sky{.model = SkyModel::cie_overcast, .horizontal_irradiance = Spectrum(50)};
  const LightSpec mean = mean_over_times({}, std::vector<LightSpec>(3, time));
  ASSERT_TRUE(mean.sky);
  EXPECT_EQ(mean.sky->model, SkyModel::cie_overcast);
  EXPECT_EQ(mean.sky->horizontal_irradiance, Spectrum(50));
  EXPECT_EQ(light_at(mean, 2).sky->horizontal_irradiance, Spectrum(50));
}

TEST(LightOfTimes, EachTimeHasItsOwnSunAndSkyAndWhatShinesAlways) {
  LightSpec always;
  always.suns.push_back({{0, 0, 1}, Spectrum(7)});
  const LightSpec mean = mean_over_times(always, kDay);
  EXPECT_EQ(mean.times, 4u);
  ASSERT_EQ(mean.suns.size(), 4u);
  const LightSpec night = light_at(mean, 0), noon = light_at(mean, 2);
  ASSERT_EQ(night.suns.size(), 1u);
  EXPECT_EQ(night.suns[0].normal_irradiance, Spectrum(7));
  EXPECT_TRUE(night.sky->horizontal_irradiance.is_black());
  ASSERT_EQ(noon.suns.size(), 2u);
  EXPECT_EQ(noon.suns[1].direction, kDay[2].suns[0].direction);
  EXPECT_DOUBLE_EQ(noon.suns[1].normal_irradiance[0], 400);
  EXPECT_EQ(noon.times, 1u);
}

TEST(LayersOfTimes, SumToTheMeanAndAreAShareOfTheirTime) {
  LightSpec always;
  always.luminaires.push_back({"lamp", {}, "", PointLuminaire{Spectrum(3)}});
  always.suns.push_back({{0, 0, 1}, Spectrum(7)});
  Lights mean = placed(mean_over_times(always, kDay));
  const std::size_t sun_at_noon = 2;  // the one that shines always, 12 degrees, 40 degrees
  ASSERT_EQ(mean.suns[sun_at_noon].time, 2u);
  mean.suns.push_back(mean.suns[sun_at_noon]);  // its image
  mean.suns.back().way = MirrorWay{}.over(0);
  PatchSet patches;
  patches.materials.resize(2);
  const std::vector<Layer> layers = layers_of_times(mean, patches);
  ASSERT_EQ(layers.size(), 4u);
  for (std::size_t k = 0; k < 1 + mean.suns.size(); ++k) {
    double sum = 0;
    for (const Layer& layer : layers) sum += layer.lights[k][0];
    EXPECT_DOUBLE_EQ(sum, 1) << k;
  }
  EXPECT_EQ(layers[2].lights.back(), Spectrum(1));  // images go with the sun that they show
  EXPECT_EQ(layers[1].lights.back(), Spectrum(0));
  EXPECT_EQ(layers[0].of_material(MaterialId{1}), Spectrum(0.25));
  const SkyRadiance joint(mean);
  for (const Vec3& d : kDirections) {
    double sum = 0;
    for (std::size_t t = 0; t < layers.size(); ++t) {
      const double own = (*layers[t].sky)(d)[0], whole = SkyRadiance(lights_at(mean, t))(d)[0];
      EXPECT_NEAR(own, whole / 4, 1e-12 * whole);
      sum += own;
    }
    EXPECT_NEAR(sum, joint(d)[0], 1e-12 * sum);
  }
}

TEST(LayersOfTimes, AnImageCountsAsAllSkiesDo) {
  LightSpec time;
  SkyImage image;
  image.width = 4, image.height = 2;
  image.value.assign(24, 2.0F);
  time.sky = Sky{.model = SkyModel::image,
                 .horizontal_irradiance = Spectrum(2 * kPi),
                 .image = std::make_shared<const SkyImage>(image)};
  const std::vector<Layer> layers = layers_of_times(placed(mean_over_times({}, std::vector<LightSpec>(2, time))), {});
  EXPECT_NEAR((*layers[1].sky)({0, 0, 1})[0], 1, 1e-6);
}

}  // namespace
}  // namespace clerestory
