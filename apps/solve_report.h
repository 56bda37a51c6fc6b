#pragma once
// What is told about a solve: figures for the report, lines for people.

#include "apps/console.h"
#include "io/run_report.h"
#include "pipeline/solved.h"
#include "solver/model/scene.h"

namespace clerestory {

void fill_report(RunReport& report, const Scene& scene, const Solved& solved);

/// Luminaires by type, photometric file and group, in the order in which they first appear.
std::vector<RunReport::Luminaires> luminaires_by_file(const LightSpec& lights);

/// A table of the sets, one line each below its header; [lx].
std::vector<std::string> sensor_table(const std::vector<SensorSummary>& sensors);

/// "'desk' 3200 lm, 17.9 W emitted, 17 W absorbed, 0.9 W escaped"
std::string layer_line(const ShownLayer& layer);

/// "1.2 % rms (+- 0.1 %), 95 % of points within 3 %, measured at 257 points"
std::string error_line(const MeasuredError& error);

/// Elements, time, energy balance, measured error and the sensors of each set, as lines on standard output.
void say_summary(const RunReport& report, const Solved& solved, Console& console);

}  // namespace clerestory
