#include "tests/cases/solve_case.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory::test {

namespace {

namespace fs = std::filesystem;
constexpr double kEmitted = 10'000;  ///< [lm]

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

double total_area(const ResultFile& result) {
  const auto& area = result.of_cells.at("area").values;
  return std::accumulate(area.begin(), area.end(), 0.0);
}

/// The scene, its models and photometric files, all in one place.
std::string write_scene(const CaseFolder& folder, const std::string& scene, const TempFolder& work) {
  for (const fs::path& from : {folder.path, folder.path.parent_path() / "geometry"}) fs::copy(from, work / "");
  fs::remove(work / "scene.json");
  return work.write("scene.json", scene);
}

bool has_point(const CsvRow& row) { return !row.at("x").empty(); }

std::string points_of(const std::vector<CsvRow>& rows) {
  std::string points = "x,y,z,nx,ny,nz\n";
  for (const CsvRow& row : rows) {
    if (!has_point(row)) continue;
    for (const char* key : {"x", "y", "z", "nx", "ny"}) points += row.at(key) + ",";
    points += row.at("nz") + "\n";
  }
  return points;
}

}  // namespace

std::vector<double> solve_case(const CaseFolder& folder, const CaseScene& scene) {
  const TempFolder work;
  std::vector<std::string> arguments{"solve", write_scene(folder, scene.scene, work), "-o", work / "out.vtp",
                                     "--quiet"};
  if (std::ranges::any_of(scene.rows, has_point))
    arguments.insert(arguments.end(), {"--sensors", work.write("sensors_in.csv", points_of(scene.rows)),
                                       "--sensors-out", work / "sensors_out.csv"});
  const ProgramRun run = run_program(arguments);
  if (run.exit_code != 0) throw std::runtime_error(scene.rows.front().at("config") + ": " + run.err);

  const ResultFile result = read_result(work / "out.vtp");
  const std::vector<CsvRow> sensors = csv_rows(work / "sensors_out.csv");
  const double lux_of_one = folder.number("lux", 1);
  std::vector<double> values;
  std::size_t next = 0;
  for (const CsvRow& row : scene.rows) {
    if (has_point(row))
      values.push_back(std::stod(sensors.at(next++).at("illuminance")) / lux_of_one);
    else if (row.at("unit") == "lm")
      values.push_back(flux_on(result, row.at("point")));
    else if (row.at("quantity") == "E_indirect")
      values.push_back((flux_on(result, "") - kEmitted) / total_area(result));
    else
      values.push_back(flux_on(result, "") / kEmitted);
  }
  return values;
}

}  // namespace clerestory::test
