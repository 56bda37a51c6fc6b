#pragma once
// What is asked of a solve.

#include <chrono>
#include <optional>
#include <string>

#include "solver/model/scene.h"
#include "solver/run/solve.h"

namespace clerestory {

struct Settings {
  SolveOptions solve;
  std::optional<int> channels{};               ///< 1 or 3; empty: what the scene needs
  std::optional<double> max_element{};         ///< longest edge [m]; empty: by accuracy and size
  std::optional<double> detail{};              ///< surfaces are simplified by no more [m]; empty: by max_element
  std::optional<double> target_error{};        ///< RMS relative [1]
  std::optional<std::size_t> error_samples{};  ///< points that the error is measured at, of surfaces and of sensors; 0:
                                               ///< it is not measured; empty: by accuracy and number of rooms
  std::optional<double> time_limit{};          ///< [s]
  std::optional<std::size_t> memory_limit{};   ///< of the whole process [bytes]
  bool debug = false;                          ///< show what the hierarchical method did
  bool layers = false;                         ///< also each group of luminaires, sky, sun, ... by itself (layers.h)

  /// The time limit counts from here, so that reading the scene may be part of it; empty: from solve_scene() on.
  std::optional<std::chrono::steady_clock::time_point> start{};
};

/// The defaults, with what the scene's file says.
Settings settings_of(const Scene& scene);

/// Why a name is not a method, an accuracy or an oracle, with the nearest one; empty when it is.
std::string problem_with_method(const std::string& name);
std::string problem_with_accuracy(const std::string& name);
std::string problem_with_oracle(const std::string& name);
/// throws  InputError for a name that is not known.
Method method_named(const std::string& name);
Accuracy accuracy_named(const std::string& name);
Oracle oracle_named(const std::string& name);

}  // namespace clerestory
