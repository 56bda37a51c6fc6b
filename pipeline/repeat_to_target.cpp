#include "pipeline/repeat_to_target.h"

#include <algorithm>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

using Clock = std::chrono::steady_clock;

/// Passes progress on and keeps how long each stage of a solve took.
class StageTimes {
 public:
  void on_progress(std::string_view stage) {
    const auto now = Clock::now();
    if (stages_.empty() || stages_.back().name != stage) {
      if (!stages_.empty()) stages_.back().end = now;  // the last report comes before the last stretch of work
      stages_.push_back({std::string(stage), now, now});
    }
    stages_.back().end = now;
  }
  double in(const std::string& name) const {
    double sum = 0;
    for (const Stage& stage : stages_)
      if (stage.name.starts_with(name)) sum += std::chrono::duration<double>(stage.end - stage.begin).count();
    return sum;
  }
  /// Takes what the solver's stages took out of `gather`, which holds the whole solve, and gives it to direct, refine
  /// and reconstruct: what is left was iterating.
  void split(StageSeconds& s) const {
    const double vertices = in("vertices");
    s.direct = in("direct");
    s.refine = in("refine") + in("links");
    s.reconstruct += vertices;
    s.gather -= s.direct + s.refine + vertices;
  }

 private:
  struct Stage {
    std::string name;
    Clock::time_point begin, end;
  };
  std::vector<Stage> stages_;
};

Clock::time_point deadline(const Settings& s) {
  constexpr double kNever = 1e9;  // 30 years; a clock that counts nanoseconds ends after 290
  if (!s.time_limit || *s.time_limit > kNever) return Clock::time_point::max();
  return s.start.value_or(Clock::now()) +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*s.time_limit));
}

/// Of the worst room and the worst set of sensors, for sure; what nobody knows counts as 100 %.
double worst_error(const Solved& s) {
  const auto of = [](const std::optional<MeasuredError>& error) {
    if (!error) return 0.0;
    const ErrorOfPart* worst = error->worst();
    return std::max({error->upper(), worst ? worst->figures.upper() : 0.0, error->unknown().empty() ? 0.0 : 1.0});
  };
  return std::max(of(s.error), of(s.error_sensors));
}

/// Where a time limit may leave time for a coarser level only.
bool may_be_too_much(const Settings& s) {
  return s.time_limit && s.solve.method == Method::hierarchical && s.solve.tighten == 0;
}

void say_coarser(Solution& solution, Accuracy level, Accuracy asked) {
  const auto name = [](Accuracy a) { return std::string(kAccuracyNames[static_cast<std::size_t>(a)]); };
  if (solution.stop == StopReason::converged) solution.stop = StopReason::time_limit;
  if (solution.stopped_at.empty())
    solution.stopped_at = "accuracy " + name(level) + ", as " + name(asked) + " would have taken longer";
}

bool is_better(const Solved& a, const Solved& b) { return a.error && (!b.error || worst_error(a) <= worst_error(b)); }

}  // namespace

bool meets_target(const Solved& s) {
  if (!s.settings.target_error) return true;
  return s.error && worst_error(s) <= *s.settings.target_error;
}

Solved repeat_to_target(const Settings& asked, Observer& observer, const SolveRound& round) {
  StageTimes times;
  const Monitor monitor{.progress =
                            [&](std::string_view stage, double done) {
                              times.on_progress(stage);
                              observer.progress(stage, done);
                            },
                        .interrupted = [&] { return observer.should_stop(); },
                        .deadline = deadline(asked),
                        .has_result = [&] { observer.has_result(); }};
  StageSeconds seconds;
  Settings settings = asked;
  const auto attempt = [&] {
    const Accuracy level = settings.solve.accuracy;
    if (may_be_too_much(settings)) settings.solve.at_most = level, settings.solve.accuracy = Accuracy::draft;
    std::optional<Solved> solved = round(settings, monitor, seconds);
    if (solved && solved->rather) {
      settings.solve.at_most = settings.solve.accuracy = *solved->rather;
      solved = round(settings, monitor, seconds);
    }
    if (!solved) return solved;
    solved->settings = settings;
    if (settings.solve.accuracy < level) say_coarser(solved->solution, settings.solve.accuracy, level);
    return solved;
  };
  Solved best;
  if (auto first = attempt()) {
    best = std::move(*first);
  } else {
    best.solution.stop = StopReason::interrupted;
    best.settings = settings;
  }
  Settings finer = settings;
  for (int k = 1; k < kMostRounds && !best.empty() && !meets_target(best) && !monitor.should_stop(); ++k) {
    finer.max_element = finer.max_element.value_or(best.repairs.max_element) * kTighterEdge;
    ++finer.solve.tighten;
    observer.note("error up to " + percent(best.error ? worst_error(best) : 1) + ", asked for " +
                  percent(*finer.target_error) + ": again with elements of " + rounded(*finer.max_element) +
                  " m and twice the rays");
    // What is solved already must not be lost to a try that needs too much.
    try {
      settings = finer;
      if (auto next = attempt(); next && is_better(*next, best)) best = std::move(*next);
    } catch (const InputError& e) {
      observer.warn(std::string("the target error would need more than this: ") + e.what());
      break;
    } catch (const std::bad_alloc&) {
      observer.warn("the target error would need more memory than there is.");
      break;
    }
  }
  if (!best.empty() && monitor.should_stop() && !meets_target(best)) best.solution.stop = why_stopped(monitor);
  best.seconds = seconds;
  times.split(best.seconds);
  return best;
}

}  // namespace clerestory
