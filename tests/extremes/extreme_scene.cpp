#include "tests/extremes/extreme_scene.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/csv_rows.h"

namespace clerestory::test {

std::map<std::string, Outcome::Mean> Outcome::by_surface() const {
  const auto& names = result.texts.at("surface_names");
  const auto &surface = result.of_cells.at("surface").values, &area = result.of_cells.at("area").values,
             &E = result.of_cells.at("irradiance").values;
  const auto std_error = result.of_cells.find("irradiance_std_error");
  std::map<std::string, Mean> means;
  std::map<std::string, double> areas;
  for (std::size_t i = 0; i < E.size(); ++i) {
    const std::string& name = names.at(static_cast<std::size_t>(surface[i]));
    means[name].E += area[i] * E[i], areas[name] += area[i];
    if (std_error != result.of_cells.end()) means[name].std_error += std::pow(area[i] * std_error->second.values[i], 2);
  }
  for (auto& [name, mean] : means) mean.E /= areas[name], mean.std_error = std::sqrt(mean.std_error) / areas[name];
  return means;
}

double Outcome::largest() const { return *std::ranges::max_element(result.of_cells.at("irradiance").values); }

Outcome solve_extreme(const std::string& obj, const std::string& rest, const std::vector<std::string>& options,
                      const std::string& sensors) {
  const TempFolder folder;
  folder.write("model.obj", obj);
  const std::string scene = folder.write("scene.json", R"({"geometry": [{"file": "model.obj"}], )" + rest + "}");
  std::vector<std::string> arguments{"solve", scene, "-o", folder / "out.vtp", "--quiet", "--check", "--no-error"};
  if (std::ranges::find(options, "--accuracy") == options.end())
    arguments.insert(arguments.end(), {"--accuracy", "draft"});
  arguments.insert(arguments.end(), options.begin(), options.end());
  if (!sensors.empty())
    for (const std::string& a : {std::string("--sensors"), folder.write("points.csv", sensors),
                                 std::string("--sensors-out"), folder / "sensors.csv"})
      arguments.push_back(a);
  Outcome outcome;
  outcome.run = run_program(arguments);
  if (outcome.run.exit_code != 0 && outcome.run.exit_code != 4) return outcome;
  outcome.result = read_result(folder / "out.vtp");
  if (!sensors.empty())
    for (const auto& row : csv_rows(folder / "sensors.csv"))
      outcome.sensors_lux.push_back(std::stod(row.at("illuminance")));
  return outcome;
}

void expect_sound(const Outcome& outcome) {
  EXPECT_EQ(outcome.run.exit_code, 0) << outcome.run.err;
  for (const auto* arrays : {&outcome.result.of_cells, &outcome.result.of_points})
    for (const auto& [name, array] : *arrays)
      for (const double value : array.values) ASSERT_TRUE(std::isfinite(value) && value >= 0) << name << ' ' << value;
  for (const double lux : outcome.sensors_lux) EXPECT_TRUE(std::isfinite(lux) && lux >= 0) << lux;
}

}  // namespace clerestory::test
