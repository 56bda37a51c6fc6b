#pragma once
// The files of a year: what `annual` writes, and `merge` again.

#include <string>
#include <vector>

#include "apps/named_files.h"
#include "io/atomic_file.h"
#include "io/run_report.h"
#include "pipeline/annual/solve_year.h"
#include "solver/model/written_result.h"

namespace clerestory {

struct YearFiles {
  std::string output;       ///< OUT.vtp
  std::string sensors_out;  ///< empty: OUT.sensors.csv

  std::string areas() const;    ///< rooms and grids: OUT.json
  std::string sensors() const;  ///< as asked for, or OUT.sensors.csv
  /// All three, for what must not be overwritten.
  std::vector<NamedFile> named() const;
  /// throws  InputError where one of them could not be written, or sensors' output is asked for and there are none.
  void check_places(bool has_sensors) const;
  /// "OUT.vtp, OUT.json, OUT.sensors.csv"
  std::string told(const YearSolved& solved) const;
};

/// result  with the figures of `solved`.
void write_year(const YearFiles& files, const WrittenResult& result, const YearSolved& solved,
                const AnnualReport& annual, const std::vector<SensorPoint>& sensors, const RunReport& report,
                Outputs& outputs);

}  // namespace clerestory
