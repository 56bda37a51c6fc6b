#include "pipeline/repeat_to_target.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/target_rounds.h"
#include "pipeline/wording.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/model/error.h"
#include "solver/run/memory_estimate.h"

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

/// Upper end of the interval of an error, over the error, as finer rounds have it.
constexpr double kConfidence = 1.2;

using Largest = MeasuredError::Largest;
/// Of the worst room and the worst set of sensors.
double worst(const Solved& s, double Largest::*figure) {
  return std::max(s.error ? s.error->largest().*figure : 0.0,
                  s.error_sensors ? s.error_sensors->largest().*figure : 0.0);
}
double worst_error(const Solved& s) { return worst(s, &Largest::upper); }  // for sure

/// Where a time limit may leave time for a coarser level only.
bool may_be_too_much(const Settings& s, const Monitor& monitor) {
  return monitor.has_deadline() && s.solve.method == Method::hierarchical;
}

constexpr std::size_t kFinestLevel = 2;
static_assert(kTargetRounds[kFinestLevel].accuracy == Accuracy::fine && kTargetRounds[kFinestLevel].tighten == 0);

Settings of_round(Settings asked, std::size_t round) {
  asked.solve.accuracy = kTargetRounds[round].accuracy, asked.solve.tighten = kTargetRounds[round].tighten;
  return asked;
}

/// "draft", "fine, raised twice".
std::string name_of(const TargetRound& round) {
  constexpr const char* kTimes[] = {"", ", raised once", ", raised twice"};
  return std::string(kAccuracyNames[static_cast<std::size_t>(round.accuracy)]) + kTimes[round.tighten];
}

/// Rooms that keep the target for sure, each with the first level at which it did: the next round need not resolve them
/// any better. None where sensors do not keep it, for all rooms may light them.
std::vector<RoomLevel> good_rooms(const Solved& s) {
  std::vector<RoomLevel> good;
  const double target = *s.settings.target_error;
  if (!s.error || !keeps_its_light(s) || (s.error_sensors && s.error_sensors->largest().upper > target)) return good;
  for (const ErrorOfPart& part : s.error->parts) {
    if (part.figures.samples == 0 || part.figures.upper() > target) continue;
    const std::vector<RoomLevel>& before = s.settings.solve.good_rooms;
    const auto same = std::ranges::find(before, part.name, &RoomLevel::room);
    const SolveOptions& now = s.settings.solve;
    good.push_back(same != before.end() ? *same
                                        : RoomLevel{part.name, now.accuracy, now.tighten, s.repairs.max_element});
  }
  return good;
}

/// How many more elements a later round has: others than `hierarchical` halve none.
double times_more(const Settings& s, std::size_t now, std::size_t next) {
  if (s.solve.method == Method::hierarchical) return kTargetRounds[next].elements / kTargetRounds[now].elements;
  return s.max_element ? 1 : target_triangles(of_round(s, next).solve) / target_triangles(of_round(s, now).solve);
}

/// How much longer a later round takes.
double times_longer(const Settings& s, std::size_t now, std::size_t next) {
  const double more = times_more(s, now, next);
  return has_matrix(s.solve.method) ? more * more : kTargetRounds[next].time / kTargetRounds[now].time;
}

/// What the next round is expected to reach and to cost.
std::string expectation(const Solved& solved, std::size_t now, std::size_t next, double seconds) {
  const TargetRound &then = kTargetRounds[now], &coming = kTargetRounds[next];
  const double target = *solved.settings.target_error, error = worst_error(solved);
  const double expected = kConfidence * worst(solved, &Largest::measured) * coming.error / then.error,
               more = times_more(solved.settings, now, next);
  const auto times = [&](std::size_t n) { return static_cast<std::size_t>(more * static_cast<double>(n)); };
  const std::size_t patches = times(solved.patches.patch_count());
  const std::size_t memory = (has_matrix(solved.settings.solve.method) ? form_factor_bytes(patches) : 0) +
                             predicted_memory({solved.repairs.input_triangles, times(solved.repairs.triangles),
                                               times(solved.repairs.triangles), patches,
                                               times(solved.lightmap.position.size()), times(solved.solution.links)});
  const std::string reached =
      error <= target && !keeps_its_light(solved)
          ? percent(std::abs(solved.solution.energy.imbalance())) + " of the light is missing or too much with " +
                name_of(then) + ": "
          : "error up to " + percent(error) + " with " + name_of(then) + ", asked for " + percent(target) + ": ";
  return reached + name_of(coming) + " is expected to reach " +
         (expected <= target ? "it" : percent(expected) + " only") + ", in about " +
         duration(seconds * times_longer(solved.settings, now, next)) + " and " + bytes(memory);
}

void say_coarser(Solution& solution, Accuracy level, Accuracy asked) {
  const auto name = [](Accuracy a) { return std::string(kAccuracyNames[static_cast<std::size_t>(a)]); };
  if (solution.stop == StopReason::converged) solution.stop = StopReason::time_limit;
  if (solution.stopped_at.empty())
    solution.stopped_at = "accuracy " + name(level) + ", as " + name(asked) + " would have taken longer";
}

constexpr double kHelped = 0.9;  ///< of the error before: else finer rounds are of no use

bool is_better(const Solved& a, const Solved& b) {
  if (!a.error || !b.error) return a.error.has_value();
  if (meets_target(a) != meets_target(b)) return meets_target(a);
  return worst_error(a) <= worst_error(b);
}

}  // namespace

bool meets_target(const Solved& s) {
  if (!s.settings.target_error) return true;
  return s.error && worst_error(s) <= *s.settings.target_error && keeps_its_light(s);
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
  auto round_start = Clock::now();
  const auto attempt = [&](Settings settings, bool may_start_with_draft) {
    const Accuracy level = settings.solve.accuracy;
    if (may_start_with_draft) settings.solve.at_most = level, settings.solve.accuracy = Accuracy::draft;
    std::optional<Solved> solved = round(settings, monitor, seconds);
    if (solved && solved->rather) {
      Settings finer = settings;
      finer.solve.at_most = finer.solve.accuracy = *solved->rather;
      try {
        solved = round(finer, monitor, seconds);
        settings = finer;
      } catch (const InputError&) {  // more memory than the limit leaves
        settings.solve.at_most = settings.solve.accuracy;
        solved = round(settings, monitor, seconds);
      }
    }
    if (!solved) {
      solved.emplace();
      solved->solution.stop = StopReason::interrupted;
    }
    if (settings.solve.accuracy < level) say_coarser(solved->solution, settings.solve.accuracy, level);
    solved->settings = settings;
    return std::move(*solved);
  };
  const bool has_target = asked.target_error.has_value();
  Solved best = attempt(has_target ? of_round(asked, 0) : asked, !has_target && may_be_too_much(asked, monitor));
  std::size_t now = 0;
  while (!best.empty() && !meets_target(best) && !monitor.should_stop() && now + 1 < kTargetRounds.size()) {
    const double error = worst_error(best);
    std::size_t next = round_for(*asked.target_error / kConfidence, now, worst(best, &Largest::measured));
    const double took = std::chrono::duration<double>(Clock::now() - round_start).count();
    const std::size_t wanted = next;
    while (next > now && took * times_longer(asked, now, next) > monitor.seconds_left()) --next;
    observer.step(expectation(best, now, next > now ? next : wanted, took));
    // What is solved already must not be lost to a try that needs too much.
    try {
      if (next == now) {
        const bool use_rest = now == 0 && may_be_too_much(asked, monitor) && took < monitor.seconds_left();
        observer.step(use_rest ? "there is no time for it; what there is time for comes instead"
                               : "there is no time for it");
        best.solution.stop = StopReason::time_limit;
        if (!use_rest) break;
        Solved finer = attempt(of_round(asked, kFinestLevel), true);
        if (!finer.empty() && is_better(finer, best)) best = std::move(finer);
        if (meets_target(best)) best.solution.stop = StopReason::converged, best.solution.stopped_at.clear();
        break;
      }
      round_start = Clock::now();
      Settings of_next = of_round(asked, next);
      of_next.solve.good_rooms = good_rooms(best);
      Solved finer = attempt(of_next, false);
      now = next;
      if (finer.empty() || !finer.error) break;
      const double then = worst_error(finer);
      const bool helped = then <= kHelped * error || !keeps_its_light(finer);
      if (is_better(finer, best)) best = std::move(finer);
      if (!helped && !meets_target(best) && !monitor.should_stop()) {
        observer.step("error up to " + percent(then) + " with " + name_of(kTargetRounds[now]) +
                      ": finer elements and more rays hardly help, so this was the last" +
                      (worst_error(best) < then ? ", and the one before is kept" : ""));
        break;
      }
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
