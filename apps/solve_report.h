#pragma once
// What is told about a solve: figures for the report, lines for people.

#include "apps/console.h"
#include "io/run_report.h"
#include "solver/lit_sides.h"
#include "solver/measured_error.h"
#include "solver/model/hierarchy_debug.h"
#include "solver/model/patch_set.h"
#include "solver/model/scene.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// All that a solve leaves behind.
struct Solved {
  PatchSet patches;
  MeshReport repairs;
  LitSides lit_sides;
  Solution solution;
  VertexLightmap lightmap;
  Field sensor_E;
  std::optional<MeasuredError> error, error_sensors;
  HierarchyDebug debug;      ///< empty unless asked for
  std::size_t openings = 0;  ///< through which the sky looks in
};

void fill_report(RunReport& report, const Scene& scene, const Solved& solved);

/// Illuminance on open ground [lx], when daylight factors have a meaning: a sky and no sun.
std::optional<double> daylight_reference(const Lights& lights);

/// Luminaires by type, photometric file and group, in the order in which they first appear.
std::vector<RunReport::Luminaires> luminaires_by_file(const Lights& lights);

/// A table of the sets, one line each below its header; [lx].
std::vector<std::string> sensor_table(const std::vector<SensorSummary>& sensors);

/// Takes what the solver's stages took out of `gather`, which holds the whole solve, and gives it to direct, refine and
/// reconstruct: what is left was iterating.
void split_by_stage(RunReport::Seconds& seconds, const Console& console);

/// Elements, time, energy balance, measured error and the sensors of each set, as lines on standard output.
void say_summary(const RunReport& report, const Solved& solved, Console& console);

}  // namespace clerestory
