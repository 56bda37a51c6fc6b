#pragma once
// What is in force: options of the command line win over the scene file, which wins over the defaults.

#include <optional>
#include <string>

#include "apps/arguments.h"
#include "io/read_scene.h"
#include "io/run_report.h"
#include "meshing/build_patches.h"
#include "solver/model/scene.h"
#include "solver/solve.h"

namespace clerestory {

/// As typed; empty when not given.
struct SolveArguments {
  std::optional<std::string> method, accuracy, channels;
  std::optional<double> max_element, target_error, time_limit;
  std::optional<std::string> memory_limit;
  bool grey = false;
  std::string debug_output;  ///< folder; empty when not asked for
};

struct Settings {
  SolveOptions solve;
  MeshOptions mesh;
  std::optional<double> target_error;       ///< RMS relative [1]
  std::optional<double> time_limit;         ///< [s]
  std::optional<std::size_t> memory_limit;  ///< [bytes]
  int channels = 1;
  bool debug = false;  ///< whether the hierarchy is to be shown

  /// For the next try at the target error: elements of half the area, twice the rays.
  void tighten(double max_element_in_force);
};

/// Why a name is not a method or an accuracy, with the nearest one; empty when it is.
std::string problem_with_method(const std::string& name);
std::string problem_with_accuracy(const std::string& name);
/// Why a text is no amount of memory; empty when it is.
std::string problem_with_memory(const std::string& size);

/// Names are known ones: readers of options and scenes refuse others.
Settings effective_settings(const CommonArguments& common, const SolveArguments& arguments, const Scene& scene);

/// The settings as the report and the result name them.
std::vector<Figure> as_figures(const Settings& settings, const ReadOptions& read);

}  // namespace clerestory
