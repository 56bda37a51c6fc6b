#pragma once
// Illuminances of every sensor in every hour of a year: --hours and --honeybee.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/console.h"
#include "io/annual/honeybee_folder.h"
#include "io/annual/hour_series.h"
#include "pipeline/annual/solve_year.h"

namespace clerestory {

class YearSeriesFiles {
 public:
  /// hours, honeybee  places to write to; empty when not asked for. Says how much --hours will take.
  YearSeriesFiles(const std::string& hours, const std::string& honeybee, const Scene& scene, const DaylightYear& year,
                  Console& console);
  bool any() const { return hours_ || honeybee_; }
  /// The next sensors, in their order.
  void take(const SensorSeries& series);
  void commit(const Scene& scene, const YearSolved& solved);

 private:
  std::vector<SensorPoint> sensors_;
  std::vector<std::size_t> ends_;  ///< of the grids, among all sensors
  std::unique_ptr<HourSeries> hours_;
  std::optional<HoneybeeFolder> honeybee_;
};

}  // namespace clerestory
