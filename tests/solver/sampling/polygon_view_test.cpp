#include "solver/sampling/polygon_view.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

using Triangles = std::vector<std::array<Vec3, 3>>;

Triangles rectangle(const Vec3& o, const Vec3& u, const Vec3& v) {
  return {{o, o + u, o + u + v}, {o, o + u + v, o + v}};
}
/// As a rectangle, and as two triangles.
std::array<PolygonView, 2> views(const Vec3& p, const Vec3& n, const Triangles& t) {
  const std::array<Vec3, 4> corners{t[0][0], t[0][1], t[0][2], t[1][2]};
  return {PolygonView(p, n, t, corners), PolygonView(p, n, t, {})};
}

/// Irradiance under radiance 1 / pi from the directions of the view, by n x n midpoints.
double irradiance(const PolygonView& view, const Vec3& n, int points) {
  double sum = 0;
  for (int i = 0; i < points; ++i)
    for (int j = 0; j < points; ++j) {
      const auto [d, per_share] = view.look((i + 0.5) / points, (j + 0.5) / points);
      sum += dot(d, n) * per_share;
    }
  return sum / (points * points) / std::numbers::pi;
}

double form_factor(const Triangles& triangles, const Vec3& p, const Vec3& n) {
  double F = 0;
  for (const auto& t : triangles) F += point_to_polygon(p, n, t);
  return F;
}

struct Seen {
  const char* name;
  Triangles polygon;
  Vec3 p, n;
};
// Fronts face the points.
const std::vector<Seen> kSeen{
    {"window over the sill, from the floor", rectangle({1, 0, 1}, {0, 0, 1}, {2, 0, 0}), {2, 3.25, 0}, {0, 0, 1}},
    {"rooflight from a wall", rectangle({1.5, 1.5, 3}, {0, 1, 0}, {1, 0, 0}), {2, 0, 2.75}, {0, 1, 0}},
    {"cut by the horizon", rectangle({-2, 0, -1}, {0, 0, 2}, {4, 0, 0}), {0.3, 0.5, 0}, {0, 0, 1}},
    {"close by", rectangle({-2, 0, -1}, {0, 0, 2}, {4, 0, 0}), {0.3, 0.001, 0}, {0, -1, 0}},
    {"slit of 1 mm, 20 m away", rectangle({0, 0, 1}, {0, 0, 1}, {0.001, 0, 0}), {3, 20, 0.5}, {0, -1, 0}},
    {"slit of 1 mm, 30 cm away", rectangle({0, 0, 1}, {0, 0, 1}, {0.001, 0, 0}), {0.1, 0.3, 1.2}, {0, -1, 0}},
    {"pinhole", rectangle({0, 0, 1}, {0, 0, 1e-4}, {1e-4, 0, 0}), {1, 5, 0}, {0, -1, 0}},
};

TEST(PolygonView, DirectionsIntegrateToTheFormFactor) {
  for (const Seen& s : kSeen) {
    const double exact = form_factor(s.polygon, s.p, s.n);
    ASSERT_GT(exact, 0) << s.name;
    // The midpoint rule on 256 x 256 points; corners of the triangles and the horizon leave first order there.
    for (const PolygonView& view : views(s.p, s.n, s.polygon))
      EXPECT_NEAR(irradiance(view, s.n, 256) / exact, 1, 2e-3) << s.name;
  }
}

TEST(PolygonView, EveryDirectionMeetsThePolygonAboveTheHorizon) {
  for (const Seen& s : kSeen)
    for (const PolygonView& view : views(s.p, s.n, s.polygon)) {
      for (std::uint32_t k = 0; k < 1000; ++k) {
        const auto u = sobol4(k, 5);
        const Vec3 d = view.look(u[0], u[1]).direction;
        EXPECT_NEAR(length(d), 1, 1e-12);
        EXPECT_GT(dot(d, s.n), -1e-9) << s.name;
        const Vec3 o = s.polygon[0][0], along = s.polygon[0][1] - o, across = s.polygon[1][2] - o;
        const Vec3 normal = cross(along, across);
        const Vec3 x = s.p + d * (dot(o - s.p, normal) / dot(d, normal)) - o;
        for (const Vec3& axis : {along, across}) {
          EXPECT_GT(dot(x, axis) / dot(axis, axis), -1e-6) << s.name;
          EXPECT_LT(dot(x, axis) / dot(axis, axis), 1 + 1e-6) << s.name;
        }
      }
    }
}

TEST(PolygonView, SharesOfTheSquareAreSharesOfTheSolidAngle) {
  // Of a square seen from its axis each quarter is a quarter; directions in it must be as many.
  const Triangles square = rectangle({-1, 0, -1}, {0, 0, 2}, {2, 0, 0});
  constexpr int kPoints = 4096;
  for (const PolygonView& view : views({0, 1.5, 0}, {0, -1, 0}, square)) {
    int count = 0;
    for (std::uint32_t k = 0; k < kPoints; ++k) {
      const auto u = sobol4(k, 9);
      const Vec3 d = view.look(u[0], u[1]).direction;
      count += d.x > 0 && d.z > 0;
    }
    EXPECT_NEAR(count, kPoints / 4, kPoints * 0.004);
  }
}

TEST(PolygonView, OfAPolygonBelowTheHorizonOrInThePlaneNothingIsSeen) {
  const Triangles below = rectangle({-1, 0, -2}, {0, 0, 1}, {2, 0, 0});
  for (const PolygonView& view : views({0, 1, 0}, {0, 0, 1}, below)) EXPECT_EQ(view.solid_angle(), 0);
  for (const PolygonView& view : views({5, 0, 0}, {-1, 0, 0}, below)) EXPECT_EQ(view.solid_angle(), 0);
}

}  // namespace
}  // namespace clerestory
