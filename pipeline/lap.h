#pragma once
// A stopwatch.

#include <chrono>

namespace clerestory {

class Lap {
 public:
  /// Adds the seconds since it was made, or since the last call, to `sum`.
  void add_to(double& sum) {
    const auto now = std::chrono::steady_clock::now();
    sum += std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
  }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace clerestory
