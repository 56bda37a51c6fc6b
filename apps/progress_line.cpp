#include "apps/progress_line.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "pipeline/wording.h"

namespace clerestory {
namespace {

double seconds_between(ProgressLine::Time a, ProgressLine::Time b) {
  return std::chrono::duration<double>(b - a).count();
}

std::string bar(double done) {
  constexpr int kWidth = 24;
  const int full = static_cast<int>(std::lround(done * kWidth));
  return "[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(kWidth - full), '-') + "]";
}

/// Supposes that a stage goes on as fast as it began; says nothing until that means something.
std::string remaining(double done, double stage_seconds) {
  if (done < 0.02 || stage_seconds < 0.5) return {};
  return ", about " + duration(stage_seconds * (1 - done) / done) + " left";
}

}  // namespace

void ProgressLine::update(std::string_view stage, double done, Time now) {
  done = std::clamp(std::isfinite(done) ? done : 0.0, 0.0, 1.0);
  if (stage != stage_) {
    stage_ = stage;
    stage_start_ = now;
    stage_named_ = false;
  }
  const double stage_seconds = seconds_between(stage_start_, now), silent = seconds_between(last_written_, now);
  const std::string figures = std::to_string(static_cast<int>(100 * done)) + " %, " +
                              duration(seconds_between(start_, now)) + " elapsed" + remaining(done, stage_seconds);
  if (terminal_) {
    if (silent < 0.1) return;
    out_ << '\r' << bar(done) << ' ' << stage_ << ' ' << figures << "\033[K" << std::flush;
    bar_shown_ = true;
  } else {
    const bool names_stage = !stage_named_ && stage_seconds >= 1;
    if (!names_stage && silent < 5) return;
    if (stage_seconds < 1) return;
    out_ << stage_ << ": " << figures << std::endl;
    stage_named_ = true;
  }
  last_written_ = now;
}

void ProgressLine::clear() {
  if (bar_shown_) out_ << "\r\033[K" << std::flush;
  bar_shown_ = false;
}

}  // namespace clerestory
