#include "solver/evaluate/sensor_planes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

SensorSet one(SensorKind kind, const Vec3& normal) { return {"one", {{{1, 2, 3}, normal}}, kind}; }

/// What the planes of one cylinder get, in the mean, from a beam of 1 W/m2 that comes from the unit direction d.
double mean_of_beam(const SensorPlanes& cylinder, const Vec3& d) {
  Field E(cylinder.planes.size(), 1);
  for (std::size_t i = 0; i < E.size(); ++i) E.at(i, 0) = std::max(0.0, dot(cylinder.planes[i].normal, d));
  return mean_over_planes(cylinder, E).at(0, 0);
}

TEST(SensorPlanes, OfACylinderGiveABeamItsSineOverPiFromAnySide) {
  // Exact: 1/pi sin(theta). N planes err by up to 1 - x / tan(x), x = pi / (2 N), and somewhere by nearly as much.
  const double bound = 1 - kPi / 42 / std::tan(kPi / 42);
  for (const Vec3& axis : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0.6, 0, 0.8}}) {
    const SensorSet set = one(SensorKind::cylindrical, axis);
    const SensorPlanes cylinder = planes_of({&set, 1});
    ASSERT_EQ(cylinder.planes.size(), 21u);
    const Frame frame(axis);
    double worst = 0;
    for (const double theta : {0.2, 1.0, kPi / 2, 2.5})
      for (int k = 0; k < 360; ++k) {
        const double phi = k * kPi / 180, exact = std::sin(theta) / kPi;
        const Vec3 d =
            frame.to_world(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        worst = std::max(worst, std::abs(mean_of_beam(cylinder, d) / exact - 1));
      }
    EXPECT_LE(worst, bound * (1 + 1e-9));
    EXPECT_GT(worst, 0.8 * bound);
  }
}

TEST(SensorPlanes, OfACylinderStandAlongItsAxisAtItsPlace) {
  const Vec3 axis{0.6, 0, 0.8};
  const SensorSet set = one(SensorKind::cylindrical, axis);
  for (const SensorPoint& plane : planes_of({&set, 1}).planes) {
    EXPECT_EQ(plane.position, (Vec3{1, 2, 3}));
    EXPECT_NEAR(dot(plane.normal, axis), 0, 1e-15);
    EXPECT_NEAR(length(plane.normal), 1, 1e-15);
  }
}

TEST(SensorPlanes, AreMeanedSensorBySensorInEachChannel) {
  SensorSet plane = one(SensorKind::planar, {0, 0, 1}), cylinder = one(SensorKind::cylindrical, {0, 0, 1});
  const SensorSet sets[] = {plane, cylinder, plane};
  const SensorPlanes sensors = planes_of(sets);
  ASSERT_EQ(sensors.sensor_count(), 3u);
  ASSERT_EQ(sensors.planes.size(), 23u);
  EXPECT_EQ(sensors.planes[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(sensors.planes[22].normal, (Vec3{0, 0, 1}));
  Field E(23, 3);
  for (std::size_t i = 0; i < 23; ++i) E.set(i, {double(i), 10.0 * double(i), 5});
  const Field mean = mean_over_planes(sensors, E);
  ASSERT_EQ(mean.size(), 3u);
  EXPECT_EQ(mean[0], Spectrum(0, 0, 5));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean.at(1, k), Spectrum(11, 110, 5)[k], 1e-12);  // the mean of 1 to 21
  EXPECT_EQ(mean[2], Spectrum(22, 220, 5));
}

TEST(SensorPlanes, LeadBackToTheSensorsThatHaveMostOfThem) {
  const SensorSet sets[] = {one(SensorKind::planar, {0, 0, 1}), one(SensorKind::cylindrical, {0, 0, 1}),
                            one(SensorKind::planar, {0, 0, 1})};
  const SensorPlanes sensors = planes_of(sets);
  EXPECT_EQ(sensors_of(sensors, std::vector<std::size_t>{0, 1, 2, 3, 22}), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(sensors_of(sensors, std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), std::vector<std::size_t>{});
  EXPECT_EQ(sensors_of(sensors, std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}),
            std::vector<std::size_t>{1});
  EXPECT_EQ(sensors_of(sensors, {}), std::vector<std::size_t>{});
}

}  // namespace
}  // namespace clerestory
