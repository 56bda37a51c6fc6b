// Every folder beside this file with a case.txt: solved by the program, compared with its rows of the reference.

#include <cmath>
#include <cstdio>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/csv_rows.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;
const fs::path kCases = fs::path(CLERESTORY_SOURCE_DIR) / "tests" / "cases";
const fs::path kReference = fs::path(CLERESTORY_SOURCE_DIR) / ".." / "shared" / "reference";

/// "key value" lines.
std::map<std::string, std::string> read_case(const fs::path& file) {
  std::map<std::string, std::string> out;
  std::istringstream lines(read_text(file));
  for (std::string line; std::getline(lines, line);)
    if (const auto blank = line.find(' '); blank != line.npos) out[line.substr(0, blank)] = line.substr(blank + 1);
  return out;
}

std::vector<std::string> names_of_cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCases))
    if (fs::exists(entry.path() / "case.txt")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Flux [lm] on the surfaces whose names begin with `word`: its mean over them; of all surfaces when it is empty: the
/// sum.
double flux_on(const ResultFile& result, const std::string& word) {
  const auto& names = result.texts.at("surface_names");
  const auto &surface = result.of_cells.at("surface").values, &area = result.of_cells.at("area").values,
             &lux = result.of_cells.at("illuminance").values;
  std::map<std::size_t, double> flux;
  for (std::size_t i = 0; i < area.size(); ++i) {
    const auto s = static_cast<std::size_t>(surface[i]);
    if (names.at(s).starts_with(word)) flux[s] += lux[i] * area[i];
  }
  double sum = 0;
  for (const auto& [s, lumens] : flux) sum += lumens;
  return word.empty() ? sum : sum / static_cast<double>(flux.size());
}

class Case : public testing::TestWithParam<std::string> {};

TEST_P(Case, HoldsItsNumbers) {
  if (!fs::exists(kReference)) GTEST_SKIP() << "no ../shared/reference beside this checkout";
  const auto wanted = read_case(kCases / GetParam() / "case.txt");
  std::vector<test::CsvRow> rows;
  for (auto& row : test::csv_rows(kReference / wanted.at("reference")))
    if (row["case"] == wanted.at("case")) rows.push_back(row);
  ASSERT_FALSE(rows.empty());

  const TempFolder folder;
  std::string points = "x,y,z,nx,ny,nz\n";
  for (auto& row : rows) {
    if (row["x"].empty()) continue;
    for (const char* key : {"x", "y", "z", "nx", "ny"}) points += row[key] + ",";
    points += row["nz"] + "\n";
  }
  std::vector<std::string> arguments{"solve", (kCases / GetParam() / "scene.json").string(), "-o", folder / "out.vtp",
                                     "--quiet"};
  const bool has_points = std::count(points.begin(), points.end(), '\n') > 1;
  if (has_points)
    arguments.insert(arguments.end(),
                     {"--sensors", folder.write("points.csv", points), "--sensors-out", folder / "sensors.csv"});
  const ProgramRun run = run_program(arguments);
  ASSERT_EQ(run.exit_code, 0) << run.err;

  const ResultFile result = read_result(folder / "out.vtp");
  std::vector<test::CsvRow> sensors;
  if (has_points) sensors = test::csv_rows(folder / "sensors.csv");
  const double largest = std::stod(wanted.at("largest"));
  double worst = 0;
  std::size_t next = 0;
  for (auto& row : rows) {
    double value = 0;
    if (!row["x"].empty())
      value = std::stod(sensors.at(next++)["illuminance"]);
    else if (row["unit"] == "lm")
      value = flux_on(result, row["point"]);
    else  // of all flux, of which the case emits 10,000 lm
      value = flux_on(result, "") / 10'000;
    const double off = value / std::stod(row["value"]) - 1;
    worst = std::max(worst, std::abs(off));
    EXPECT_NEAR(off, 0, largest) << row["config"] << ", " << row["point"] << " (" << row["x"] << ", " << row["y"]
                                 << ", " << row["z"] << "): " << value << " for " << row["value"];
  }
  std::printf("%s: worst of %zu rows %.4f %%\n", GetParam().c_str(), rows.size(), 100 * worst);
}
INSTANTIATE_TEST_SUITE_P(All, Case, testing::ValuesIn(names_of_cases()), [](const auto& i) { return i.param; });

}  // namespace
}  // namespace clerestory
