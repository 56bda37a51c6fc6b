// Where cameras put what they see.

#include "solver/view/camera.h"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "solver/view/place_camera.h"
#include "solver/view/sample_pattern.h"

namespace clerestory {
namespace {

/// From (0, 0, 1) along +y, 90 degrees across.
Camera looks_north(CameraKind kind, int width, int height) {
  Camera camera;
  camera.kind = kind, camera.width = width, camera.height = height, camera.eye = {0, 0, 1};
  camera.turn({0, 1, 0}, {0, 0, 1});
  camera.half_width = half_width_of_angle(90, width, height);
  return camera;
}

void expect_at(const Camera& camera, const Vec3& p, double x, double y) {
  const auto at = project(camera, p);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->x, x, 1e-9);
  EXPECT_NEAR(at->y, y, 1e-9);
}

TEST(Camera, PutsAPointThroughAPinholeWhereItsDirectionSays) {
  const Camera camera = looks_north(CameraKind::perspective, 200, 100);
  expect_at(camera, {0, 5, 1}, 100, 50);
  expect_at(camera, {1, 2, 1}, 150, 50);      // tan = 1/2 of the half width: half way to the right edge
  expect_at(camera, {-2, 2, 1}, 0, 50);       // 45 degrees: the left edge
  expect_at(camera, {0, 4, 2}, 100, 25);      // a quarter of the half width up: 25 pixels
  EXPECT_FALSE(project(camera, {0, -1, 1}));  // behind
}

TEST(Camera, SpansItsAngleAcrossTheLongerSide) {
  const Camera camera = looks_north(CameraKind::perspective, 100, 200);
  expect_at(camera, {0, 2, 3}, 50, 0);
  expect_at(camera, {1, 2, 1}, 100, 100);
}

TEST(Camera, OfAFisheyePutsAnglesEvenlyFromTheMiddle) {
  const Camera camera = looks_north(CameraKind::fisheye, 400, 200);
  for (const double degrees : {0.0, 30.0, 45.0, 60.0, 90.0}) {
    const double theta = degrees * std::numbers::pi / 180;
    expect_at(camera, camera.eye + Vec3{std::sin(theta), std::cos(theta), 0} * 7, 200 + 100 * degrees / 90, 100);
    expect_at(camera, camera.eye + Vec3{0, std::cos(theta), std::sin(theta)} * 7, 200, 100 - 100 * degrees / 90);
  }
  EXPECT_FALSE(project(camera, {0, -1, 1}));
  EXPECT_FALSE(ray_through(camera, 50, 100)) << "outside of the circle";
}

TEST(Camera, SendsItsRaysToWhereItPutsPoints) {
  for (const CameraKind kind : {CameraKind::perspective, CameraKind::orthographic, CameraKind::fisheye}) {
    Camera camera = looks_north(kind, 160, 90);
    camera.turn({0.3, 1, -0.2}, {0, 0, 1});
    for (const double x : {60.5, 80.0, 99.25})
      for (const double y : {10.0, 44.0, 71.5}) {
        const auto ray = ray_through(camera, x, y);
        ASSERT_TRUE(ray);
        expect_at(camera, ray->origin + ray->direction * 3, x, y);
      }
  }
}

TEST(Camera, LooksStraightDownAndUp) {
  Camera camera;
  camera.turn({0, 0, -1}, {0, 0, 1});
  EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(camera.right, (Vec3{1, 0, 0}));
  camera.turn({0, 0, 1}, {0, 0, 1});
  EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
  EXPECT_EQ(camera.right, (Vec3{-1, 0, 0}));
}

class OfABox : public testing::Test {
 protected:
  OfABox() {
    for (int i = 0; i < 8; ++i) points_.push_back({5.0 + (i & 1) * 4, -3.0 + (i >> 1 & 1) * 2, 7.0 + (i >> 2) * 3});
    triangles_ = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4}};
  }
  std::vector<Vec3> points_;  ///< 4 x 2 x 3 m
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

TEST_F(OfABox, APlanIsToScaleAndHasNorthUp) {
  const auto camera = camera_of_cut({2, 8}, points_, triangles_, 416, 300);
  ASSERT_TRUE(camera);
  const double per_metre = 416 / (4 * 1.04);  // 4 m and the margin fill the width
  EXPECT_NEAR(camera->half_width, 416 / per_metre / 2, 1e-9);
  expect_at(*camera, {5, -3, 7}, 208 - 2 * per_metre, 150 + per_metre);
  expect_at(*camera, {9, -1, 7}, 208 + 2 * per_metre, 150 - per_metre);
  EXPECT_FALSE(project(*camera, {7, -2, 8.1})) << "above the cut";
  EXPECT_FALSE(camera_of_cut({2, 6.9}, points_, triangles_, 416, 300)) << "nothing is below";
}

TEST_F(OfABox, ASectionLooksAlongItsAxis) {
  const auto camera = camera_of_cut({1, -2}, points_, triangles_, 416, 416);
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->forward, (Vec3{0, 1, 0}));
  EXPECT_EQ(camera->up, (Vec3{0, 0, 1}));
  expect_at(*camera, {5, -1, 10}, 8, 58);  // 100 pixels a metre
  EXPECT_FALSE(project(*camera, {7, -2.5, 8}));
}

TEST_F(OfABox, AViewThatFitsShowsAllAndTouchesItsMargin) {
  for (const auto& [width, height] : {std::pair{400, 300}, std::pair{100, 500}}) {
    const Camera camera = camera_that_fits(points_, width, height);
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    for (const Vec3& p : points_) {
      const auto at = project(camera, p);
      ASSERT_TRUE(at);
      left = std::min(left, at->x), right = std::max(right, at->x);
      top = std::min(top, at->y), bottom = std::max(bottom, at->y);
    }
    EXPECT_NEAR(left + right, width, 0.03 * width) << "in the middle";
    EXPECT_NEAR(top + bottom, height, 0.03 * height);
    EXPECT_NEAR(std::max((right - left) / width, (bottom - top) / height), 1 / 1.04, 1e-9);
  }
}

TEST(SamplePattern, HasARayInEachColumnAndRowAndTheMiddleForItsMean) {
  for (const std::size_t n : {1u, 4u, 7u, 16u}) {
    double x = 0, y = 0;
    std::set<double> columns, rows;
    for (const auto& [u, v] : sample_pattern(n)) x += u, y += v, columns.insert(u), rows.insert(v);
    EXPECT_NEAR(x / static_cast<double>(n), 0.5, 1e-12);
    EXPECT_NEAR(y / static_cast<double>(n), 0.5, 1e-12);
    EXPECT_EQ(columns.size(), n);
    EXPECT_EQ(rows.size(), n);
  }
}

}  // namespace
}  // namespace clerestory
