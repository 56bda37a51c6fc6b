#include "pipeline/wording.h"

#include <cmath>
#include <cstdio>

namespace clerestory {
namespace {

std::string print(const char* format, int digits, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, digits, value);
  return text;
}

}  // namespace

std::string grouped(unsigned long long n) {
  std::string text = std::to_string(n);
  for (std::size_t end = text.size(); end > 3;) text.insert(end -= 3, ",");
  return text;
}

std::string rounded(double value, int digits) {
  const double size = std::abs(value);
  if (!(size >= 1e-4 && size < 1e7)) return print("%.*g", digits, value);
  const int decimals = digits - 1 - static_cast<int>(std::floor(std::log10(size)));
  return print("%.*f", decimals > 0 ? decimals : 0, value);
}

std::string percent(double share) { return rounded(100 * share) + " %"; }

std::string duration(double seconds) {
  if (seconds < 0.9995) return std::to_string(std::lround(seconds * 1000)) + " ms";
  if (seconds < 59.95) return print("%.*f", 1, seconds) + " s";
  const long whole = std::lround(seconds);
  return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string bytes(std::size_t n) {
  const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  double value = static_cast<double>(n);
  int unit = 0;
  for (; value >= 1024 && unit < 4; ++unit) value /= 1024;
  return rounded(value) + " " + units[unit];
}

std::string counted(unsigned long long n, const std::string& thing) {
  return grouped(n) + " " + thing + (n == 1 ? "" : "s");
}

}  // namespace clerestory
