#pragma once
// How a long computation reports progress and learns that it should stop.

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>
#include <string_view>

namespace clerestory {

/// `progress` is called from the calling thread only, with a stage name and the share done [0, 1]; `interrupted` from
/// any thread: the work is no longer wanted.
struct Monitor {
  std::function<void(std::string_view stage, double done)> progress;
  std::function<bool()> interrupted;
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();

  /// Called once there is something to return: from then on a run that is stopped early was not for nothing.
  std::function<void()> has_result{};

  void report(std::string_view stage, double done) const {
    if (progress) progress(stage, done);
  }
  void say_result() const {
    if (has_result) has_result();
  }
  bool is_interrupted() const { return interrupted && interrupted(); }
  bool has_deadline() const { return deadline != std::chrono::steady_clock::time_point::max(); }
  /// [s], 0 afterwards; infinite without one.
  double seconds_left() const {
    if (!has_deadline()) return std::numeric_limits<double>::infinity();
    return std::max(0.0, std::chrono::duration<double>(deadline - std::chrono::steady_clock::now()).count());
  }
  /// With a deadline that is so many seconds from now, where there is one.
  Monitor within(double seconds) const {
    using Clock = std::chrono::steady_clock;
    Monitor m = *this;
    if (has_deadline())
      m.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    return m;
  }
  bool is_late() const { return std::chrono::steady_clock::now() >= deadline; }
  bool should_stop() const { return is_interrupted() || is_late(); }
};

}  // namespace clerestory
