// clerestory solve, from the outside: files, exit codes, promises.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numeric>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "solver/model/units.h"
#include "tests/support/box_scene.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

ProgramRun solve(const std::string& scene, const std::string& output, std::vector<std::string> options = {}) {
  options.insert(options.begin(), {"solve", scene, "-o", output});
  return run_program(options);
}

void expect_all_finite(const std::map<std::string, ResultArray>& arrays) {
  for (const auto& [name, array] : arrays)
    for (const double value : array.values) ASSERT_TRUE(std::isfinite(value)) << name;
}

TEST(Solve, TheResultHasEveryArrayWithItsMeaning) {
  const TempFolder folder;
  const ProgramRun run = solve(shipped_scene("office.json"), folder / "out.vtp", {"--accuracy", "draft"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ResultFile result = read_result(folder / "out.vtp");
  for (const char* name : {"irradiance", "illuminance", "radiosity", "luminance", "daylight_factor"}) {
    ASSERT_EQ(result.of_cells.count(name), 1u) << name;
    ASSERT_EQ(result.of_points.count(name), 1u) << name;
    EXPECT_EQ(result.of_cells.at(name).values.size(), result.triangles.size()) << name;
    EXPECT_EQ(result.of_points.at(name).values.size(), result.points.size()) << name;
  }
  for (const char* name : {"material", "surface", "level", "area"}) ASSERT_EQ(result.of_cells.count(name), 1u) << name;
  expect_all_finite(result.of_cells);
  expect_all_finite(result.of_points);

  const auto& cells = result.of_cells;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const double E = cells.at("irradiance").values[i], lux = cells.at("illuminance").values[i];
    EXPECT_GE(E, 0);
    EXPECT_NEAR(lux, kWhiteEfficacy * E, 1e-5 * lux);
    EXPECT_NEAR(cells.at("daylight_factor").values[i], 100 * lux / 10'000, 1e-5 * lux);
    const auto& [a, b, c] = result.triangles[i];
    const Vec3 normal = cross(result.points[b] - result.points[a], result.points[c] - result.points[a]);
    EXPECT_NEAR(length(normal) / 2, cells.at("area").values[i], 1e-5 * length(normal));
    EXPECT_LT(cells.at("material").values[i], static_cast<double>(result.texts.at("material_names").size()));
    EXPECT_LT(cells.at("surface").values[i], static_cast<double>(result.texts.at("surface_names").size()));
  }
  EXPECT_EQ(result.texts.at("version"), std::vector<std::string>{"0.1.0"});
  EXPECT_EQ(result.texts.at("settings.method"), std::vector<std::string>{"hierarchical"});
  EXPECT_EQ(result.texts.at("settings.accuracy"), std::vector<std::string>{"draft"});
  EXPECT_EQ(result.numbers.at("counts.elements").values, std::vector<double>{double(result.triangles.size())});
}

TEST(Solve, OnlyTheDaylitSceneHasDaylightFactors) {
  const TempFolder folder;
  ASSERT_EQ(solve(shipped_scene("cornell_box.json"), folder / "out.vtp", {"--accuracy", "draft"}).exit_code, 0);
  const ResultFile result = read_result(folder / "out.vtp");
  EXPECT_EQ(result.of_cells.count("daylight_factor"), 0u);
  EXPECT_EQ(result.of_cells.at("irradiance").components, 3);
  EXPECT_EQ(result.of_points.at("radiosity").components, 3);
  EXPECT_EQ(result.of_points.at("luminance").components, 1);
}

TEST(Solve, TheReportHasEveryField) {
  const TempFolder folder;
  const ProgramRun run = solve(shipped_scene("office.json"), folder / "out.vtp",
                               {"--accuracy", "draft", "--report", folder / "report.json", "--seed", "7"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(read_text(folder / "report.json"));
  const auto has = [&](const char* pointer) { return report.contains(Json::json_pointer(pointer)); };
  for (const char* field : {"/version",
                            "/input",
                            "/method",
                            "/settings/accuracy",
                            "/settings/threads",
                            "/counts/triangles",
                            "/counts/elements",
                            "/counts/clusters",
                            "/counts/links",
                            "/counts/rays",
                            "/seconds/read",
                            "/seconds/mesh",
                            "/seconds/build",
                            "/seconds/direct",
                            "/seconds/refine",
                            "/seconds/gather",
                            "/seconds/reconstruct",
                            "/seconds/write",
                            "/seconds/total",
                            "/peak_memory_bytes",
                            "/iterations",
                            "/residual",
                            "/energy/emitted",
                            "/energy/absorbed",
                            "/energy/escaped",
                            "/energy/imbalance",
                            "/error/rms_relative",
                            "/error/p95_relative",
                            "/error/samples",
                            "/error/confidence",
                            "/error/bound",
                            "/error/spaces/0/name",
                            "/error/spaces/0/area",
                            "/error/spaces/0/mean_illuminance",
                            "/error/spaces/0/rms_relative",
                            "/error/spaces/0/median_relative",
                            "/error/spaces/0/p95_relative",
                            "/error/spaces/0/confidence",
                            "/error/spaces/0/samples",
                            "/error/worst/name",
                            "/error_sensors/rms_relative",
                            "/error_sensors/sets/0/name",
                            "/repairs/t_junctions",
                            "/warnings",
                            "/left_out",
                            "/stop"})
    EXPECT_TRUE(has(field)) << field;
  EXPECT_EQ(report["settings"]["seed"], 7);
  EXPECT_EQ(report["stop"], "converged");
  EXPECT_GT(report["peak_memory_bytes"], 1 << 20);
  EXPECT_GT(report["counts"]["rays"], 10'000);
  // What is emitted is absorbed or escapes, as far as the exchanges are known: the share of a bundle of 128 stratified
  // rays that escapes to 128^-3/4 / 2, that of 4,000 elements together to 2e-4. Four times that, rounded up.
  const Json& energy = report["energy"];
  const double emitted = energy["emitted"], absorbed = energy["absorbed"], escaped = energy["escaped"];
  EXPECT_NEAR(absorbed + escaped, emitted, 1e-3 * emitted);
  EXPECT_NEAR(energy["imbalance"].get<double>() * emitted, emitted - absorbed - escaped, 1e-9 * emitted);
}

TEST(Solve, TheHierarchyIsCounted) {
  const TempFolder folder;
  const ProgramRun run = solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
                               {"--accuracy", "draft", "--report", folder / "report.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = Json::parse(read_text(folder / "report.json"));
  const ResultFile result = read_result(folder / "out.vtp");
  const auto& level = result.of_cells.at("level").values;
  EXPECT_EQ(*std::min_element(level.begin(), level.end()), 0);
  EXPECT_GE(*std::max_element(level.begin(), level.end()), 2);
  // A patch and all its halves at level l have 2^l of its area: as many whole patches as sides that took part.
  double patches = 0;
  for (const double l : level) patches += std::exp2(-l);
  const Json& counts = report["counts"];
  EXPECT_EQ(patches, 2 * counts["triangles"].get<double>() - counts["dark_sides"].get<double>());
  EXPECT_EQ(counts["elements"], level.size());
  EXPECT_GT(counts["clusters"], 10);
  EXPECT_GT(counts["links"], counts["elements"]);
}

TEST(Solve, EveryStageIsTimedAndNothingOfConsequenceIsOutsideOfThem) {
  // On a busy machine the program may be made to wait between two stages, in any one run. Work between them would be
  // there in all, so the quietest of some runs tells; mostly it is the first.
  const TempFolder folder;
  double outside = 1;
  for (int run = 0; run < 10 && outside > 0.05; ++run) {
    ASSERT_EQ(solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
                    {"--accuracy", "draft", "--report", folder / "report.json"})
                  .exit_code,
              0);
    const Json seconds = Json::parse(read_text(folder / "report.json"))["seconds"];
    const double total = seconds["total"];
    double sum = 0;
    for (const auto& [stage, time] : seconds.items()) {
      if (stage != "total") sum += time.get<double>();
      EXPECT_GE(time.get<double>(), 0) << stage;
    }
    for (const char* stage : {"read", "mesh", "build", "refine", "gather", "reconstruct", "measure", "write"})
      EXPECT_GT(seconds[stage], 0) << stage;
    EXPECT_LE(sum, total * (1 + 1e-9)) << "stages are parts of the total, of one clock; a rounding of ten digits";
    outside = 1 - sum / total;
  }
  EXPECT_LE(outside, 0.05);
}

TEST(Solve, TheDebugOutputShowsElementsLinksRaysAndErrors) {
  const TempFolder folder;
  const std::string shown = folder / "a/debug";
  const ProgramRun run = solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
                               {"--accuracy", "draft", "--debug-output", shown, "--report", folder / "report.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ResultFile hierarchy = read_result(shown + "/hierarchy.vtp"), links = read_result(shown + "/links.vtp"),
                   rays = read_result(shown + "/rays.vtp"), error = read_result(shown + "/error.vtp");
  for (const ResultFile* file : {&hierarchy, &links, &rays, &error}) {
    expect_all_finite(file->of_cells);
    for (const auto& [name, array] : file->of_cells)
      EXPECT_EQ(array.values.size(), file->triangles.size() + file->lines.size()) << name;
  }

  // All links of all receivers are those the report counts; the ones shown are of the receiver that has the most.
  const auto& receiver = hierarchy.of_cells.at("receiver").values;
  const auto& links_of = hierarchy.of_cells.at("links").values;
  std::map<double, double> by_receiver;
  for (std::size_t i = 0; i < receiver.size(); ++i) by_receiver[receiver[i]] = links_of[i];
  double all = 0, most = 0;
  for (const auto& [number, count] : by_receiver) all += count, most = std::max(most, count);
  EXPECT_EQ(all, Json::parse(read_text(folder / "report.json")).at("counts").at("links").get<double>());
  ASSERT_EQ(static_cast<double>(links.lines.size()), most);
  ASSERT_GT(links.lines.size(), 1u);

  // Weights are shares of the directions around the receiver, in float.
  const auto& weight = links.of_cells.at("weight").values;
  EXPECT_GT(*std::min_element(weight.begin(), weight.end()), 0);
  EXPECT_LE(std::accumulate(weight.begin(), weight.end(), 0.0), 1 + 1e-3);
  EXPECT_GT(*std::max_element(links.of_cells.at("source_radiosity").values.begin(),
                              links.of_cells.at("source_radiosity").values.end()),
            0);

  // The box is open at its front only: most rays land on what is lit.
  ASSERT_EQ(rays.of_cells.count("landed_radiosity"), 1u);
  const auto& landed = rays.of_cells.at("landed_radiosity").values;
  ASSERT_GE(landed.size(), 16u);
  EXPECT_GT(std::count_if(landed.begin(), landed.end(), [](double B) { return B > 0; }), std::ssize(landed) / 4);

  EXPECT_EQ(error.triangles.size(), read_result(folder / "out.vtp").triangles.size());
  for (const char* name : {"interpolation_error", "std_error"})
    for (const double value : error.of_cells.at(name).values) ASSERT_GE(value, 0) << name;
}

TEST(Solve, TheDebugOutputIsRefusedWhereItCannotBe) {
  const TempFolder folder;
  const std::string scene = shipped_scene("cornell_box.json"), out = folder / "out.vtp";
  const ProgramRun other = solve(scene, out, {"--method", "progressive", "--debug-output", folder / "debug"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("progressive"), std::string::npos) << other.err;
  std::ofstream(folder / "file") << "no folder";
  const ProgramRun blocked = solve(scene, out, {"--debug-output", folder / "file/debug"});
  EXPECT_EQ(blocked.exit_code, 3);
  EXPECT_NE(blocked.err.find("name another place"), std::string::npos) << blocked.err;
  const ProgramRun twice = solve(scene, folder / "links.vtp", {"--debug-output", folder / "."});
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_NE(twice.err.find("--debug-output"), std::string::npos) << twice.err;
}

TEST(Solve, ThreadsNeverChangeABit) {
  for (const char* method : {"hierarchical", "progressive", "gauss-seidel", "path", "bidirectional", "particles"}) {
    SCOPED_TRACE(method);
    const TempFolder folder;
    for (const char* threads : {"1", "2", "3"}) {
      const ProgramRun run = solve(shipped_scene("cornell_box.json"), folder / (std::string(threads) + ".vtp"),
                                   {"--threads", threads, "--method", method, "--max-element", "0.1", "--accuracy",
                                    method == std::string("hierarchical") ? "standard" : "draft", "--sensors-out",
                                    folder / (std::string(threads) + ".csv")});
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    EXPECT_GT(read_text(folder / "1.vtp").size(), 10'000u);
    for (const char* other : {"2", "3"}) {
      EXPECT_TRUE(read_text(folder / "1.vtp") == read_text(folder / (std::string(other) + ".vtp"))) << other;
      EXPECT_TRUE(read_text(folder / "1.csv") == read_text(folder / (std::string(other) + ".csv"))) << other;
    }
  }
}

/// Of all surfaces: light does not change with the number of elements, nor with their order.
double luminous_flux(const ResultFile& result) {
  const auto& lux = result.of_cells.at("illuminance").values;
  const auto& area = result.of_cells.at("area").values;
  return std::inner_product(lux.begin(), lux.end(), area.begin(), 0.0);
}

TEST(Solve, AnotherSeedGivesAnotherEstimateOfTheSameLight) {
  const TempFolder folder;
  for (const char* seed : {"1", "2"})
    ASSERT_EQ(solve(shipped_scene("cornell_box.json"), folder / (std::string(seed) + ".vtp"),
                    {"--accuracy", "draft", "--seed", seed})
                  .exit_code,
              0);
  const ResultFile a = read_result(folder / "1.vtp"), b = read_result(folder / "2.vtp");
  EXPECT_NE(a.of_cells.at("illuminance").values, b.of_cells.at("illuminance").values);
  EXPECT_NEAR(luminous_flux(a) / luminous_flux(b), 1, 0.01);
}

TEST(Solve, SensorsComeBackRowByRow) {
  const TempFolder folder;
  const std::string points = folder.write("points.csv",
                                          "x,y,z,nx,ny,nz\n2,1.5,1.25,0,0,1\n1,1,0.5,0,0,-1\n"
                                          "0.10000000000000001,0.2,0.30000000000000004,1,0,0\n");
  const BoxScene box{.rho = 0.5, .M = 10};
  const ProgramRun run = solve(box.write(folder), folder / "out.vtp",
                               {"--sensors", points, "--sensors-out", folder / "out.csv", "--max-element", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  std::istringstream csv(read_text(folder / "out.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "x,y,z,nx,ny,nz,illuminance,irradiance_0");
  std::vector<std::string> rows;
  while (std::getline(csv, line)) rows.push_back(line);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_TRUE(rows[0].starts_with("2,1.5,1.25,0,0,1,")) << rows[0];
  EXPECT_TRUE(rows[1].starts_with("1,1,0.5,0,0,-1,")) << rows[1];
  EXPECT_TRUE(rows[2].starts_with("0.1,0.2,0.30000000000000004,1,0,0,")) << rows[2];
  for (const std::string& row : rows) {
    const double E = std::stod(row.substr(row.rfind(',') + 1));
    EXPECT_NEAR(E, box.radiosity(), 0.01 * box.radiosity()) << "the furnace shines alike from everywhere";
  }
}

TEST(Solve, GreyIsOneChannelOfTheSameLight) {
  const TempFolder folder;
  const std::string scene = shipped_scene("cornell_box.json");
  ASSERT_EQ(solve(scene, folder / "colour.vtp", {"--accuracy", "draft"}).exit_code, 0);
  ASSERT_EQ(solve(scene, folder / "grey.vtp", {"--accuracy", "draft", "--grey"}).exit_code, 0);
  ASSERT_EQ(solve(scene, folder / "one.vtp", {"--accuracy", "draft", "--channels", "1"}).exit_code, 0);
  const ResultFile grey = read_result(folder / "grey.vtp");
  EXPECT_EQ(grey.of_cells.at("irradiance").components, 1);
  EXPECT_EQ(read_text(folder / "grey.vtp"), read_text(folder / "one.vtp"));
  const double in_colour = luminous_flux(read_result(folder / "colour.vtp"));
  EXPECT_NEAR(luminous_flux(grey) / in_colour, 1,
              0.05);  // the product of mean reflectances is not the mean of products
}

TEST(Solve, TheCommandLineWinsOverTheSceneFile) {
  const TempFolder folder;
  BoxScene{}.write(folder);
  const std::string scene =
      folder.write("settings.json",
                   R"({ "geometry": [{ "file": "room.obj" }], "materials": { "wall": { "exitance": 1, "sides": 1 } },
                        "solver": { "method": "jacobi", "accuracy": "draft", "max_element": 1.5, "seed": 5 } })");
  ASSERT_EQ(solve(scene, folder / "file.vtp").exit_code, 0);
  const ResultFile by_file = read_result(folder / "file.vtp");
  EXPECT_EQ(by_file.texts.at("method"), std::vector<std::string>{"jacobi"});
  EXPECT_EQ(by_file.numbers.at("settings.max_element").values, std::vector<double>{1.5});
  EXPECT_EQ(by_file.numbers.at("settings.seed").values, std::vector<double>{5});
  ASSERT_EQ(solve(scene, folder / "line.vtp", {"--method", "gauss-seidel", "--max-element", "1"}).exit_code, 0);
  const ResultFile by_line = read_result(folder / "line.vtp");
  EXPECT_EQ(by_line.texts.at("method"), std::vector<std::string>{"gauss-seidel"});
  EXPECT_EQ(by_line.numbers.at("settings.max_element").values, std::vector<double>{1});
  EXPECT_EQ(by_line.texts.at("settings.accuracy"), std::vector<std::string>{"draft"});
}

TEST(Solve, TheReportHasTheLongestElementAlsoWhenNobodyGaveIt) {
  const TempFolder folder;
  ASSERT_EQ(solve(BoxScene{}.write(folder), folder / "out.vtp", {"--accuracy", "draft"}).exit_code, 0);
  const ResultFile result = read_result(folder / "out.vtp");
  EXPECT_EQ(result.numbers.at("settings.max_element").values, result.numbers.at("repairs.max_element").values);
}

TEST(Solve, QuietSaysNothingAndTheLogSaysAll) {
  const TempFolder folder;
  const std::string scene = BoxScene{}.write(folder);
  const ProgramRun quiet =
      solve(scene, folder / "out.vtp", {"--quiet", "--max-element", "1", "--log", folder / "run.log"});
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
  EXPECT_NE(read_text(folder / "run.log").find("energy"), std::string::npos);
  const ProgramRun normal = solve(scene, folder / "out.vtp", {"--max-element", "1"});
  for (const char* word : {"elements", "energy", "error", "time", "out.vtp"})
    EXPECT_NE(normal.out.find(word), std::string::npos) << word;
}

TEST(TargetError, IsReachedByRefiningOrSaidToBeMissed) {
  const TempFolder folder;
  const ProgramRun easy =
      solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
            {"--grey", "--accuracy", "draft", "--target-error", "0.2", "--report", folder / "r.json"});
  EXPECT_EQ(easy.exit_code, 0) << easy.err;
  EXPECT_LE(Json::parse(read_text(folder / "r.json"))["error"]["rms_relative"], 0.2);
  const ProgramRun hard = solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
                                {"--grey", "--accuracy", "draft", "--target-error", "1e-9", "--time-limit", "3"});
  // Missed whether rounds or the time end first; the limit only keeps the test short.
  EXPECT_EQ(hard.exit_code, 4) << hard.err;
  EXPECT_GT(read_result(folder / "out.vtp").triangles.size(), 0u);
}

TEST(Memory, IsPredictedWithinAFactorOfOneAndAHalf) {
  using Run = std::pair<const char*, const char*>;
  for (const auto& [scene, accuracy] :
       {Run{"cornell_box.json", "draft"}, Run{"cornell_box.json", "standard"}, Run{"cornell_box.json", "fine"},
        Run{"office.json", "draft"}, Run{"house.json", "draft"}}) {
    SCOPED_TRACE(std::string(scene) + ", " + accuracy);
    const TempFolder folder;
    const ProgramRun run =
        solve(shipped_scene(scene), folder / "out.vtp", {"--accuracy", accuracy, "--report", folder / "r.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = Json::parse(read_text(folder / "r.json"));
    const double ratio = report["predicted_memory_bytes"].get<double>() / report["peak_memory_bytes"].get<double>();
    EXPECT_GT(ratio, 1 / 1.5);
    EXPECT_LT(ratio, 1.5);
  }
}

TEST(Memory, StaysBelowALimitWithACoarserResult) {
  const TempFolder folder;
  for (const char* limit : {"38MiB", "60M"}) {  // of which the program itself takes 26
    SCOPED_TRACE(limit);
    // Elements of 10 mm would be some 100,000.
    const ProgramRun run = solve(shipped_scene("cornell_box.json"), folder / "out.vtp",
                                 {"--max-element", "0.01", "--memory-limit", limit, "--report", folder / "r.json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("memory limit"), std::string::npos) << run.err;
    const Json report = Json::parse(read_text(folder / "r.json"));
    EXPECT_LT(report["peak_memory_bytes"], report["settings"]["memory_limit"]);
    EXPECT_GT(report["counts"]["elements"], 1000);
  }
}

TEST(Memory, ALimitBelowWhatTheModelNeedsIsRefused) {
  const TempFolder folder;
  const ProgramRun run = solve(shipped_scene("house.json"), folder / "out.vtp", {"--memory-limit", "28"});
  EXPECT_EQ(run.exit_code, 3);
  for (const char* words : {"needs about", "28.0 MiB", "raise --memory-limit"})
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  const ProgramRun matrix =
      solve(shipped_scene("house.json"), folder / "out.vtp", {"--memory-limit", "100M", "--method", "jacobi"});
  EXPECT_EQ(matrix.exit_code, 3);
  EXPECT_NE(matrix.err.find("--method progressive"), std::string::npos) << matrix.err;
  EXPECT_EQ(folder.listing(), "");
}

TEST(EveryCommand, TakesTheCommonOptions) {
  const std::vector<std::vector<std::string>> commands = {
      {"solve", shipped_scene("parallel_plates.json"), "-o", "out.vtp", "--accuracy", "draft"},
      {"check", shipped_scene("parallel_plates.json")},
      {"mesh", shipped_scene("parallel_plates.json"), "-o", "out.vtp"},
      {"formfactors", shipped_scene("parallel_plates.json"), "-o", "out.csv"}};
  for (auto arguments : commands) {
    SCOPED_TRACE(arguments[0]);
    const TempFolder folder;
    if (arguments.size() > 3) arguments[3] = folder / arguments[3];
    arguments.insert(arguments.end(), {"--threads", "1", "--seed", "7", "--quiet", "--log", folder / "run.log",
                                       "--report", folder / "report.json"});
    const ProgramRun run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out + run.err, "");
    EXPECT_EQ(Json::parse(read_text(folder / "report.json"))["settings"]["threads"], 1);
    EXPECT_GT(read_text(folder / "run.log").size(), 0u);
  }
}

TEST(Check, TellsWhatIsThereAndSolvesNothing) {
  const ProgramRun run = run_program({"check", shipped_scene("house.json")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* word : {"objects", "extent   15.0 x 13.0 x 6.20 m", "material 'parquet': reflectance 0.350",
                           "CIE overcast sky, 10000 lx", "1500 lm", "glazing"})
    EXPECT_NE(run.out.find(word), std::string::npos) << word << " is not in\n" << run.out;
}

TEST(Mesh, WritesPatchesWithTheirQuality) {
  const TempFolder folder;
  const ProgramRun run =
      run_program({"mesh", shipped_scene("house.json"), "-o", folder / "m.vtp", "--max-element", "0.5"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ResultFile patches = read_result(folder / "m.vtp");
  for (const char* name : {"min_angle", "aspect", "longest_edge", "area", "material", "surface"})
    ASSERT_EQ(patches.of_cells.count(name), 1u) << name;
  for (std::size_t i = 0; i < patches.triangles.size(); ++i) {
    EXPECT_LE(patches.of_cells.at("longest_edge").values[i], 0.5 * (1 + 1e-6));
    EXPECT_LE(patches.of_cells.at("min_angle").values[i], 60 + 1e-3);
    EXPECT_GE(patches.of_cells.at("aspect").values[i], 2 / std::sqrt(3) - 1e-3);
  }
  // The meshes of patches share their vertices, so points are fewer than half of the triangles' corners.
  EXPECT_LT(patches.points.size(), 3 * patches.triangles.size() / 2);
}

}  // namespace
}  // namespace clerestory
