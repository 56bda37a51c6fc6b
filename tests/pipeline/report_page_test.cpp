#include "pipeline/report/report_page.h"

#include <regex>

#include <gtest/gtest.h>

#include "pipeline/report/plans.h"
#include "pipeline/report/section_lines.h"
#include "solver/model/error.h"
#include "solver/model/patch_set.h"
#include "tests/support/written_sheets.h"

namespace clerestory {
namespace {

const PageFiles kFiles{
    .style = "body { color: #000; }\n", .viewer = "", .viewer_licence = "", .why_no_viewer = "three.js is not there"};

double slope(double x, double y) { return 100 * x + 30 * y; }

/// 5 x 4 points, 0.5 m apart, at 1 m, with illuminances 0, 10, 20 ...
MeasuredSensors desk(const std::string& name, const Vec3& at = {}) {
  MeasuredSensors sensors;
  sensors.set.name = name;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i) {
      sensors.set.points.push_back({at + Vec3{0.5 * i, 0.5 * j, 1}, {0, 0, 1}});
      sensors.illuminance.push_back(10.0 * (5 * j + i));
    }
  return sensors;
}

std::size_t times(const std::string& words, const std::string& page) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = page.find(words, at)) != page.npos; ++at) ++n;
  return n;
}

std::ptrdiff_t numbers_that_are_none(const std::string& page) {
  static const std::regex none("\\b(nan|inf)\\b");
  return std::distance(std::sregex_iterator(page.begin(), page.end(), none), {});
}

std::string page_of(const WrittenResult& result, const ReportTargets& targets = {}, RunReport run = {}) {
  run.input = "folder/house.json";
  return report_page(result, run, kFiles, targets);
}

TEST(ReportPage, SaysWhatTheResultHas) {
  WrittenResult r = written_sheets(4, slope);
  r.around.sensors = {desk("desk")};
  r.around.daylight_reference = 10'000;
  RunReport run;
  run.luminaires = {{"file", "lamps/pendant.ies", "east", 3, 2700, 0, 0, 0}};
  run.energy = {100, 60, 40};
  run.warnings = {"look out"};
  const std::string page = page_of(r, {}, run);
  for (const char* words :
       {"<h1>house.json</h1>", "<td class=\"words\">room 1</td><td>2.00</td><td>315</td><td>200</td><td>430</td>",
        "<td class=\"words\">sheet 3</td><td>1.00</td><td>365</td><td>300</td><td>430</td>",
        "<td class=\"words\">desk</td><td>20</td><td>95.0</td><td>0</td><td>190</td><td>95.0</td><td>0.00</td>",
        "pendant.ies", "<td>3</td><td>900</td><td>2,700</td>", "60.00 W, 60.0 %", "look out", "paper", "<svg",
        "made without the 3D view", "0.950 %"})
    EXPECT_GT(times(words, page), 0u) << words;
  EXPECT_EQ(page, page_of(r, {}, run)) << "equal results make equal bytes";
}

TEST(ReportPage, HoldsSensorsAgainstTheNearestTarget) {
  WrittenResult r = written_sheets(1, slope);
  r.around.sensors = {desk("desk"), desk("floor"), desk("shelf")};
  r.around.sensors[2].set.threshold = 50;
  const auto row = [](const char* name, const char* target, const char* share) {
    return std::string("<td class=\"words\">") + name +
           "</td><td>20</td><td>95.0</td><td>0</td><td>190</td><td>95.0</td><td>0.00</td><td>" + target + "</td><td>" +
           share + "</td>";
  };
  std::string page = page_of(r);
  EXPECT_EQ(times(row("desk", "", ""), page), 1u);
  EXPECT_EQ(times(row("shelf", "50.0", "75.0 %"), page), 1u) << "its own threshold: 15 of 20 points";
  page = page_of(r, {100, {{"floor", 150}}});
  EXPECT_EQ(times(row("desk", "100", "50.0 %"), page), 1u);
  EXPECT_EQ(times(row("floor", "150", "25.0 %"), page), 1u);
  EXPECT_EQ(times(row("shelf", "100", "50.0 %"), page), 1u);
  EXPECT_EQ(times("class=\"missed\"", page), 3u);
}

TEST(ReportPage, RefusesATargetOfSensorsThatAreNotThere) {
  WrittenResult r = written_sheets(1, slope);
  const auto message = [&](const ReportTargets& targets) -> std::string {
    try {
      page_of(r, targets);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message({{}, {{"desk", 500}}}).find("has no sensors"), std::string::npos);
  r.around.sensors = {desk("desk height")};
  EXPECT_NE(message({{}, {{"desk hight", 500}}}).find("did you mean 'desk height'?"), std::string::npos);
  EXPECT_EQ(message({500, {}}), "");
}

TEST(ReportPage, TakesNamesForWordsAndNeverForMarkup) {
  const std::string evil = "\"><script>alert('&')</script>\xff";
  WrittenResult r = written_sheets(2, slope);
  r.surfaces[0] = r.rooms[0] = r.materials[0].name = evil;
  r.around.sensors = {desk(evil)};
  r.around.luminaires = {{{1, 1, 2}, evil, evil, 100}};
  RunReport run = new_report(evil);
  run.luminaires = {{"file", evil, evil, 1, 1, 0, 0, 0}};
  run.settings = {{evil, evil}};
  run.warnings = run.left_out = {evil};
  run.spaces = {{evil, evil, 1, 1, 1}};
  run.not_read = {{evil, 1, evil}};
  run.error = RunReport::Error{};
  run.error_spaces = {{evil, 1, 1, {}}};
  run.worst_space = 0;
  run.method = evil;
  PageFiles files = kFiles;
  files.viewer = "start();";
  files.viewer_licence = evil;
  const std::string page = report_page(r, run, files, {});
  EXPECT_EQ(times("<script>alert", page), 0u);
  EXPECT_EQ(times("\xff", page), 0u);
  EXPECT_GE(times("&quot;&gt;&lt;script&gt;alert('&amp;')&lt;/script&gt;?", page), 12u);
  EXPECT_EQ(times("<script", page), 10u) << "the viewer, and the nine parts of its data";
}

TEST(ReportPage, HasASliderALayerAndWhatItMoves) {
  WrittenResult r = written_sheets(2, slope);
  r.around.sensors = {desk("desk", {0, 0, 0.5})};
  r.around.layers = {{.name = "lamps", .energy = {}}, {.name = "sky", .energy = {}}};
  r.around.sensors[0].layers = Field(20, 2);
  for (const char* layer : {"lamps", "sky"}) {
    r.of_points[of_layer("illuminance", layer)] = r.of_points["illuminance"];
    for (float& lux : r.of_points[of_layer("illuminance", layer)].value) lux /= 2;
  }
  PageFiles files = kFiles;
  EXPECT_EQ(times("id=\"layers\"", report_page(r, {}, files, {})), 0u) << "without a script nothing moves them";
  files.viewer = "start();";
  const std::string page = report_page(r, {}, files, {});
  for (const char* words : {"id=\"layers\"", "name=\"lamps\" min=\"0\"", "name=\"sky\" min=\"0\"", "data-plan=\"1\"",
                            "id=\"plan-1-light\"", "\"name\":\"desk\",\"columns\":5,\"rows\":4,\"set\":0"})
    EXPECT_EQ(times(words, page), 1u) << words;
  EXPECT_EQ(times("This light was mixed", page), 0u);
  r.around.layers[1].factor = 0.25;
  EXPECT_EQ(times("This light was mixed. Of what was solved it has sky at 25.0 %.", page_of(r)), 1u);
}

TEST(ReportPage, AsksForNothingThatIsElsewhere) {
  WrittenResult r = written_sheets(2, slope);
  r.around.sensors = {desk("desk")};
  const std::string page = page_of(r);
  EXPECT_EQ(times("http", page), times("http-equiv", page)) << "the rule that forbids it";
  EXPECT_EQ(times("default-src 'none'", page), 1u);
  for (const char* words : {"<link", "<iframe", "@import"}) EXPECT_EQ(times(words, page), 0u) << words;
  EXPECT_FALSE(std::regex_search(page, std::regex("(src|href)=\"[^#]|url\\([^#]")));
}

TEST(ReportPage, OfTenThousandSurfacesStaysReadable) {
  const std::string page = page_of(written_sheets(10'000, slope));
  EXPECT_LT(page.size(), 400'000u);
  EXPECT_EQ(times("and 4,940 more rooms</td><td>9,880</td>", page), 1u);
}

TEST(ReportPage, IsMadeOfWhateverThereIs) {
  WrittenResult r = written_sheets(
      2, [](double, double) { return 0.0; }, 3);  // dark
  EXPECT_EQ(times("<svg", page_of(r)), 1u);
  r.room.clear(), r.rooms.clear();
  EXPECT_EQ(times("<td class=\"words\">scene</td>", page_of(r)), 1u);
  r = written_sheets(3, slope, 3, {5e6, -4e6, 300});
  std::string page = page_of(r);
  EXPECT_EQ(times("At 300 m", page), 1u);
  EXPECT_EQ(numbers_that_are_none(page), 0);
  r.around.sensors = {desk("one")};
  r.around.sensors[0].set.points.resize(1), r.around.sensors[0].illuminance.resize(1);
  page = page_of(r);
  EXPECT_EQ(times("<circle", page), 1u) << "a point that is no grid is a dot";
  EXPECT_EQ(numbers_that_are_none(page), 0);
  r.around.sensors[0].set.points.clear(), r.around.sensors[0].illuminance.clear();
  EXPECT_EQ(times("At 300 m", page_of(r)), 1u) << "sensors without points are none";
}

TEST(Plans, StandWhereTheGridIs) {
  WrittenResult r = written_sheets(1, slope, 1, {5e6, -4e6, 0});
  // A wall at y = 0.3, from the floor to 2 m, and a pane before it.
  r.points.insert(r.points.end(), {{5e6, -4e6 + 0.3, 0}, {5e6 + 2, -4e6 + 0.3, 0}, {5e6, -4e6 + 0.3, 2}});
  r.triangles.push_back({4, 5, 6});
  r.materials.resize(2);
  r.materials[1].kind = MaterialKind::glass;
  r.around.panes = {{{Vec3{5e6, -4e6 + 1, 0}, {5e6 + 2, -4e6 + 1, 0}, {5e6, -4e6 + 1, 2}}, 1, 0}};
  r.around.luminaires = {{{5e6 + 1, -4e6 + 1, 2.5}, "near", "", 1},
                         {{5e6 + 1, -4e6 + 1, 0.2}, "below", "", 1},
                         {{5e6 + 90, -4e6 + 1, 2.5}, "far", "", 1}};
  const Plan plan = plan_of(r, desk("desk", {5e6, -4e6, 0}), 100.0);
  ASSERT_TRUE(plan.lattice);
  EXPECT_EQ(plan.lattice->columns, 5u);
  ASSERT_EQ(plan.walls.size(), 1u);
  ASSERT_EQ(plan.walls[0].size(), 2u);
  const double left = std::min(plan.walls[0][0].x, plan.walls[0][1].x);
  EXPECT_NEAR(left, plan.lattice->origin.x, 1e-6);
  EXPECT_NEAR(std::abs(plan.walls[0][0].x - plan.walls[0][1].x), 1, 1e-6) << "half as wide half way up";
  EXPECT_NEAR(plan.walls[0][0].y, plan.lattice->origin.y + 0.3, 1e-6);
  EXPECT_EQ(plan.panes.size(), 1u);
  ASSERT_EQ(plan.luminaires.size(), 1u);
  EXPECT_EQ(plan.luminaires[0].name, "near");
}

TEST(Plans, OfGridsOnWallsAreSeenFromTheFront) {
  MeasuredSensors wall;
  wall.set.name = "wall";
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 4; ++i) {
      wall.set.points.push_back({{2, 0.5 * i, 0.5 * k}, {1, 0, 0}});
      wall.illuminance.push_back(100 * i + k);
    }
  const Plan plan = plan_of(written_sheets(1, slope), wall, {});
  ASSERT_TRUE(plan.lattice);
  EXPECT_EQ(plan.lattice->columns, 4u);
  EXPECT_EQ(plan.lattice->rows, 3u);
  // Looking along -x, y goes to the right; z goes up.
  EXPECT_EQ(plan.lattice->value[1], 100);
  EXPECT_EQ(plan.lattice->value[4], 1);
}

TEST(Plans, OfFloorsHaveTheLightOfTheFloor) {
  WrittenResult r = written_sheets(4, slope);
  r.rooms[1] = kOutdoors;
  const auto floors = floor_plans(r, 3);
  ASSERT_EQ(floors.size(), 1u);
  EXPECT_NEAR(floors[0].area, 2, 1e-9) << "without the outdoors";
  const Lattice& raster = *floors[0].plan.lattice;
  for (const std::size_t column : {std::size_t{0}, raster.columns / 3, raster.columns - 1})
    EXPECT_NEAR(raster.value[column], 200.0 * static_cast<double>(column) / static_cast<double>(raster.columns - 1),
                1e-3);
}

TEST(SectionLines, AreJoinedAndStraight) {
  // A wall of ten pieces is one line of two points.
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t i = 0; i <= 10; ++i)
    for (const double z : {0.0, 3.0}) points.push_back({static_cast<double>(i), 2, z});
  for (std::uint32_t i = 0; i < 20; i += 2)
    triangles.push_back({i, i + 2, i + 3}), triangles.push_back({i, i + 3, i + 1});
  const auto lines = section_lines(points, triangles, {0, 0, 1}, {0, 0, 1});
  ASSERT_EQ(lines.size(), 1u);
  ASSERT_EQ(lines[0].size(), 2u);
  EXPECT_NEAR(std::abs(lines[0][0].x - lines[0][1].x), 10, 1e-6);
  EXPECT_TRUE(section_lines(points, triangles, {0, 0, 5}, {0, 0, 1}).empty());
}

}  // namespace
}  // namespace clerestory
