#include "apps/settings.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "io/memory_size.h"
#include "io/scene_file/nearest_name.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::string problem_with(const std::string& name, std::span<const std::string_view> names, const std::string& what) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return {};
  return what + " '" + name + "' is not known; " + suggestion(name, names) + ".";
}

/// The enumerator of the name; enumerators and names are in the same order.
template <class Enum>
Enum named(const std::string& name, std::span<const std::string_view> names) {
  return static_cast<Enum>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class T>
std::optional<T> first_of(const std::optional<T>& a, const std::optional<T>& b) {
  return a ? a : b;
}

}  // namespace

std::string problem_with_method(const std::string& name) { return problem_with(name, kMethodNames, "method"); }
std::string problem_with_accuracy(const std::string& name) { return problem_with(name, kAccuracyNames, "accuracy"); }

std::string problem_with_memory(const std::string& size) {
  return to_memory_size(size) ? "" : "'" + size + "' is no amount of memory; " + std::string(kMemorySizes) + ".";
}

Settings effective_settings(const CommonArguments& common, const SolveArguments& arguments, const Scene& scene) {
  const SolverSettings& file = scene.settings;
  Settings s;
  if (const auto name = first_of(arguments.method, file.method)) s.solve.method = named<Method>(*name, kMethodNames);
  if (const auto name = first_of(arguments.accuracy, file.accuracy))
    s.solve.accuracy = named<Accuracy>(*name, kAccuracyNames);
  s.solve.seed = first_of(common.seed, file.seed).value_or(s.solve.seed);
  s.mesh.max_element = first_of(arguments.max_element, file.max_element);
  s.mesh.target_triangles = target_triangles(s.solve.method, s.solve.accuracy);
  s.target_error = first_of(arguments.target_error, file.target_error);
  s.time_limit = first_of(arguments.time_limit, file.time_limit);
  s.memory_limit = arguments.memory_limit ? to_memory_size(*arguments.memory_limit) : file.memory_limit;
  s.channels = scene.channels();
  if (arguments.channels) s.channels = *arguments.channels == "1" ? 1 : 3;
  if (arguments.grey) s.channels = 1;
  s.debug = !arguments.debug_output.empty();
  return s;
}

void Settings::tighten(double max_element_in_force) {
  mesh.max_element = max_element_in_force / std::sqrt(2.0);
  ++solve.tighten;
}

std::vector<Figure> as_figures(const Settings& s, const ReadOptions& read) {
  std::vector<Figure> out = {{"method", std::string(kMethodNames[static_cast<std::size_t>(s.solve.method)])},
                             {"accuracy", std::string(kAccuracyNames[static_cast<std::size_t>(s.solve.accuracy)])},
                             {"channels", static_cast<long long>(s.channels)},
                             {"seed", static_cast<long long>(s.solve.seed)},
                             {"tighten", static_cast<long long>(s.solve.tighten)}};
  if (s.mesh.max_element) out.push_back({"max_element", *s.mesh.max_element});
  if (s.target_error) out.push_back({"target_error", *s.target_error});
  if (s.time_limit) out.push_back({"time_limit", *s.time_limit});
  if (s.memory_limit) out.push_back({"memory_limit", static_cast<long long>(*s.memory_limit)});
  if (read.unit) out.push_back({"unit", *read.unit});
  if (read.up) out.push_back({"up", *read.up});
  if (read.sky) out.push_back({"sky", *read.sky});
  return out;
}

}  // namespace clerestory
