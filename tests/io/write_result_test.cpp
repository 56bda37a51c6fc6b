#include "io/write_result.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include "io/atomic_file.h"
#include "io/write_sensors.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "tests/support/result_file.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

/// One triangle with two sides, of two materials, far from the origin.
struct Sheet {
  PatchSet patches;
  VertexLightmap lightmap;
  Solution solution;
  RunReport report = new_report("sheet.obj");

  explicit Sheet(int channels = 1) {
    patches.origin = {1e6, -2e6, 50};
    patches.channels = channels;
    patches.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
    patches.corners = {{VertexId{std::size_t{0}}, VertexId{std::size_t{1}}, VertexId{std::size_t{2}}}};
    const MaterialId red{std::size_t{0}}, lamp{std::size_t{1}};
    patches.side_material = {{red, lamp}};
    patches.side_surface = {{SurfaceId{std::size_t{0}}, SurfaceId{std::size_t{0}}}};
    patches.materials.resize(2);
    patches.materials[0].name = "red";
    patches.materials[0].reflectance = {0.6, 0.1, 0.2};
    patches.materials[1].name = "lamp";
    patches.materials[1].exitance = Spectrum(30.0);
    patches.surfaces = {"sheet"};
    make_patches(patches, {true, true});
    solution.E = Field(2, channels);
    solution.B = Field(2, channels);
    for (std::size_t i = 0; i < solution.E.value.size(); ++i) solution.E.value[i] = static_cast<double>(i + 1);
    solution.B.value = solution.E.value;
    lightmap.corners = {{0, 1, 2}, {3, 5, 4}};
    lightmap.position = patches.vertices;
    lightmap.position.insert(lightmap.position.end(), patches.vertices.begin(), patches.vertices.end());
    lightmap.patch_of_point = {0, 0, 0, 1, 1, 1};
    lightmap.E = Field(6, channels);
    for (std::size_t i = 0; i < 6; ++i) lightmap.E.set(i, Spectrum(10.0));
  }
};

TEST(WriteResult, ColoursOrientationAndDistanceSurviveTheFile) {
  const TempFolder folder;
  Sheet s(3);
  s.report.settings = {{"method", std::string("progressive")}, {"max_element", 0.25}, {"seed", 7LL}};
  write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {1790.0}, s.report);
  const ResultFile result = read_result(folder / "a.vtp");
  ASSERT_EQ(result.triangles.size(), 2u);
  EXPECT_EQ(result.points[1], (Vec3{1e6 + 3, -2e6, 50})) << "points are double";
  EXPECT_EQ(result.triangles[1], (std::array<std::size_t, 3>{3, 5, 4})) << "the back is wound the other way";
  EXPECT_EQ(result.of_cells.at("irradiance").components, 3);
  EXPECT_EQ(result.of_cells.at("irradiance").values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_NEAR(result.of_cells.at("illuminance").values[0], photometric({1, 2, 3}), 1e-4);
  EXPECT_NEAR(result.of_cells.at("daylight_factor").values[0], 100 * photometric({1, 2, 3}) / 1790, 1e-5);
  EXPECT_EQ(result.of_cells.at("area").values, (std::vector<double>{6, 6}));
  EXPECT_EQ(result.of_cells.at("material").values, (std::vector<double>{0, 1}));
  EXPECT_EQ(result.of_cells.at("level").values, (std::vector<double>{0, 0}));
  // At points B = M + rho E with the material of that side.
  const auto& B = result.of_points.at("radiosity").values;
  EXPECT_NEAR(B[0], 0.6 * 10, 1e-6);
  EXPECT_NEAR(B[1], 0.1 * 10, 1e-6);
  EXPECT_NEAR(B[3 * 3], 30 + 0.5 * 10, 1e-5);
  EXPECT_EQ(result.texts.at("material_names"), (std::vector<std::string>{"red", "lamp"}));
  EXPECT_EQ(result.texts.at("surface_names"), std::vector<std::string>{"sheet"});
  EXPECT_EQ(result.texts.at("settings.method"), std::vector<std::string>{"progressive"});
  EXPECT_EQ(result.numbers.at("settings.max_element").values, std::vector<double>{0.25});
  EXPECT_EQ(result.numbers.at("settings.seed").values, std::vector<double>{7});
}

TEST(WriteResult, ADiffuserShowsTheLightBehindItsOwnPoints) {
  const TempFolder folder;
  Sheet s;
  Material& blind = s.patches.materials[0];
  blind.kind = MaterialKind::diffuser, blind.reflectance = Spectrum(0.5), blind.transmittance = Spectrum(0.25);
  s.patches.side_material[0][kBack] = s.patches.side_material[0][kFront];
  make_patches(s.patches, {true, true});
  for (std::size_t i = 3; i < 6; ++i) s.lightmap.E.set(i, Spectrum(20.0 * static_cast<double>(i)));
  write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {}, s.report);
  const auto B = read_result(folder / "a.vtp").of_points.at("radiosity").values;
  ASSERT_EQ(B.size(), 6u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double behind = 20.0 * static_cast<double>(i + 3);
    EXPECT_NEAR(B[i], 0.5 * 10 + 0.25 * behind, 1e-5);
    EXPECT_NEAR(B[i + 3], 0.5 * behind + 0.25 * 10, 1e-5);
  }
}

TEST(WriteResult, StandardErrorsAndDaylightFactorsOnlyWhereThereAreAny) {
  const TempFolder folder;
  Sheet s;
  write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {}, s.report);
  EXPECT_EQ(read_result(folder / "a.vtp").of_cells.count("daylight_factor"), 0u);
  EXPECT_EQ(read_result(folder / "a.vtp").of_cells.count("irradiance_std_error"), 0u);
  s.solution.std_error = s.solution.E;
  write_result(folder / "b.vtp", s.patches, s.lightmap, s.solution, {}, s.report);
  EXPECT_EQ(read_result(folder / "b.vtp").of_cells.at("irradiance_std_error").values, s.solution.E.value);
}

TEST(WriteResult, NoTimesGoIntoTheFileSoEqualRunsGiveEqualBytes) {
  const TempFolder folder;
  Sheet s;
  s.report.seconds.total = 1;
  s.report.threads = 1;
  write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {}, s.report);
  s.report.seconds.total = 2;
  s.report.threads = 2;
  s.report.peak_memory_bytes = 12345;
  write_result(folder / "b.vtp", s.patches, s.lightmap, s.solution, {}, s.report);
  EXPECT_EQ(read_text(folder / "a.vtp"), read_text(folder / "b.vtp"));
}

TEST(WriteResult, EveryByteIsPlainTextAndSoEveryXmlParserReadsTheFile) {
  const TempFolder folder;
  Sheet s(3);
  s.patches.surfaces = {"B\xc3\xbcro <1> & \"2\""};
  write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {1790.0}, s.report);
  const std::string text = read_text(folder / "a.vtp");
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
  EXPECT_EQ(text.find("AppendedData"), std::string::npos) << "ParaView of Debian 12 refuses it";
  EXPECT_EQ(read_result(folder / "a.vtp").texts.at("surface_names"), s.patches.surfaces);
}

TEST(WriteResult, ANumberThatIsNoneIsRefusedAndTheOldFileStays) {
  const TempFolder folder;
  folder.write("a.vtp", "old");
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e39}) {
    Sheet s;
    s.solution.E.value[1] = bad;
    EXPECT_THROW(write_result(folder / "a.vtp", s.patches, s.lightmap, s.solution, {}, s.report), std::runtime_error);
    Sheet at_point;
    at_point.lightmap.E.value[4] = bad;
    EXPECT_THROW(
        write_result(folder / "a.vtp", at_point.patches, at_point.lightmap, at_point.solution, {}, at_point.report),
        std::runtime_error);
  }
  EXPECT_EQ(read_text(folder / "a.vtp"), "old");
  EXPECT_EQ(folder.listing(), "a.vtp ");
}

TEST(WritePatches, QualityOfARightTriangle) {
  const TempFolder folder;
  const Sheet s;
  write_patches(folder / "a.vtp", s.patches, s.report);
  const ResultFile result = read_result(folder / "a.vtp");
  ASSERT_EQ(result.triangles.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {  // sides 3, 4, 5
    EXPECT_NEAR(result.of_cells.at("min_angle").values[i], 36.8699, 1e-3);
    EXPECT_NEAR(result.of_cells.at("aspect").values[i], 25.0 / 12, 1e-5);
    EXPECT_NEAR(result.of_cells.at("longest_edge").values[i], 5, 1e-5);
  }
}

TEST(WriteSensors, NumbersReadBackAsTheSameNumbers) {
  const TempFolder folder;
  const std::vector<SensorPoint> points = {{{0.1, 1.0 / 3, 1e6 + 0.001}, {0, 0, 1}}, {{-0.0, 2, 3}, {0.6, 0, 0.8}}};
  Field E(2, 3);
  E.set(0, {1.0 / 3, 2.0 / 3, 1e-12});
  write_sensors(folder / "a.csv", points, E);
  const std::string text = read_text(folder / "a.csv");
  EXPECT_TRUE(
      text.starts_with("x,y,z,nx,ny,nz,illuminance,irradiance_0,irradiance_1,irradiance_2\n0.1,0.3333333333333333,"
                       "1000000.001,0,0,1,"))
      << text;
  EXPECT_NE(text.find(",0.3333333333333333,0.6666666666666666,1e-12\n"), std::string::npos) << text;
}

TEST(WriteReport, NamesWithDotsBecomeLevelsAndWhatWasNotMeasuredIsNull) {
  const TempFolder folder;
  RunReport report = new_report("scene \xff.json");  // not UTF-8: must not stop the report
  report.settings = {{"accuracy", std::string("fine")}};
  report.warnings = {"a \"quoted\" warning"};
  write_report(folder / "r.json", report);
  const std::string text = read_text(folder / "r.json");
  for (const char* part : {"\"settings\": {\n    \"accuracy\": \"fine\"", "\"error\": null", "a \\\"quoted\\\" warning",
                           "\"energy\": {", "\"imbalance\": 0.0"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(AtomicFile, AppearsWholeOrNotAtAll) {
  const TempFolder folder;
  folder.write("a.txt", "old");
  {
    AtomicFile file(folder / "a.txt");
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
  }  // not committed
  EXPECT_EQ(read_text(folder / "a.txt"), "old");
  EXPECT_EQ(folder.listing(), "a.txt ");
  write_file(folder / "a.txt", "new");
  EXPECT_EQ(read_text(folder / "a.txt"), "new");
  EXPECT_EQ(folder.listing(), "a.txt ");
}

TEST(AtomicFile, ALinkIsFollowedAndASpecialFileIsWrittenInPlace) {
  const TempFolder folder;
  folder.write("target.txt", "old");
  std::filesystem::create_symlink(folder / "target.txt", folder / "link.txt");
  write_file(folder / "link.txt", "new");
  EXPECT_EQ(read_text(folder / "target.txt"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.txt"));
  EXPECT_NO_THROW(write_file("/dev/null", "nothing"));
  EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
}

TEST(AtomicFile, HasANameThatNobodyCanPrepareALinkFor) {
  const TempFolder folder;
  std::set<std::string> names;
  for (int k = 0; k < 8; ++k) {
    AtomicFile file(folder / "a.txt");
    names.insert(folder.listing());
  }
  EXPECT_EQ(names.size(), 8u);
}

TEST(Outputs, ReplaceNoFileWhenOneOfThemCannotBe) {
  const TempFolder folder;
  folder.write("a.txt", "old");
  {
    Outputs outputs;
    outputs.open(folder / "a.txt").write("new");
    outputs.open(folder / "b.txt").write("new");
    outputs.open(folder / "c.txt").write("new");
    std::filesystem::create_directory(folder / "c.txt");  // came meanwhile
    EXPECT_THROW(outputs.commit(), InputError);
    EXPECT_EQ(read_text(folder / "a.txt"), "old");
    EXPECT_FALSE(std::filesystem::exists(folder / "b.txt"));
  }
  EXPECT_EQ(folder.listing(), "a.txt c.txt ");
  Outputs outputs;
  outputs.open(folder / "a.txt").write("new");
  outputs.open(folder / "b.txt").write("new");
  EXPECT_EQ(read_text(folder / "a.txt"), "old") << "not before commit()";
  outputs.commit();
  EXPECT_EQ(read_text(folder / "a.txt") + read_text(folder / "b.txt"), "newnew");
  EXPECT_EQ(folder.listing(), "a.txt b.txt c.txt ");
}

TEST(Outputs, AreRemovedByWhatSignalHandlersCall) {
  const TempFolder folder;
  Outputs outputs;
  outputs.open(folder / "a.txt"), outputs.open(folder / "b.txt");
  EXPECT_NE(folder.listing(), "");
  EXPECT_TRUE(remove_temporaries());
  EXPECT_EQ(folder.listing(), "");
}

TEST(AtomicFile, PlacesThatCannotBeWrittenAreRefusedWithTheReason) {
  const TempFolder folder;
  folder.write("file", "");
  for (const std::string& place : {folder / "no/file.vtp", folder / "file/inside.vtp", folder / ".", std::string()}) {
    EXPECT_THROW(check_writable(place), InputError) << place;
  }
  EXPECT_NO_THROW(check_writable(folder / "new.vtp"));
  EXPECT_EQ(folder.listing(), "file ") << "the check leaves nothing behind";
}

}  // namespace
}  // namespace clerestory
