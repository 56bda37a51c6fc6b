#pragma once
// A figure of a benchmark as a row of CSV: what, value, unit, bar.

#include <cstdio>
#include <string>

namespace clerestory {

inline void row(const std::string& what, double value, const char* unit, const char* bar = "") {
  std::printf("%s,%.4g,%s,%s\n", what.c_str(), value, unit, bar);
  std::fflush(stdout);
}

}  // namespace clerestory
