// clerestory solve --check, as a user runs it.

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

struct Checked {
  ProgramRun run;
  Json report;
  Json law(const std::string& name) const {
    for (const Json& law : report.value("laws", Json::array()))
      if (law["law"] == name) return law;
    ADD_FAILURE() << "no law " << name;
    return {};
  }
};

Checked check(const TempFolder& folder, const std::string& scene, std::vector<std::string> options) {
  options.insert(options.begin(), {"solve", scene, "-o", folder / "out.vtp", "--accuracy", "draft", "--no-error",
                                   "--report", folder / "report.json"});
  Checked checked{run_program(options), {}};
  checked.report = Json::parse(read_text(folder / "report.json"));
  return checked;
}

TEST(CheckLaws, HoldInEachRoomAndAreReportedByRoom) {
  const TempFolder folder;
  for (const std::string method : {"hierarchical", "gauss-seidel", "progressive", "path", "particles"}) {
    SCOPED_TRACE(method);
    const Checked c = check(folder, shipped_scene("furnace.json"), {"--check", "--method", method});
    EXPECT_EQ(c.run.exit_code, 0) << c.run.err;
    ASSERT_EQ(c.report["laws"].size(), 5u);
    const bool has_factors = method == "hierarchical" || method == "gauss-seidel";
    for (const Json& law : c.report["laws"]) {
      const bool is_of_factors = law["law"] == "reciprocity" || law["law"] == "row_sums";
      EXPECT_EQ(law.contains("not_checked"), is_of_factors && !has_factors) << law;
      if (law.contains("not_checked")) continue;
      EXPECT_TRUE(law["holds"]) << law;
      EXPECT_EQ(law["spaces"].size(), law["law"] == "energy" ? 3u : 2u) << "two rooms, and the whole scene";
    }
    EXPECT_EQ(c.run.out.find("not checked for " + method) != std::string::npos, !has_factors) << c.run.out;
    EXPECT_NE(c.run.out.find("no light lost or made: holds"), std::string::npos) << c.run.out;
  }
}

TEST(CheckLaws, LightThatIsNotKeptIsNamedWithItsRoomAndIsExitCode4) {
  // A lamp of 1 mm, 10 mm below the ceiling: no element of a draft is as small as its spot.
  const TempFolder folder;
  folder.write(
      "room.obj",
      "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 4 0 3\nv 4 4 3\nv 0 4 3\n"
      "v 2 2 2.99\nv 2 2.001 2.99\nv 2.001 2.001 2.99\nv 2.001 2 2.99\n"
      "usemtl wall\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\nusemtl lamp\nf 9 10 11 12\n");
  folder.write("scene.json",
               R"({"geometry": [{"file": "room.obj"}],
                 "materials": {"wall": {"reflectance": 0}, "lamp": {"reflectance": 0, "luminous_flux": 1000}}})");
  const Checked c = check(folder, folder / "scene.json", {"--check"});
  EXPECT_EQ(c.run.exit_code, 4);
  EXPECT_NE(c.run.err.find("there is more or less light than was sent there (energy)"), std::string::npos) << c.run.err;
  const Json energy = c.law("energy");
  EXPECT_FALSE(energy["holds"]);
  EXPECT_NE(c.run.err.find("in '" + energy["worst"]["name"].get<std::string>() + "'"), std::string::npos) << c.run.err;
  EXPECT_GT(energy["worst"]["worst"], energy["worst"]["bound"]);
}

TEST(CheckLaws, CostNothingAndSayNothingUnlessAskedForAndLeaveTheResultAsItIs) {
  const TempFolder folder;
  const Checked without = check(folder, shipped_scene("furnace.json"), {});
  const std::string result = read_text(folder / "out.vtp");
  EXPECT_FALSE(without.report.contains("laws"));
  EXPECT_EQ(without.run.out.find("law"), std::string::npos);
  check(folder, shipped_scene("furnace.json"), {"--check"});
  EXPECT_EQ(read_text(folder / "out.vtp"), result);
}

}  // namespace
}  // namespace clerestory
