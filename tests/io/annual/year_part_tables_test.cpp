// A part of a year: what merge reads is what was written, and what does not fit together is refused.

#include "io/annual/year_part_tables.h"

#include <cmath>
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "io/annual/file_digest.h"
#include "solver/model/error.h"
#include "tests/support/small_result.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

WrittenResult one_quad() {
  WrittenResult result = empty_result();
  add_quad(result, square_at(0), 1, 100);
  return result;
}

/// The middle two of the four points of one_quad(), one sensor of two, a diffuser.
YearPart middle_part() {
  YearPart part;
  part.part = 2, part.parts = 3;
  part.facts.scene = "a.json", part.facts.schedule = "8-18", part.facts.occupied_hours = 3650;
  part.facts.threshold = 1.0 / 3, part.facts.error_grids.total = 0.1;
  part.facts.rooms = {{"R1", 3, {}, {12, 3}}};
  part.facts.grids = {{"desk", 2, {}, {}, false}};
  part.more_thresholds = {500, 0.7};
  part.files = {{"a.obj", "0123456789abcdef"}};
  part.rooms = {{{0, 2, 3}, {0.1, 0.2, 0.7}}};
  part.grids = {{{0, 1}, {1, 1}}};
  part.sensors = {{{1, 2, 3}, {0, 0, 1}}, {{4, 5, 6}, {0, 1, 0}}};
  part.origin = {1e6, 0, 0.1};
  part.position = std::vector<Vec3>(4, {0.1, 0.2, 0.3});
  part.patch_of_point = {0, 0, 1, 1};
  part.rho = Field(2, 1), part.tau = Field(2, 1);
  part.rho.value = {0.3, 0.1}, part.tau.value = {0.5, 0.7};
  part.behind_begin = {0, 1, 2}, part.behind_patch = {1, 0}, part.behind_share = {1.0 / 3, 1};
  part.first_point = 1, part.first_sensor = 1;
  PointYear year;
  year.DA = 1, year.DA_low = 2, year.DA_high = 3, year.UDI_lit = 4, year.UDI_upper = 5, year.ASE = 6, year.ASE_low = 7;
  year.ASE_high = 8, year.EN17037 = {9, 10, 11, 8760}, year.at_least = {12, 13, 14, 15};
  year.cDA = 1.0 / 3, year.lux_hours = 1e7 / 3;
  part.of_points = {year, {}}, part.of_sensors = {year};
  return part;
}

TEST(YearPartTables, ReadBackTheSameNumbers) {
  WrittenResult result = one_quad(), again = one_quad();
  add_year_part(middle_part(), result);
  const YearPart read = year_part_of(result);
  add_year_part(read, again);
  EXPECT_EQ(again.year_part, result.year_part);
  ASSERT_EQ(again.year_tables.size(), result.year_tables.size());
  for (const auto& [name, table] : result.year_tables) {
    EXPECT_EQ(again.year_tables[name].value, table.value) << name;
    EXPECT_FALSE(table.value.empty()) << name;
  }
  EXPECT_EQ(read.part, 2u);
  EXPECT_EQ(read.of_points[0].EN17037[3], 8760);
  EXPECT_EQ(read.of_points[0].lux_hours, 1e7 / 3);
  EXPECT_EQ(read.facts.threshold, 1.0 / 3);
  EXPECT_TRUE(read.facts.rooms[0].has_area);
  EXPECT_FALSE(read.facts.grids[0].has_area);
  EXPECT_EQ(read.facts.rooms[0].blinds.hours_not_complying, 3);
}

TEST(YearPartTables, OfAResultThatIsNoPartAreRefused) { EXPECT_THROW(year_part_of(one_quad()), InputError); }

TEST(YearPartTables, APartIsNoWholeYear) {
  WrittenResult result = one_quad();
  EXPECT_NO_THROW(require_whole_year(result));
  add_year_part(middle_part(), result);
  EXPECT_THROW(require_whole_year(result), InputError);
}

TEST(YearPartTables, ThatDoNotFitTogetherAreRefused) {
  const std::pair<const char*, std::function<void(WrittenResult&)>> damages[] = {
      {"no table", [](WrittenResult& r) { r.year_tables.erase("rho"); }},
      {"of three colours",
       [](WrittenResult& r) {
         r.year_tables["rho"] = {3, {1, 1, 1, 1, 1, 1}};
       }},
      {"cut short", [](WrittenResult& r) { r.year_tables["position"].value.resize(9); }},
      {"a point beyond the last", [](WrittenResult& r) { r.year_tables["rooms"].value[0] = 4; }},
      {"a point that stands for nothing", [](WrittenResult& r) { r.year_tables["rooms"].value[1] = 0; }},
      {"a point that stands for no number", [](WrittenResult& r) { r.year_tables["grids"].value[1] = std::nan(""); }},
      {"a reflectance above 1", [](WrittenResult& r) { r.year_tables["rho"].value[0] = 1.5; }},
      {"endless light", [](WrittenResult& r) { r.year_tables["hours_of_points"].value.back() = HUGE_VAL; }},
      {"a part of a billion",
       [](WrittenResult& r) {
         r.year_part.replace(r.year_part.find("\"parts\":3"), std::strlen("\"parts\":3"), "\"parts\":1000000000");
       }},
      {"more hours with light than a year has",
       [](WrittenResult& r) {
         r.year_part.replace(r.year_part.find("\"lit_hours\":0"), std::strlen("\"lit_hours\":0"),
                             "\"lit_hours\":1e300");
       }},
      {"half a point", [](WrittenResult& r) { r.year_tables["rooms"].value[0] = 0.5; }},
      {"fewer points than the room has", [](WrittenResult& r) { r.year_tables["rooms"].value.resize(4); }},
      {"more hours than a year has", [](WrittenResult& r) { r.year_tables["hours_of_points"].value[0] = 8761; }},
      {"part 4 of 3", [](WrittenResult& r) { r.year_tables["place"].value[0] = 4; }},
      {"part 0", [](WrittenResult& r) { r.year_tables["place"].value[0] = 0; }},
      {"points behind the last", [](WrittenResult& r) { r.year_tables["place"].value[1] = 3; }},
      {"patches behind that go back",
       [](WrittenResult& r) {
         r.year_tables["behind_begin"].value = {2, 1, 2};
       }},
      {"cut text", [](WrittenResult& r) { r.year_part.resize(20); }},
      {"a text of something else", [](WrittenResult& r) { r.year_part = "{ \"parts\": \"many\" }"; }}};
  for (const auto& [what, damage] : damages) {
    WrittenResult result = one_quad();
    add_year_part(middle_part(), result);
    damage(result);
    EXPECT_THROW(year_part_of(result), InputError) << what;
  }
}

TEST(FileDigest, IsThatOfThePublishedExamples) {
  // Test values of RFC 9923: FNV-1a, 64 bits, of "", "a" and "foobar".
  const TempFolder folder;
  EXPECT_EQ(file_digest(folder.write("empty", "")), "cbf29ce484222325");
  EXPECT_EQ(file_digest(folder.write("a", "a")), "af63dc4c8601ec8c");
  EXPECT_EQ(file_digest(folder.write("foobar", "foobar")), "85944171f73967e8");
  EXPECT_THROW(file_digest(folder / "missing"), InputError);
}

}  // namespace
}  // namespace clerestory
