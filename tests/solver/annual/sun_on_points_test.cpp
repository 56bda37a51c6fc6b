// Direct sun at points against closed forms.

#include "solver/annual/sun_on_points.h"

#include <numbers>

#include <gtest/gtest.h>

#include "solver/lights/sun.h"
#include "solver/visibility/glass_sheet.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Unit, from the south, which is -y.
Vec3 from_south(double elevation_deg) {
  return {0, -std::cos(elevation_deg * kDegree), std::sin(elevation_deg * kDegree)};
}

/// A sheet at y = 0 with a hole, x from 0 to 2 and z from 1 to 2, with a pane of what is given in it.
PatchSet sheet_with_hole(double pane) {
  test::PatchBuilder b;
  b.rectangle({-9, 0, -9}, {0, 0, 19}, {9, 0, 0}).rectangle({2, 0, -9}, {0, 0, 19}, {9, 0, 0});
  b.rectangle({0, 0, -9}, {0, 0, 10}, {2, 0, 0}).rectangle({0, 0, 2}, {0, 0, 8}, {2, 0, 0});
  if (pane < 1) b.glass(pane).rectangle({0, 0, 1}, {0, 0, 1}, {2, 0, 0});
  return test::two_sided(b.build());
}

std::vector<float> at_points(const PatchSet& patches, const std::vector<ReceivingPoint>& points,
                             const std::vector<SunOfHour>& suns, const std::vector<bool>& may_come = {}) {
  std::vector<float> out(points.size() * suns.size(), -1);
  sun_on_points(RayScene(patches), points, suns, may_come, out);
  return out;
}

TEST(SunOnPoints, ComesThroughAWindowWithItsCosineAndWhatGlassLetsPass) {
  const std::vector<ReceivingPoint> points = {
      {{1, 1, 0}, {0, 0, 1}}, {{1, 1, 0.6}, {0, 0, 1}}, {{1, 1, 0.6}, {0, -1, 0}}, {{1, 1, 0.6}, {0, 1, 0}}};
  std::vector<SunOfHour> suns;
  suns.emplace_back(from_south(55), std::vector<MirrorWay>{}, 16, 7);  // 1.43 m up on 1 m
  suns.emplace_back(from_south(30), std::vector<MirrorWay>{}, 16, 8);  // 0.58 m
  const auto z = [&](std::size_t s) { return suns[s].direction.z; };
  for (const double pane : {1.0, 0.65}) {
    const std::vector<float> E = at_points(sheet_with_hole(pane), points, suns);
    const auto passes = [&](std::size_t s) {
      return pane < 1 ? sheet_shares(fit_glass_sheet(pane), -suns[s].direction.y).transmittance : 1;
    };
    const double off = 2e-4;  // of the glass' table, and of the cosine over the disc, whose rays are not its middle
    EXPECT_NEAR(E[0], z(0) * passes(0), off);
    EXPECT_EQ(E[1], 0) << "below the hole";
    EXPECT_EQ(E[2], 0) << "above it";
    EXPECT_NEAR(E[3], z(1) * passes(1), off);
    EXPECT_NEAR(E[5], -suns[1].direction.y * passes(1), off);
    EXPECT_EQ(E[7], 0) << "looks away";
  }
}

TEST(SunOnPoints, IsNotLookedForWhereItCannotCome) {
  std::vector<SunOfHour> suns;
  suns.emplace_back(from_south(55), std::vector<MirrorWay>{}, 16, 7);
  const std::vector<ReceivingPoint> points(2, {{1, 1, 0}, {0, 0, 1}});
  const std::vector<float> E = at_points(sheet_with_hole(1), points, suns, {false, true});
  EXPECT_EQ(E[0], 0);
  EXPECT_GT(E[1], 0.8);
}

/// Share of the disc above an edge at t radii over its middle.
double share_above(double t) { return (std::acos(t) - t * std::sqrt(1 - t * t)) / std::numbers::pi; }

TEST(SunOnPoints, HalfShadowIsTheShareOfTheDiscThatIsSeen) {
  // The hole's sill, 10 m off, cuts the disc at t radii above its middle. Points lie along the slope of the sun's
  // middle.
  PatchSet patches = sheet_with_hole(1);
  const double elevation = 20, radius = kSunDiameterDeg / 2 * kDegree;
  std::vector<SunOfHour> suns;
  suns.emplace_back(from_south(elevation), std::vector<MirrorWay>{}, 256, 11);
  std::vector<ReceivingPoint> points;
  std::vector<double> share;
  for (double t = -1.15; t < 1.2; t += 0.1) {
    const double angle = elevation * kDegree + t * radius;
    points.push_back({{1, 10, 1 - 10 * std::tan(angle)}, {0, -1, 0}});
    share.push_back(t <= -1 ? 1 : t >= 1 ? 0 : share_above(t));
  }
  const std::vector<float> E = at_points(patches, points, suns);
  // 256 directions of a Sobol sequence over a disc in two parts: their share is known to about 1 / 64.
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double least = 0.001;  // the cosine over the disc
    EXPECT_NEAR(E[k], -suns[0].direction.y * share[k], share[k] == 0 || share[k] == 1 ? least : 0.016) << k;
  }
}

TEST(SunOnPoints, ASlantedEdgeIsNeverOffByMoreThanItsCap) {
  // An edge turned by 45 degrees passes between the pilots where it cuts off less than (pi/2 - 1) / (2 pi) = 9.1 %.
  test::PatchBuilder b;
  const Vec3 sun = from_south(30), right{1, 0, 0}, up = cross(sun, right) * -1.0;
  const double far = 10, radius = std::tan(kSunDiameterDeg / 2 * kDegree) * far;
  const Vec3 along = normalized(right + up), across = normalized(right * -1.0 + up);
  b.rectangle(sun * far - along * 5, along * 10, across * 5);
  const PatchSet patches = test::two_sided(b.build());
  std::vector<SunOfHour> suns;
  suns.emplace_back(sun, std::vector<MirrorWay>{}, 256, 3);
  for (double t = -0.95; t < 1; t += 0.1) {
    // Moving the point by t radii moves the sun's middle as far past the edge.
    const std::vector<float> E = at_points(patches, {{across * (t * radius), sun}}, suns);
    const double share = 1 - share_above(-t);
    EXPECT_NEAR(E[0], share, std::abs(t) > std::sqrt(0.5) ? 0.092 : 0.016) << t;
  }
}

}  // namespace
}  // namespace clerestory
