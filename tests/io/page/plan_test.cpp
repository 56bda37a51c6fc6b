#include "io/page/plan.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

/// Points of a lattice turned by an angle, row by row.
std::vector<PlanPoint> turned_grid(std::size_t columns, std::size_t rows, double du, double dv, double angle) {
  std::vector<PlanPoint> points;
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const double x = du * static_cast<double>(i), y = dv * static_cast<double>(j);
      points.push_back({x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)});
    }
  return points;
}

std::vector<double> count(std::size_t n) {
  std::vector<double> value(n);
  for (std::size_t i = 0; i < n; ++i) value[i] = static_cast<double>(i);
  return value;
}

TEST(Lattice, IsFoundInATurnedGridWhateverTheOrderOfItsPoints) {
  std::vector<PlanPoint> points = turned_grid(7, 5, 0.5, 0.2, 0.3);
  std::vector<double> value = count(35);
  std::rotate(points.begin(), points.begin() + 17, points.end());
  std::rotate(value.begin(), value.begin() + 17, value.end());
  const auto lattice = lattice_of(points, value);
  ASSERT_TRUE(lattice);
  EXPECT_EQ(lattice->columns, 7u);
  EXPECT_EQ(lattice->rows, 5u);
  EXPECT_NEAR(std::hypot(lattice->u.x, lattice->u.y), 0.5, 1e-12);
  EXPECT_NEAR(std::hypot(lattice->v.x, lattice->v.y), 0.2, 1e-12);
  EXPECT_EQ(lattice->value, count(35));
}

TEST(Lattice, HasHolesWhereThereAreNoPoints) {
  std::vector<PlanPoint> points = turned_grid(4, 4, 1, 1, 0);
  std::vector<double> value = count(16);
  points.erase(points.begin() + 5), value.erase(value.begin() + 5);
  const auto lattice = lattice_of(points, value);
  ASSERT_TRUE(lattice);
  EXPECT_TRUE(std::isnan(lattice->value[5]));
  EXPECT_EQ(lattice->value[6], 6);
}

TEST(Lattice, IsNotSeenInPointsThatLieOtherwise) {
  const std::vector<double> four = count(4);
  EXPECT_FALSE(lattice_of(std::vector<PlanPoint>{{0, 0}, {1, 0}, {2, 0}, {3, 0}}, four)) << "a row";
  EXPECT_FALSE(lattice_of(std::vector<PlanPoint>{{0, 0}, {1, 0}, {0, 1}, {1.3, 1.2}}, four));
  EXPECT_FALSE(lattice_of(std::vector<PlanPoint>{{0, 0}, {1, 0}, {0, 1}, {0, 1}}, four)) << "one above another";
  EXPECT_FALSE(lattice_of(std::vector<PlanPoint>{{0, 0}, {0, 0}, {0, 0}, {0, 0}}, four));
  EXPECT_FALSE(lattice_of(std::vector<PlanPoint>{{0, 0}, {1, 0}, {0, 1}, {900, 900}}, four)) << "nearly all empty";
}

TEST(Isolux, IsACircleUnderAPointLamp) {
  // A lamp of I cd at height h: E = I h / (h2 + r2)^1.5, so E is reached at r = sqrt((I h / E)^(2/3) - h2). Lines are
  // straight in triangles of side d: they are off by up to d2/8 times the curvature of E over its slope, here below d2
  // / h.
  constexpr double h = 2, I = 1000, d = 0.1;
  const std::size_t n = 61;
  std::vector<PlanPoint> points;
  std::vector<double> lux;
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i) {
      points.push_back({-3 + d * static_cast<double>(i), -3 + d * static_cast<double>(j)});
      const double r2 = points.back().x * points.back().x + points.back().y * points.back().y;
      lux.push_back(I * h / std::pow(h * h + r2, 1.5));
    }
  const auto lines = isolux_lines(lattice_of(points, lux).value(), {50, 100, 200});
  ASSERT_EQ(lines.size(), 3u) << "each closed and in one";
  for (const Plan::Isolux& line : lines) {
    const double radius = std::sqrt(std::pow(I * h / line.lux, 2.0 / 3) - h * h);
    EXPECT_EQ(line.line.front().x, line.line.back().x);
    for (const PlanPoint& p : line.line) EXPECT_NEAR(std::hypot(p.x, p.y), radius, d * d / h) << line.lux << " lx";
  }
}

TEST(Isolux, LevelsAreThoseOfStandardsOrEvenSteps) {
  EXPECT_EQ(isolux_levels(85, 1689), (std::vector<double>{100, 150, 200, 300, 500, 750, 1000, 1500}));
  EXPECT_EQ(isolux_levels(329, 616), (std::vector<double>{350, 400, 450, 500, 550, 600}));
  EXPECT_TRUE(isolux_levels(0, 0).empty());
  EXPECT_TRUE(isolux_levels(5, 5).empty());
  EXPECT_LE(isolux_levels(1e-9, 1e9).size(), 8u);
}

Plan small_plan() {
  Plan plan;
  plan.title = "<script>alert(1)</script>";
  plan.high = {2, 1};
  plan.lattice = Lattice{{0.5, 0.5}, {1, 0}, {0, 1}, 2, 1, {100, 200}};
  plan.isolux = {{150, {{1, 0}, {1, 1}}}};
  plan.luminaires = {{{1, 0.5}, "a \"lamp\" & more"}};
  plan.lowest = 100, plan.highest = 200;
  return plan;
}

std::size_t times(const std::string& words, const std::string& page) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = page.find(words, at)) != page.npos; ++at) ++n;
  return n;
}

TEST(PlanSvg, HasACellAPointALineALevelAndNamesThatCannotHarm) {
  const std::string svg = svg_of(small_plan(), 3);
  EXPECT_EQ(times("M0 0h1v1h-1z", svg), 1u) << svg;
  EXPECT_EQ(times("M1 0h1v1h-1z", svg), 1u) << svg;
  EXPECT_EQ(times("<path class=\"isolux\"", svg), 1u) << svg;
  EXPECT_EQ(times(">150</text>", svg), 2u) << "its label and the legend's middle " << svg;
  EXPECT_EQ(times("<script", svg), 0u) << svg;
  EXPECT_EQ(times("a &quot;lamp&quot; &amp; more", svg), 1u) << svg;
  EXPECT_EQ(times(">0.5 m</text>", svg), 1u) << svg;
  EXPECT_EQ(times("nan", svg) + times("inf", svg), 0u) << svg;
}

TEST(PlanSvg, DrawsCellsOfOneColourAsOne) {
  Plan plan = small_plan();
  plan.lattice->value = {150, 150};
  EXPECT_EQ(times("M0 0h2v1h-2z", svg_of(plan, 1)), 1u);
}

}  // namespace
}  // namespace clerestory
