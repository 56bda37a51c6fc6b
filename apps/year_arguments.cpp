#include "apps/year_arguments.h"

#include <algorithm>

#include "io/text.h"
#include "solver/evaluate/annual_figures.h"
#include "solver/model/year_part.h"

namespace clerestory {
namespace {

constexpr double kLeastThreshold = 1, kMostThreshold = 1e6;  ///< [lx]; the sun gives some 1e5

}  // namespace

std::optional<std::pair<std::size_t, std::size_t>> part_of(const std::string& words) {
  const std::size_t slash = words.find('/');
  if (slash == words.npos) return {};
  const auto number = [](const std::string& s) {
    const bool digits = !s.empty() && std::ranges::all_of(s, [](char c) { return c >= '0' && c <= '9'; });
    return digits ? to_number(s).value_or(0) : 0;
  };
  const double part = number(words.substr(0, slash)), parts = number(words.substr(slash + 1));
  if (part < 1 || part > parts || parts > static_cast<double>(kMostParts)) return {};
  return std::pair(static_cast<std::size_t>(part), static_cast<std::size_t>(parts));
}

std::string problem_with_part(const std::string& words) {
  if (part_of(words)) return {};
  return "'" + quotable(words) + "' is no part; give i/n, part i of n, with 1 <= i <= n: 2/4";
}

std::string problem_with_threshold(const std::string& words) {
  const auto lux = to_number(words);
  if (lux && *lux >= kLeastThreshold && *lux <= kMostThreshold) return {};
  return text("'", quotable(words), "' is no illuminance of [", kLeastThreshold, ", ", kMostThreshold,
              "] lx; write it as 300");
}

std::string problem_with_thresholds(const std::vector<double>& thresholds) {
  std::vector<std::string> names;
  for (const double lux : thresholds) {
    const std::string name = threshold_name(lux);
    if (std::ranges::find(names, name) != names.end()) return "has " + name + " lx twice; give each threshold once";
    names.push_back(name);
  }
  return {};
}

void leave_out_what_a_year_does_not_follow(Settings& settings, const std::string& scene_file, Console& console) {
  const auto left_out = [&](const std::string& what, const std::string& instead) {
    console.warn(scene_file + ": solver." + what + " is not for a year and is left out: " + instead + ".");
  };
  if (settings.solve.method != Method::hierarchical) {
    left_out(text("method '", kMethodNames[static_cast<std::size_t>(settings.solve.method)], "'"),
             "it is solved by the hierarchical method");
    settings.solve.method = Method::hierarchical;
  }
  if (settings.target_error) left_out("target_error", "--accuracy says how fine it is"), settings.target_error.reset();
  if (settings.time_limit)
    left_out("time_limit", "it is computed to its end, or in parts by --part"), settings.time_limit.reset();
  if (settings.memory_limit)
    left_out("memory_limit", "a larger --max-element takes less memory"), settings.memory_limit.reset();
}

}  // namespace clerestory
