#include "pipeline/tradeoff/tradeoff.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "pipeline/tradeoff/field_error.h"
#include "pipeline/tradeoff/sweep_reference.h"
#include "solver/form_factors/point_to_polygon.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "tests/support/box_scene.h"

namespace clerestory {
namespace {

/// The square [0, 2] x [0, 2] at z = 1 as two triangles that face up, with E = 100 + 10 x + y.
WrittenResult sloping_square() {
  WrittenResult r;
  r.points = {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
  r.triangles = {{0, 1, 2}, {0, 2, 3}};
  for (const Vec3& p : r.points) r.of_points["illuminance"].value.push_back(static_cast<float>(100 + 10 * p.x + p.y));
  return r;
}

ReferencePoint looking(const Vec3& n, const Vec3& p) { return {p, n, 0, 1}; }

TEST(ValuesAt, AreLinearBetweenTheCornersOfTheTriangleBelow) {
  const Vec3 up{0, 0, 1};
  std::vector<ReferencePoint> points;
  for (double x = 0; x <= 2; x += 0.23)
    for (double y = 0; y <= 2; y += 0.31) points.push_back(looking(up, {x, y, 1.0005}));
  const FieldValues found = values_at(points, sloping_square(), 1e-3);
  EXPECT_EQ(found.not_shown, 0u);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(found.E[i], 100 + 10 * points[i].p.x + points[i].p.y, 1e-4);
}

TEST(ValuesAt, AreNoneWhereNothingFacesThatWayOrIsNear) {
  const WrittenResult square = sloping_square();
  const std::vector<ReferencePoint> points = {looking({0, 0, -1}, {1, 1, 1}), looking({1, 0, 0}, {1, 1, 1}),
                                              looking({0, 0, 1}, {1, 1, 1.002}), looking({0, 0, 1}, {2.0009, 1, 1}),
                                              looking({0, 0, 1}, {2.002, 1, 1})};
  const FieldValues found = values_at(points, square, 1e-3);
  EXPECT_EQ(found.not_shown, 4u);
  EXPECT_NEAR(found.E[3], 121, 1e-4) << "a hair beside the rim is the rim";
  for (const std::size_t i : {0u, 1u, 2u, 4u}) EXPECT_EQ(found.E[i], 0) << i;
}

TEST(SweepReference, IsTheClosedFormOfAFurnaceWithinItsOwnErrorAndSharperWithEveryRound) {
  const TempFolder folder;
  const BoxScene box{.offset = {1e5, -2e5, 30}};
  const Scene scene = read_scene(box.write(folder), {});
  Observer nobody;
  SweepReference reference(scene, 1, nobody);
  EXPECT_EQ(reference.rooms().size(), 1u);
  ASSERT_TRUE(reference.add_paths(64, {}));
  const double rough = reference.std_error_of(0);
  for (const int paths : {64, 128, 256, 512}) ASSERT_TRUE(reference.add_paths(paths, {}));
  EXPECT_EQ(reference.paths(), 1024);
  // 16 times the paths: a quarter of the error, or less where stratification helps. Of 400 points, so within 15 %.
  EXPECT_LT(reference.std_error_of(0), rough / 4 * 1.15);
  const double exact = kWhiteEfficacy * box.radiosity();
  double chi2 = 0;
  for (const ReferencePoint& at : reference.points()) {
    chi2 += std::pow((at.E - exact) / at.std_error, 2);
    const Vec3 inside = at.p - box.offset,
               across = {box.size.x - inside.x, box.size.y - inside.y, box.size.z - inside.z};
    EXPECT_LT(std::min({inside.x, inside.y, inside.z, across.x, across.y, across.z}), 1e-6) << "on a wall";
  }
  // Student's t of some 20 degrees of freedom, squared, has mean 1.1 and variance 2.9: five standard errors of 400.
  const auto n = static_cast<double>(reference.points().size());
  EXPECT_NEAR(chi2 / n, 1.1, 5 * std::sqrt(2.9 / n));
}

TEST(SweepReference, FindsTheErrorThatAFieldIsGiven) {
  const TempFolder folder;
  const BoxScene box;
  const Scene scene = read_scene(box.write(folder), {});
  Observer nobody;
  SweepReference reference(scene, 1, nobody);
  ASSERT_TRUE(reference.add_paths(1024, {}));
  const double exact = kWhiteEfficacy * box.radiosity();
  std::vector<double> field;
  for (std::size_t i = 0; i < reference.points().size(); ++i) field.push_back(exact * (i % 2 == 0 ? 1.13 : 0.93));
  const FieldError error = error_of(reference, field);
  // Mean square of 0.13 and -0.07, and their mean; the confidence is what points and paths leave open.
  EXPECT_NEAR(error.worst.rms_relative, std::sqrt((0.13 * 0.13 + 0.07 * 0.07) / 2), 2 * error.worst.confidence);
  EXPECT_LT(error.worst.confidence, 0.01);
  EXPECT_NEAR(error.worst.bias_relative, 0.03, 0.01);
  EXPECT_NEAR(error.worst.p99_relative, 0.13, 0.02);
  EXPECT_FALSE(error.worst.bound);
  const FieldError none = error_of(reference, std::vector<double>(field.size(), exact));
  EXPECT_TRUE(none.worst.bound) << "an error of nothing is not told from the reference's own";
  EXPECT_GT(none.worst.rms_relative, 0);
}

TEST(SweepReference, IsTheFormFactorOfParallelPlates) {
  const Scene scene = read_scene(CLERESTORY_SOURCE_DIR "/data/scenes/parallel_plates.json", {});
  Observer nobody;
  SweepReference reference(scene, 1, nobody);
  ASSERT_TRUE(reference.add_paths(2048, {}));
  const std::vector<Vec3> lower = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  double sum = 0, variance = 0, count = 0;
  for (const ReferencePoint& at : reference.points()) {
    if (at.p.z < 0.5) continue;  // the lower plate glows, and gets back what the upper one reflects
    const double exact = kWhiteEfficacy * 1000 * point_to_polygon(at.p, at.n, lower);
    sum += at.E / exact - 1, variance += std::pow(at.std_error / exact, 2), ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_NEAR(sum / count, 0, 4 * std::sqrt(variance) / count);
}

TEST(SweepReference, GathersTellAnErrorThatFewPathsDoNot) {
  const TempFolder folder;
  const BoxScene box;
  const Scene scene = read_scene(box.write(folder), {});
  Observer nobody;
  SweepReference reference(scene, 1, nobody);
  ASSERT_TRUE(reference.add_paths(64, {}));
  const double exact = kWhiteEfficacy * box.radiosity();
  std::vector<double> field;
  for (std::size_t i = 0; i < reference.points().size(); ++i) field.push_back(exact * (i % 2 == 0 ? 1.01 : 0.99));
  EXPECT_TRUE(error_of(reference, field).worst.bound);
  const double blunt = reference.std_error_of(0);
  ASSERT_TRUE(reference.add_gathers(Accuracy::draft, {}));
  EXPECT_LT(reference.std_error_of(0), blunt / 5);
  for (const ReferencePoint& at : reference.points()) {  // every ray meets the same radiosity: no noise at all
    EXPECT_NEAR(at.gather, exact, 1e-3 * exact);
    EXPECT_NEAR(at.other_gather, exact, 1e-3 * exact);
  }
  const FieldError error = error_of(reference, field);
  EXPECT_FALSE(error.worst.bound);
  EXPECT_NEAR(error.worst.rms_relative, 0.01, 5e-4);
  ASSERT_TRUE(reference.add_paths(64, {})) << "paths go on afterwards";
}

Tradeoff::Row row(const std::string& method, double seconds, double rms) {
  Tradeoff::Row r;
  r.method = method, r.settings = "--accuracy draft", r.space = "room <\"1\">";
  r.wall_s = seconds, r.worst.rms = rms;
  r.said_rms = std::numeric_limits<double>::quiet_NaN();
  return r;
}

Tradeoff four_runs() {
  Tradeoff t;
  t.input = "a & b.json";
  t.rows = {row("quick", 1, 0.08), row("slow", 9, 0.015), row("worse", 10, 0.03), row("middle", 3, 0.03)};
  t.left_out = {{"large", "--accuracy fine", "needs <all> memory"}};
  choose(t);
  return t;
}

TEST(Choose, TakesTheFastestThatKeepsATargetAndMarksWhatNoOtherBeats) {
  const Tradeoff t = four_runs();
  const std::vector<bool> front = {t.rows[0].at_front, t.rows[1].at_front, t.rows[2].at_front, t.rows[3].at_front};
  EXPECT_EQ(front, (std::vector{true, true, false, true}));
  ASSERT_EQ(t.choices.size(), 4u);  // 10, 5, 2, 1 %
  EXPECT_EQ(t.choices[0].row, 0u);
  EXPECT_EQ(t.choices[1].row, 3u);
  EXPECT_EQ(t.choices[2].row, 1u);
  EXPECT_FALSE(t.choices[3].row);
  EXPECT_EQ(choices_as_text(t).back(), "1 %: none of these keeps it");
}

TEST(TradeoffCsv, HasTheColumnsOfTheInterfaceFirstAndARowARun) {
  std::istringstream csv(tradeoff_csv(four_runs()));
  std::string line;
  std::getline(csv, line);
  EXPECT_TRUE(line.starts_with(
      "method,settings,wall_s,cpu_s,peak_bytes,elements,links,rays,rms,median,p95,p99,bias,said_rms,said_p95,"));
  const auto columns = std::count(line.begin(), line.end(), ',');
  std::getline(csv, line);
  EXPECT_EQ(line, "quick,--accuracy draft,1,0,0,0,0,0,0.08,0,0,0,0,nan,0,0,0,0,0,0,0,0,\"room <\"\"1\"\">\"");
  EXPECT_EQ(std::count(line.begin(), line.end(), ','), columns);
  int rows = 1;
  while (std::getline(csv, line)) ++rows;
  EXPECT_EQ(rows, 4);
}

TEST(TradeoffPage, NeedsNothingElseAndShowsNamesAsTheyAre) {
  const std::string page = tradeoff_page(four_runs());
  for (const char* words : {"a &amp; b.json", "room &lt;&quot;1&quot;&gt;", "needs &lt;all&gt; memory", "<svg",
                            "</svg>", "none of these keeps it", "--method quick --accuracy draft"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
  for (const char* words : {"src=", "href=", "@import", "url(", "<script"})
    EXPECT_EQ(page.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace clerestory
