#include "apps/year_outputs.h"

#include <filesystem>

#include "io/annual/annual_report.h"
#include "io/write_result.h"
#include "io/write_sensors.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::string beside(const std::string& output, const char* extension) {
  return std::filesystem::path(output).replace_extension(extension).string();
}

}  // namespace

std::string YearFiles::areas() const { return beside(output, ".json"); }
std::string YearFiles::sensors() const { return sensors_out.empty() ? beside(output, ".sensors.csv") : sensors_out; }

std::vector<NamedFile> YearFiles::named() const {
  return {{"-o", output},
          {"rooms and grids", areas(), true, "name another -o"},
          {"the sensors' output", sensors(), true, "name another: --sensors-out"}};
}

void YearFiles::check_places(bool has_sensors) const {
  if (!has_sensors && !sensors_out.empty())
    throw InputError(
        "--sensors-out " + sensors_out +
        ": there are no sensors to write; give --sensors POINTS.csv to the run of the year, or \"sensors\" "
        "in the scene file.");
  check_writable(output), check_writable(areas());
  if (has_sensors) check_writable(sensors());
}

std::string YearFiles::told(const YearSolved& solved) const {
  return output + ", " + areas() + (solved.of_sensors.empty() ? "" : ", " + sensors());
}

void write_year(const YearFiles& files, const WrittenResult& result, const YearSolved& solved,
                const AnnualReport& annual, const std::vector<SensorPoint>& sensors, const RunReport& report,
                Outputs& outputs) {
  write_result(outputs.open(files.output), result, report);
  outputs.open(files.areas()).write(annual_json(annual));
  if (solved.of_sensors.empty()) return;
  std::vector<std::string> names;
  std::vector<double> values;
  const std::vector<YearFigure> figures = year_figures(solved.rules);
  for (const YearFigure& figure : figures) names.push_back(figure.name);
  for (const PointYear& point : solved.of_sensors)
    for (const YearFigure& figure : figures) values.push_back(figure(point, solved.rules));
  write_sensor_figures(outputs.open(files.sensors()), sensors, names, values);
}

}  // namespace clerestory
