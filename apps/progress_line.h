#pragma once
// Progress for people: a bar on a terminal, now and then a plain line elsewhere.

#include <chrono>
#include <iosfwd>
#include <string>
#include <string_view>

namespace clerestory {

class ProgressLine {
 public:
  using Time = std::chrono::steady_clock::time_point;

  ProgressLine(std::ostream& out, bool terminal, Time start) : out_(out), terminal_(terminal), start_(start) {}

  /// Stage `stage` is `done` [0, 1] at time `now`. Writes at most ten bars, or one line in five seconds; a new stage
  /// that takes a second is always named.
  void update(std::string_view stage, double done, Time now = std::chrono::steady_clock::now());
  /// Takes the bar off the screen, so that something else can be written.
  void clear();

 private:
  std::ostream& out_;
  bool terminal_, bar_shown_ = false, stage_named_ = false;
  std::string stage_;
  Time start_, stage_start_, last_written_{};
};

}  // namespace clerestory
