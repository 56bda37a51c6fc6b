#pragma once
// What a run did, for people and scripts: the --report file, and the field data of a result.

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "io/atomic_file.h"
#include "solver/model/laws.h"
#include "solver/model/mesh_report.h"
#include "solver/model/scene.h"
#include "solver/model/scene_around.h"
#include "solver/model/solution.h"
#include "solver/model/stage_seconds.h"

namespace clerestory {

/// One named value of a report. Dots in the name are levels of the JSON file: "energy.emitted".
struct Figure {
  std::string name;
  std::variant<bool, long long, double, std::string> value;
};

struct RunReport {
  std::string version, input, method;
  std::string time;              ///< that this result of several is of, "2026-03-21T12:00"; else empty
  std::vector<Figure> settings;  ///< every setting in force that the result depends on
  int threads = 0;               ///< no result depends on it
  struct Counts {
    std::size_t triangles = 0;   ///< of the mesh, before any is halved, each with two sides
    std::size_t elements = 0;    ///< sides that take part, or what they were halved into
    std::size_t dark_sides = 0;  ///< sides left out because no light can reach them
    std::size_t points = 0, clusters = 0, links = 0, sensors = 0;
    std::size_t openings = 0;  ///< gaps through which the sky looks into a room
    unsigned long long rays = 0;
  } counts;
  StageSeconds seconds;
  std::size_t peak_memory_bytes = 0;
  std::size_t predicted_memory_bytes = 0;  ///< what the counts let expect
  long iterations = 0;
  double residual = 0;  ///< [1]
  EnergyBalance energy;
  struct Error {
    double rms_relative = 0, median_relative = 0, p95_relative = 0;  ///< [1]
    std::size_t samples = 0;
    double confidence = 0;    ///< half-width of the 95 % interval of rms_relative
    bool bound = false;       ///< the error is not resolved: it is at most so large
    std::string reference{};  ///< what it was compared with, in words; empty: not told
  };
  /// Of a room or a set of sensors.
  struct PartError {
    std::string name;
    double area = 0;              ///< [m2]; of sensors 0
    double mean_illuminance = 0;  ///< [lx]
    Error error;                  ///< samples is 0 where no path found light
  };
  std::optional<Error> error, error_sensors;        ///< empty when not measured
  std::vector<PartError> error_spaces, error_sets;  ///< by room, by set of sensors
  std::optional<std::size_t> worst_space;           ///< in error_spaces
  std::vector<LawCheck> laws;                       ///< empty when not checked
  std::optional<Daylight> daylight;
  /// Luminaires of one photometric file (or all points, or all spots) in one group.
  struct Luminaires {
    std::string type;         ///< "file", "point" or "spot"
    std::string file, group;  ///< may be empty
    std::size_t count = 0;
    double luminous_flux = 0;  ///< of all of them, dimming included [lm]
    double file_flux = 0;      ///< of one, the integral of its file's intensities [lm]
    double declared_flux = 0;  ///< of one, as its file says [lm]; 0: it does not
    double lamp_flux = 0;      ///< of one's bare lamps, as its file says [lm]; 0: it does not
  };
  std::vector<Luminaires> luminaires;
  std::vector<ShownLayer> layers;  ///< empty: it was not solved in layers
  struct Space {
    std::string name, long_name;
    double area = 0, height = 0, volume = 0;  ///< [m2], [m], [m3]; 0 where the model gives no volume
  };
  std::vector<Space> spaces;           ///< rooms that the models name
  std::vector<NotRead> not_read;       ///< what the models hold and their readers did not use
  std::vector<SensorSummary> sensors;  ///< one a set
  /// One of several times that were solved together, see Scene::times.
  struct AtTime {
    std::string time, file;  ///< of its result
    Daylight daylight;
    double mean_illuminance = 0;  ///< over all surfaces [lx]
    EnergyBalance energy;
    std::optional<Error> error, error_sensors;
    std::optional<PartError> worst;  ///< of the rooms, where their errors are known
    std::vector<SensorSummary> sensors;
  };
  std::vector<AtTime> times;  ///< empty: it was one
  StopReason stop = StopReason::converged;
  MeshReport repairs;
  std::vector<std::string> log;  ///< a line for each round of the solver; the last ones tell what a stopped run shows
  std::vector<std::string> warnings;
  std::vector<std::string> left_out;  ///< what the scene did not need, so was not computed
};

/// Area, height and volume of each.
std::vector<RunReport::Space> figures_of(const std::vector<NamedSpace>& spaces);

/// A report to fill, with the version of this library.
RunReport new_report(const std::string& input);

/// "converged", "time-limit", "interrupted" or "iteration-limit".
std::string stop_name(StopReason stop);

/// The figures that are the same for every run with these settings: no times, no memory, no thread count.
std::vector<Figure> repeatable_figures(const RunReport& report);

/// The report as JSON, without what differs from run to run with these settings, and what was only
/// looked at: times, memory, threads, the log, laws.
std::string repeatable_text(const RunReport& report);

/// Writes the report as JSON, into a file that the caller commits or a whole one.
void write_report(AtomicFile& file, const RunReport& report);
void write_report(const std::filesystem::path& file, const RunReport& report);

}  // namespace clerestory
