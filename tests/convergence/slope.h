#pragma once
// Rates: how an error falls, as the slope of a straight line through its logarithms.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace clerestory::test {

/// Error over effort (rays, paths, elements), one row a run.
struct Errors {
  std::vector<double> effort, error;

  void add(double of, double left) { effort.push_back(of), error.push_back(left); }
};

/// d log(error) / d log(effort) by least squares; prints the rows, as they tell more than a slope that fails.
inline double slope(const char* what, const Errors& e) {
  const auto n = static_cast<double>(e.effort.size());
  double x = 0, y = 0, xx = 0, xy = 0;
  for (std::size_t k = 0; k < e.effort.size(); ++k) {
    const double a = std::log(e.effort[k]), b = std::log(e.error[k]);
    x += a / n, y += b / n, xx += a * a / n, xy += a * b / n;
    std::printf("%s,%g,%.3e\n", what, e.effort[k], e.error[k]);
  }
  const double fitted = (xy - x * y) / (xx - x * x);
  std::printf("%s,slope,%.3f\n", what, fitted);
  return fitted;
}

/// Standard error of that slope, where each error is a root mean square of `values` independent ones: its logarithm is
/// known to 1 / sqrt(2 values).
inline double slope_error(const Errors& e, double values) {
  const auto n = static_cast<double>(e.effort.size());
  double x = 0, xx = 0;
  for (const double of : e.effort) x += std::log(of) / n, xx += std::log(of) * std::log(of) / n;
  return 1 / std::sqrt(2 * values * n * (xx - x * x));
}

/// Root mean square of error(seed) over so many seeds.
template <class Error>
double rms_over_seeds(int seeds, const Error& error) {
  double squares = 0;
  for (int seed = 1; seed <= seeds; ++seed) squares += std::pow(error(static_cast<std::uint64_t>(seed)), 2);
  return std::sqrt(squares / seeds);
}

}  // namespace clerestory::test
