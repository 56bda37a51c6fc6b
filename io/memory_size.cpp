#include "io/memory_size.h"

#include <cmath>
#include <string>

#include "io/text.h"

namespace clerestory {

std::optional<std::size_t> to_memory_size(std::string_view text) {
  constexpr double kMiB = 1024 * 1024, kMost = 1e15;
  const std::string_view all = trimmed(text);
  const std::size_t digits = std::min(all.find_first_not_of("0123456789.+-eE"), all.size());
  const std::optional<double> number = to_number(all.substr(0, digits));
  const std::string unit = to_lower(trimmed(all.substr(digits)));
  double bytes = kMiB;
  if (unit == "gib" || unit == "g")
    bytes = 1024 * kMiB;
  else if (!unit.empty() && unit != "mib" && unit != "m")
    return {};
  if (!number) return {};
  bytes *= *number;
  if (!(bytes >= kMiB && bytes <= kMost)) return {};
  return static_cast<std::size_t>(bytes);
}

}  // namespace clerestory
