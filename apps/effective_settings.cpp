#include "apps/effective_settings.h"

#include "io/memory_size.h"

namespace clerestory {

std::string problem_with_memory(const std::string& size) {
  return to_memory_size(size) ? "" : "'" + size + "' is no amount of memory; " + std::string(kMemorySizes) + ".";
}

Settings effective_settings(const CommonArguments& common, const SolveArguments& arguments, const Scene& scene) {
  Settings s = settings_of(scene);
  if (arguments.method) s.solve.method = method_named(*arguments.method);
  if (arguments.accuracy) s.solve.accuracy = accuracy_named(*arguments.accuracy);
  if (arguments.oracle) s.solve.oracle = oracle_named(*arguments.oracle);
  if (common.seed) s.solve.seed = *common.seed;
  if (arguments.max_element) s.max_element = arguments.max_element;
  if (arguments.detail) s.detail = arguments.detail;
  if (arguments.target_error) s.target_error = arguments.target_error;
  if (arguments.error_samples) s.error_samples = arguments.error_samples;
  if (arguments.no_error) s.error_samples = 0;
  if (arguments.time_limit) s.time_limit = arguments.time_limit;
  if (arguments.memory_limit) s.memory_limit = to_memory_size(*arguments.memory_limit);
  if (arguments.channels) s.channels = *arguments.channels == "1" ? 1 : 3;
  if (arguments.grey) s.channels = 1;
  s.solve.check_laws = arguments.check;
  s.layers = arguments.layers;
  s.debug = !arguments.debug_output.empty();
  return s;
}

std::vector<Figure> as_figures(const Settings& s, int channels, const ReadOptions& read) {
  std::vector<Figure> out = {{"method", std::string(kMethodNames[static_cast<std::size_t>(s.solve.method)])},
                             {"accuracy", std::string(kAccuracyNames[static_cast<std::size_t>(s.solve.accuracy)])},
                             {"channels", static_cast<long long>(channels)},
                             {"seed", static_cast<long long>(s.solve.seed)},
                             {"tighten", static_cast<long long>(s.solve.tighten)}};
  if (s.solve.method == Method::hierarchical)
    out.push_back({"oracle", std::string(kOracleNames[static_cast<std::size_t>(s.solve.oracle)])});
  if (s.max_element) out.push_back({"max_element", *s.max_element});
  if (s.detail) out.push_back({"detail", *s.detail});
  if (s.target_error) out.push_back({"target_error", *s.target_error});
  if (s.error_samples) out.push_back({"error_samples", static_cast<long long>(*s.error_samples)});
  if (s.layers) out.push_back({"layers", true});
  if (s.time_limit) out.push_back({"time_limit", *s.time_limit});
  if (s.memory_limit) out.push_back({"memory_limit", static_cast<long long>(*s.memory_limit)});
  if (read.unit) out.push_back({"unit", *read.unit});
  if (read.up) out.push_back({"up", *read.up});
  if (read.sky) out.push_back({"sky", *read.sky});
  if (read.gloss) out.push_back({"gloss", *read.gloss});
  return out;
}

}  // namespace clerestory
