#pragma once
// What is in force: options of the command line win over the scene file, which wins over the defaults.

#include <optional>
#include <string>

#include "apps/arguments.h"
#include "io/read_scene.h"
#include "io/run_report.h"
#include "pipeline/settings.h"

namespace clerestory {

/// As typed; empty when not given.
struct SolveArguments {
  std::optional<std::string> method, accuracy, oracle, channels;
  bool no_error = false, check = false, layers = false;
  std::optional<std::size_t> error_samples;
  std::optional<double> max_element, detail, target_error, time_limit;
  std::optional<std::string> memory_limit;
  bool grey = false;
  std::string debug_output;  ///< folder; empty when not asked for
};

/// Why a text is no amount of memory; empty when it is.
std::string problem_with_memory(const std::string& size);

/// Names are known ones: readers of options and scenes refuse others.
Settings effective_settings(const CommonArguments& common, const SolveArguments& arguments, const Scene& scene);

/// The settings as the report and the result name them; channels: those that were solved.
std::vector<Figure> as_figures(const Settings& settings, int channels, const ReadOptions& read);

}  // namespace clerestory
