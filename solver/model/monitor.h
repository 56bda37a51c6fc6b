#pragma once
// How a long computation reports progress and learns that it should stop.

#include <atomic>
#include <chrono>
#include <functional>
#include <string_view>

namespace clerestory {

/// Cheap to copy. `progress` is called from the calling thread only, with a stage name and the share done [0, 1].
struct Monitor {
  std::function<void(std::string_view stage, double done)> progress;
  const std::atomic<bool>* interrupted = nullptr;  ///< set by Ctrl-C
  std::chrono::steady_clock::time_point deadline = std::chrono::steady_clock::time_point::max();

  void report(std::string_view stage, double done) const {
    if (progress) progress(stage, done);
  }
  bool is_interrupted() const { return interrupted && interrupted->load(std::memory_order_relaxed); }
  bool is_late() const { return std::chrono::steady_clock::now() >= deadline; }
  bool should_stop() const { return is_interrupted() || is_late(); }
};

}  // namespace clerestory
