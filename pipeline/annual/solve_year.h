#pragma once
// Scene and weather -> figures of a year at points, sensors and in rooms.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/observer.h"
#include "pipeline/settings.h"
#include "pipeline/solved.h"
#include "solver/evaluate/annual_figures.h"
#include "solver/evaluate/blinds.h"
#include "solver/model/daylight_year.h"
#include "solver/model/scene.h"

namespace clerestory {

/// What is asked of a year.
struct YearSettings {
  Settings solve;                         ///< method `hierarchical`
  std::vector<std::uint8_t> is_occupied;  ///< by hour of the year, 8,760
  double threshold = 300;                 ///< of DA, cDA and sDA [lx]
  std::vector<double> more_thresholds{};  ///< whose hours are counted, too [lx]
  std::optional<std::size_t> sky_parts;   ///< 145, 577 or 2305; empty: by accuracy
  std::size_t part = 1, parts = 1;        ///< of the points, which part of how many is computed
  bool keeps_all_hours = false;           ///< series are of all hours with light, not just those that count
};

/// Series of sensors begin, ..., end - 1.
struct SensorSeries {
  std::size_t begin, end;
  std::span<const float> total, direct;  ///< (end - begin) x H [lx]
};
/// Told of the sensors' series in their order, by one thread.
using TakeSeries = std::function<void(const SensorSeries&)>;

/// A room (what faces up in it) or a grid of sensors.
struct YearArea {
  std::string name;
  std::vector<std::size_t> points;  ///< of the lightmap, or sensors
  std::vector<double> weight;       ///< area that each stands for [m2]; without has_area 1
  bool has_area = true;
  std::vector<BlindsOfHour> blinds;  ///< H; empty without blinds
  BlindsYear closed;
  AreaYear figures;          ///< where all of its points are known
  std::uint32_t number = 0;  ///< of the room in PatchSet::rooms
};

struct YearSolved {
  Solved solved;  ///< elements, lightmap and solution of the mean light of the occupied hours
  YearRules rules;
  bool has_blinds = false;
  std::vector<int> hours;  ///< H, of the year
  std::size_t sky_parts = 0, sun_nodes = 0;
  std::vector<PointYear> of_points, of_sensors;  ///< those of the part that was asked for; others have no hours
  struct Range {
    std::size_t begin = 0, end = 0;
  };
  Range part_of_points, part_of_sensors;
  std::vector<YearArea> rooms, grids;
  YearError error_of_points, error_of_sensors;              ///< that figures' low and high are of
  std::optional<ErrorFigures> error_points, error_sensors;  ///< of illuminances in single hours
};

/// Daylight coefficients of all points, by one solve under the year's mean sky; each hour is a sum of them, with the
/// sun by shadow rays of its own.
///
/// take  null, or told of the sensors' series.
/// throws  InputError: no daylight reaches the model, a scene or settings that cannot be solved.
YearSolved solve_year(const Scene& scene, const DaylightYear& year, const YearSettings& settings, Observer& observer,
                      const TakeSeries& take = {});

}  // namespace clerestory
