#include "pipeline/settings.h"

#include <algorithm>
#include <span>

#include "io/scene_file/nearest_name.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::string problem_with(const std::string& name, std::span<const std::string_view> names, const std::string& what) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  const std::string near = suggestion(name, names);
  return what + " '" + name + "' is not known; " + near + (near.ends_with('?') ? "" : ".");
}

/// Enumerators and names are in the same order.
template <class Enum>
Enum named(const std::string& name, std::span<const std::string_view> names, const std::string& what) {
  if (const std::string problem = problem_with(name, names, what); !problem.empty()) throw InputError(problem);
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

}  // namespace

std::string problem_with_method(const std::string& name) { return problem_with(name, kMethodNames, "method"); }
std::string problem_with_accuracy(const std::string& name) { return problem_with(name, kAccuracyNames, "accuracy"); }
std::string problem_with_oracle(const std::string& name) { return problem_with(name, kOracleNames, "oracle"); }
Method method_named(const std::string& name) { return named<Method>(name, kMethodNames, "method"); }
Accuracy accuracy_named(const std::string& name) { return named<Accuracy>(name, kAccuracyNames, "accuracy"); }

Oracle oracle_named(const std::string& name) { return named<Oracle>(name, kOracleNames, "oracle"); }

Settings settings_of(const Scene& scene) {
  const SolverSettings& file = scene.settings;
  Settings s;
  if (file.method) s.solve.method = method_named(*file.method);
  if (file.accuracy) s.solve.accuracy = accuracy_named(*file.accuracy);
  if (file.oracle) s.solve.oracle = oracle_named(*file.oracle);
  if (file.seed) s.solve.seed = *file.seed;
  s.max_element = file.max_element;
  s.detail = file.detail;
  s.target_error = file.target_error;
  s.time_limit = file.time_limit;
  s.memory_limit = file.memory_limit;
  return s;
}

}  // namespace clerestory
