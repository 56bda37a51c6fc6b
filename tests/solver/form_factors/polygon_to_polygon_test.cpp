#include "solver/form_factors/polygon_to_polygon.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/form_factors/contour_exchange.h"
#include "solver/form_factors/point_to_polygon.h"
#include "solver/geometry/polygon.h"
#include "solver/model/random_stream.h"
#include "tests/solver/form_factors/reference_rows.h"

namespace clerestory {
namespace {

using test::Polygon;

Polygon floor_of(double a, double b) { return {{0, 0, 0}, {a, 0, 0}, {a, b, 0}, {0, b, 0}}; }
Polygon ceiling_of(double a, double b, double c) { return {{0, 0, c}, {0, b, c}, {a, b, c}, {a, 0, c}}; }
/// The unit floor's partner over the shared edge y = 0, opened by `degrees`.
Polygon wedge(double degrees) {
  const double t = degrees * std::numbers::pi / 180, y = std::cos(t), z = std::sin(t);
  return {{0, 0, 0}, {0, y, z}, {1, y, z}, {1, 0, 0}};
}
Polygon transformed(Polygon polygon, double scale, const Vec3& move) {
  for (Vec3& x : polygon) x = x * scale + move;
  return polygon;
}

TEST(PolygonToPolygon, OpposedRectanglesMatchTheClosedFormFromTouchingToFar) {
  // Howell C-11 evaluated with 60 digits: rows PAR01, PAR04, PAR07, PAR10 and PAR12 of the reference table. Tolerance:
  // rounding, which the far and the thin pair feel most.
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), ceiling_of(1, 1, 1)), 0.199824895698387, 1e-13);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), ceiling_of(1, 1, 1e-4)), 0.999800070977788, 1e-13);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), ceiling_of(1, 1, 1e4)) / 3.18309884061725e-9, 1, 1e-11);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1000), ceiling_of(1, 1000, 1)) / 0.413934198079351, 1, 1e-10);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1000), ceiling_of(1, 1000, 1000)) / 0.00024999992423713, 1, 1e-10);
}

TEST(PolygonToPolygon, WedgesThatShareAnEdgeMatchTheContourIntegral) {
  // The double contour integral by tanh-sinh with 45 digits: rows INC02, INC06 and INC10.
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), wedge(1)) / 0.982997178574649, 1, 1e-11);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), wedge(60)) / 0.370905321150051, 1, 1e-11);
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), wedge(179)) / 2.36087831149834e-5, 1, 1e-9);
}

TEST(PolygonToPolygon, LongWedgesApproachTheInfiniteOne) {
  // 1 - sin(angle / 2) for sides of width 1 and infinite length; ends of a strip of length L take away O(1 / L).
  for (const double degrees : {0.1, 1.0, 90.0, 170.0}) {
    const double t = degrees * std::numbers::pi / 180, L = 1e5;
    const Polygon side{{0, 0, 0}, {0, std::cos(t), std::sin(t)}, {L, std::cos(t), std::sin(t)}, {L, 0, 0}};
    EXPECT_NEAR(polygon_to_polygon(floor_of(L, 1), side), 1 - std::sin(t / 2), 1 / L) << degrees;
  }
}

TEST(PolygonToPolygon, NonConvexAndSliverPolygonsMatchTheContourIntegral) {
  // Rows POL03 (L-shaped floor and ceiling) and POL05 (1:1000 triangles), made by tanh-sinh quadrature.
  const Polygon L_floor{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  const Polygon L_ceiling{{0, 0, 1.5}, {0, 2, 1.5}, {1, 2, 1.5}, {1, 1, 1.5}, {2, 1, 1.5}, {2, 0, 1.5}};
  EXPECT_NEAR(polygon_to_polygon(L_floor, L_ceiling), 0.225390765560458, 1e-13);
  const Polygon sliver{{0, 0, 0}, {1000, 0, 0}, {0, 1, 0}}, opposed{{0, 0, 1}, {0, 1, 1}, {1000, 0, 1}};
  EXPECT_NEAR(polygon_to_polygon(sliver, opposed) / 0.295307727289772, 1, 1e-9);
}

TEST(PolygonToPolygon, KeepsItsValueUnderScaleAndFarFromTheOrigin) {
  const double F = polygon_to_polygon(floor_of(1, 1), wedge(30));
  for (const double scale : {1e-3, 1e4})
    EXPECT_NEAR(polygon_to_polygon(transformed(floor_of(1, 1), scale, {}), transformed(wedge(30), scale, {})), F,
                1e-12);
  // Corners a million units away keep 1e-10 of the size.
  const Vec3 away{1e6, -2e6, 3e5};
  EXPECT_NEAR(polygon_to_polygon(transformed(floor_of(1, 1), 1, away), transformed(wedge(30), 1, away)), F, 1e-8);
}

TEST(PolygonToPolygon, IsZeroForPolygonsThatDoNotFaceEachOther) {
  const Polygon floor = floor_of(1, 1);
  Polygon turned = ceiling_of(1, 1, 1);
  std::ranges::reverse(turned);
  EXPECT_EQ(polygon_to_polygon(floor, turned), 0);
  EXPECT_EQ(polygon_to_polygon(floor, transformed(floor_of(1, 1), 1, {2, 0, 0})), 0);  // side by side in one plane
  EXPECT_EQ(polygon_to_polygon(floor, Polygon{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}}), 0);   // no area
  EXPECT_EQ(polygon_to_polygon(floor, Polygon{}), 0);
}

TEST(PolygonToPolygon, ClipsWhatLiesBehindThePartnersPlane) {
  // A wall that goes on below the floor counts with its upper part: row PERP01.
  const Polygon wall{{0, 0, -2}, {0, 0, 1}, {1, 0, 1}, {1, 0, -2}};
  EXPECT_NEAR(polygon_to_polygon(floor_of(1, 1), wall), 0.200043776075403, 1e-13);
}

TEST(PolygonToPolygon, FacesOfAClosedTetrahedronSumToOneWhateverItsShape) {
  // Random, often sliver, tetrahedra: all pairs share an edge. Sums and reciprocity are exact but for rounding.
  for (std::uint64_t k = 0; k < 200; ++k) {
    RandomStream random(5, k);
    std::array<Vec3, 4> v;
    const double flatten = std::pow(10.0, -3 * random.uniform());
    for (Vec3& x : v) x = {random.uniform(), random.uniform(), flatten * random.uniform()};
    if (dot(cross(v[1] - v[0], v[2] - v[0]), v[3] - v[0]) < 0) std::swap(v[1], v[2]);
    const Polygon faces[4] = {{v[0], v[1], v[2]}, {v[0], v[3], v[1]}, {v[1], v[3], v[2]}, {v[0], v[2], v[3]}};
    for (const Polygon& from : faces) {
      double sum = 0;
      for (const Polygon& to : faces)
        if (&to != &from) sum += polygon_to_polygon(from, to);
      EXPECT_NEAR(sum, 1, 1e-9) << "tetrahedron " << k;
    }
  }
}

TEST(PolygonToPolygon, AgreesWithTheMeanOfPointToPolygonOverSmallSlantedPairs) {
  // Second way without contours: F12 is the mean of point_to_polygon over polygon 1. The midpoint rule on n x n cells
  // errs by O(n^-2) for a smooth integrand: a fourth when n doubles.
  const Polygon one = floor_of(1, 1), two{{0.2, 0.1, 1.3}, {0.4, 1.2, 1.1}, {1.4, 0.7, 0.9}};
  ASSERT_GT(polygon_to_polygon(one, two), 0);
  const auto error = [&](int n) {
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) sum += point_to_polygon({(i + 0.5) / n, (j + 0.5) / n, 0}, {0, 0, 1}, two) / (n * n);
    return std::abs(sum - polygon_to_polygon(one, two));
  };
  EXPECT_LT(error(32), 1e-4);
  EXPECT_NEAR(error(16) / error(32), 4, 0.2);
}

TEST(ContourExchange, ClosedFormsOfEdgePairsAgreeWithTanhSinhQuadrature) {
  // Random triangles in front of each other, the second one 1 to 1e-3 times as large. Tolerance: rounding that
  // contour_exchange() admits itself, and as much in the quadrature.
  int compared = 0;
  for (std::uint64_t k = 0; k < 300; ++k) {
    RandomStream random(7, k);
    const auto u = [&] { return 2 * random.uniform() - 1; };
    Polygon a, b;
    for (int c = 0; c < 3; ++c) a.push_back({u(), u(), 0}), b.push_back({u(), u(), 1.01 + u()});
    const double scale = std::pow(10.0, -3 * random.uniform());
    for (Vec3& x : b) x = b[0] + (x - b[0]) * scale;
    if (vector_area(a).z < 0) std::swap(a[1], a[2]);
    if (dot(vector_area(b), a[0] - b[0]) < 0) std::swap(b[1], b[2]);
    const Polygon front = clip_to_front(a, HalfSpace::through(b[0], normalized(vector_area(b))), 1e-14);
    if (front.empty()) continue;
    double quadrature = 0;
    for (std::size_t i = 0; i < front.size(); ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const Vec3 a0 = front[i], a1 = front[(i + 1) % front.size()], b0 = b[j], b1 = b[(j + 1) % 3];
        quadrature +=
            dot(normalized(a1 - a0), normalized(b1 - b0)) * segment_log_integral_by_quadrature(a0, a1, b0, b1);
      }
    quadrature /= 2 * std::numbers::pi;
    const ContourSum sum = contour_exchange(front, b);
    EXPECT_NEAR(sum.value, quadrature, 20 * sum.rounding + 1e-15) << "pair " << k;
    ++compared;
  }
  EXPECT_GT(compared, 200);
}

/// Two triangles that share one vertex, at `touch`; the second, `scale` times as large, is opened by `degrees` over the
/// first one's plane, turned by `turn` around the normal, and each `width` wide at its far end.
std::array<Polygon, 2> vertex_pair(double degrees, double turn, double width, double scale, const Vec3& touch) {
  const double t = degrees * std::numbers::pi / 180, p = turn * std::numbers::pi / 180;
  const Vec3 along{std::cos(p), std::sin(p), 0}, across{-std::sin(p), std::cos(p), 0};
  const Vec3 up = along * std::cos(t) + Vec3{0, 0, std::sin(t)};
  const Polygon one{touch, touch + Vec3{1, -width / 2, 0}, touch + Vec3{1, width / 2, 0}};
  Polygon two{touch, touch + (up + across * (width / 2)) * scale, touch + (up - across * (width / 2)) * scale};
  // Both fronts: the second one's towards the first.
  if (dot(vector_area(two), one[1] + one[2] - touch * 2) < 0) std::swap(two[1], two[2]);
  return {one, two};
}

TEST(PolygonToPolygon, TrianglesThatShareOneVertexKeepTheirBoundsAndReciprocityWhateverTheirShape) {
  // Halving near pairs never ends where they touch: it once ran down the stack. The shared vertex also a rounding off.
  for (const double degrees : {1e-3, 5.0, 60.0, 179.0})
    for (const double turn : {20.0, 90.0, 180.0})
      for (const double width : {1e-12, 1e-3, 0.3})
        for (const double scale : {1e-6, 1.0})
          for (const double off : {0.0, -1e-12}) {
            auto [one, two] = vertex_pair(degrees, turn, width, scale, {0.133694, 0.403013, -0.321245});
            two[0].z += off;
            const double there = exchange_area(one, two), back = exchange_area(two, one);
            const double F12 = polygon_to_polygon(one, two), F21 = polygon_to_polygon(two, one);
            const auto which = testing::Message() << degrees << " turn " << turn << " width " << width << " scale "
                                                  << scale << " off " << off;
            EXPECT_TRUE(F12 >= 0 && F12 <= 1 && F21 >= 0 && F21 <= 1) << which << ": " << F12 << " " << F21;
            // Slivers that reach far along each other stay with the contour, right to rounding of the whole pair's
            // size.
            EXPECT_NEAR(there, back, 1e-6 * there + 2e-14) << which;
          }
}

TEST(PolygonToPolygon, TrianglesThatShareOneVertexMatchASampledEstimate) {
  // Mean of the closed point_to_polygon() over 4096 random points of the first triangle, within four standard
  // errors, and for slivers within the rounding of their contour, 1e-15 m2.
  for (const double degrees : {1e-3, 0.1, 5.0, 60.0, 120.0})
    for (const double turn : {30.0, 90.0, 180.0})
      for (const double width : {1e-3, 0.3, 1.0}) {
        const auto [one, two] = vertex_pair(degrees, turn, width, 1, {});
        const Vec3 normal = normalized(vector_area(one));
        RandomStream random(11, 0);
        constexpr int kPoints = 4096;
        double sum = 0, squares = 0;
        for (int k = 0; k < kPoints; ++k) {
          const double r = std::sqrt(random.uniform()), v = random.uniform();
          const double f =
              point_to_polygon(one[0] + (one[1] - one[0]) * (r * (1 - v)) + (one[2] - one[0]) * (r * v), normal, two);
          sum += f, squares += f * f;
        }
        const double mean = sum / kPoints;
        const double std_error = std::sqrt(std::max(0.0, squares / kPoints - mean * mean) / kPoints);
        EXPECT_NEAR(polygon_to_polygon(one, two), mean, 4 * std_error + 1e-9 * mean + 1e-15 / length(vector_area(one)))
            << degrees << " turn " << turn << " width " << width;
      }
}

TEST(PolygonToPolygon, AGrazingPairAtAVertexOfAModelIsIntegrated) {
  // Two of the triangles that ran down the stack, nearly in one plane: 5e-8 of the flux crosses.
  const Vec3 touch{0.133694, 0.403013, -0.321245};
  const Polygon one{{0.053197, 0.497996, -0.321214}, {0.133694, 0.378068, -0.321245}, touch};
  const Polygon two{{0.077775, 0.497996, -0.321214}, {0.053197, 0.497996, -0.321214}, touch};
  const double there = exchange_area(one, two);
  EXPECT_GT(there, 0);
  EXPECT_NEAR(exchange_area(two, one) / there, 1, 1e-9);
}

TEST(PolygonToPolygon, EveryReferenceRowOfTwoPolygonsIsRightToOneInAMillion) {
  int rows = 0;
  for (const auto& row : test::reference_rows()) {
    if (row.polygon1.empty() || row.polygon2.empty() || !row.occluders.empty()) continue;
    EXPECT_NEAR(polygon_to_polygon(row.polygon1, row.polygon2) / row.value, 1, 1e-6) << row.id;
    EXPECT_NEAR(exchange_area(row.polygon2, row.polygon1) / exchange_area(row.polygon1, row.polygon2), 1, 1e-9)
        << row.id;
    ++rows;
  }
  EXPECT_GE(rows, 30);
}

}  // namespace
}  // namespace clerestory
