#pragma once
// A year in parts: what each leaves, and all of them put together again.

#include <string>
#include <vector>

#include "io/run_report.h"
#include "pipeline/annual/solve_year.h"
#include "solver/model/written_result.h"
#include "solver/model/year_part.h"

namespace clerestory {

/// What a part leaves beside its figures on points.
///
/// settings  with the part that `solved` was asked for.
/// files     that the run read.
YearPart part_of_year(const YearSolved& solved, const YearSettings& settings, const AnnualReport& facts,
                      std::vector<SensorPoint> sensors, std::vector<FileOfRun> files);

/// Marks what is of points of other parts, by -1 in all arrays but those of the mesh: cells with any such corner, too.
void mark_other_parts(const YearPart& part, WrittenResult& result);

/// A year as one run without parts would have it.
struct MergedYear {
  YearSolved solved;  ///< rules without hours; rooms, grids, all points and sensors
  std::vector<SensorPoint> sensors;
  WrittenResult result;  ///< with the figures
  AnnualReport annual;
  RunReport report;
};

class YearMerge {
 public:
  /// A part, in any order.
  /// throws  InputError: it is no part, one that is there already, or of another run, naming both files and what
  ///         differs.
  void add(WrittenResult result);

  /// throws  InputError that names the parts that are missing.
  MergedYear finish();

 private:
  void require_same_run(const WrittenResult& result, const YearPart& part) const;

  struct Part {
    std::string file;  ///< empty: it is not there
    YearSolved::Range points, sensors;
  };

  WrittenResult first_;  ///< which all others are held against
  YearPart facts_;       ///< of the first
  std::vector<Part> parts_;
  std::vector<PointYear> of_points_, of_sensors_;
};

}  // namespace clerestory
