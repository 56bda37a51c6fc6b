#pragma once
// A solved year as what is written and said of it.

#include <string>
#include <vector>

#include "pipeline/annual/solve_year.h"
#include "solver/model/annual.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// schedule  as it was asked for.
AnnualReport annual_report(const Scene& scene, const DaylightYear& year, const std::string& schedule,
                           const YearSolved& solved);

/// Rooms and grids with their figures into the report.
void tell_areas(const YearSolved& solved, AnnualReport& report);

/// Sets the light of lightmap and solution to the mean of the occupied hours.
void show_mean(const YearRules& rules, const std::vector<PointYear>& of_points, Solved& solved);

/// Figures as arrays of points, and of cells the mean of their corners; names as year_figures() has them.
void add_figures(const YearSolved& solved, WrittenResult& result);

/// What must be known of these figures: limits that lie within the interval of a room or grid, hours of which little is
/// sure, rooms without daylight, no room at all.
std::vector<std::string> warnings_of(const AnnualReport& report);

/// A line for each room and grid: "room 1: sDA 62 % (58 to 66 %), ASE 8.1 %, ..."
std::vector<std::string> lines_of(const AnnualReport& report);

}  // namespace clerestory
