#include "solver/form_factors/point_to_polygon.h"

#include <numbers>

#include <gtest/gtest.h>

#include "tests/solver/form_factors/reference_rows.h"

namespace clerestory {
namespace {

using test::Polygon;

/// Unit square at height z over the plane z = 0, its front down.
Polygon square_at(double z) { return {{0, 1, z}, {1, 1, z}, {1, 0, z}, {0, 0, z}}; }
constexpr Vec3 kUp{0, 0, 1};

TEST(PointToPolygon, MatchesTheClosedFormsBelowACornerAndVeryNear) {
  // Closed forms of Howell's catalogue C-1 evaluated with 60 digits: rows PT01, PT04, PT06 of the reference table.
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, kUp, square_at(1)), 0.138531605994893, 1e-14);
  EXPECT_NEAR(point_to_polygon({0.5, 0.5, 0}, kUp, square_at(0.001)), 0.999996726771548, 1e-14);
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, kUp, square_at(100)), 3.18267450806544e-5, 1e-17);
}

TEST(PointToPolygon, CountsOnlyThePartAboveTheHorizon) {
  // A wall from z = -1 to 1 is seen from the floor like its upper half: row PT02, a perpendicular unit square.
  const Polygon wall{{0, 1, -1}, {1, 1, -1}, {1, 1, 1}, {0, 1, 1}};
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, kUp, wall), 0.0557341970025535, 1e-15);
}

TEST(PointToPolygon, IsZeroFromBehindAndInThePlane) {
  EXPECT_EQ(point_to_polygon({0.5, 0.5, 2}, -kUp, square_at(1)), 0);
  EXPECT_EQ(point_to_polygon({3, 0.5, 1}, kUp, square_at(1)), 0);
  EXPECT_EQ(point_to_polygon({0.5, 0.5, 0}, -kUp, square_at(1)), 0);
}

TEST(PointToPolygon, SumsToOneOverTheWallsOfABoxFromAnyPoint) {
  // Six faces seen from inside, some cut by the horizon of the tilted element: together the whole hemisphere.
  const Vec3 normal = normalized(Vec3{0.3, -0.7, 0.2}), p{0.2, 0.9, 0.4};
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  const auto face = [&](const Vec3& c, const Vec3& u, const Vec3& v) {
    return point_to_polygon(p, normal, Polygon{c, c + u, c + u + v, c + v});
  };
  const double sum = face(o, x, y) + face(z, y, x) + face(o, y, z) + face(x, z, y) + face(o, z, x) + face(y, x, z);
  EXPECT_NEAR(sum, 1, 1e-14);
}

TEST(PointToPolygon, KeepsItsDigitsFarAway) {
  // At distance d >> size, F -> A / (pi d2) * (1 + O(size2 / d2)); at 1e6 the correction is 1e-12.
  const double d = 1e6;
  EXPECT_NEAR(point_to_polygon({0.5, 0.5, 0}, kUp, square_at(d)) * std::numbers::pi * d * d, 1, 1e-9);
}

TEST(PointToPolygon, EveryReferenceRowOfAnElementToARectangle) {
  int rows = 0;
  for (const auto& row : test::reference_rows()) {
    if (row.family != "dA_to_rectangle") continue;
    const double F =
        point_to_polygon(test::read_vector(row.params, "p"), test::read_vector(row.params, "n"), row.polygon2);
    EXPECT_NEAR(F / row.value, 1, 1e-6) << row.id;  // the bar; rounding leaves about 1e-12
    ++rows;
  }
  EXPECT_GE(rows, 3);
}

}  // namespace
}  // namespace clerestory
