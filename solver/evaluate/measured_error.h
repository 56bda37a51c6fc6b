#pragma once
// How wrong the written field is, measured and not assumed.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "solver/evaluate/error_figures.h"
#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/sensors.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

/// Of one room, or of one set of sensors.
struct ErrorOfPart {
  std::string name;
  double area = 0;              ///< [m2]; of sensors 0
  double mean_illuminance = 0;  ///< of the result [lx]
  ErrorFigures figures;         ///< samples is 0 where no path found light
};

struct MeasuredError : ErrorFigures {
  std::string reference{};           ///< what it was compared with, in words
  std::vector<ErrorOfPart> parts{};  ///< as PatchSet::rooms, or as the sets of sensors
  /// Whether a part counts by itself: it has a hundredth of all area at least, or is a set of sensors.
  bool counts(const ErrorOfPart& part) const;
  /// That of the largest error; none where none is known.
  const ErrorOfPart* worst() const;
  /// Of all points together and of each part that counts, the largest error: as measured, and the ends of its 95 %
  /// interval. What nobody knows counts as 100 %.
  struct Largest {
    double lower, measured, upper;
  };
  Largest largest() const;
  /// Parts with light of which no path knows: those that count, and smaller ones of more than a lux.
  std::vector<const ErrorOfPart*> unknown() const;
};

/// What a measurement may cost. Paths grow like 1 / (1 - rho): a bright room gets fewer of them, at fewer points, and a
/// wider confidence, rather than hours.
struct ErrorEffort {
  std::size_t points;    ///< before a point gets more than the fewest paths that give a standard error
  int paths;             ///< a point, before there are more points
  double rays;           ///< at least; what the result took asks for more
  GatherQuality gather;  ///< of each of two gathers
  std::optional<std::size_t> asked_points{};  ///< so many, whatever they cost
};

/// Compares the lightmap (linear between its points) with references at random points of the surfaces.
///
/// solution  whose radiosity gathers look up; where the method has none to trust, that of paths, paths are alone. A
///           share of the rays that it took goes into the measurement, and a larger one of its time, as they are
///           single and go anywhere. From counts and not from time, so that every run measures the same.
MeasuredError measure_error(const Problem& problem, const VertexLightmap& lightmap, const Solution& solution,
                            const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor = {});

struct PointsOfSet {
  std::string name;
  std::size_t end = 0;  ///< number of the first point behind it
};
/// Compares sensor values with references at the sensor points; at an even choice of them where there are many.
///
/// sets  whose points follow each other.
MeasuredError measure_sensor_error(const Problem& problem, std::span<const SensorPoint> points,
                                   std::span<const PointsOfSet> sets, const Field& E, const Solution& solution,
                                   const ErrorEffort& effort, std::uint64_t seed, const Monitor& monitor = {});

}  // namespace clerestory
