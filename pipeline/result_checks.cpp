#include "pipeline/result_checks.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "pipeline/wording.h"
#include "solver/model/units.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

constexpr double kMostImbalance = 0.01;

bool was_stopped(const Solved& s) {  // perhaps in the midst
  return s.solution.stop == StopReason::time_limit || s.solution.stop == StopReason::interrupted;
}

/// What helps.
std::string cure(const Solved& s, const std::string& otherwise) {
  return was_stopped(s) ? "it was stopped before its end; give it more time." : otherwise;
}

void warn_about_energy(const Solved& s, Observer& observer) {
  if (keeps_its_light(s)) return;
  const EnergyBalance& energy = s.solution.energy;
  const double off = energy.imbalance();
  const std::string what_helps = " Do not rely on them; " + cure(s, "try --accuracy fine or a smaller --max-element.");
  const std::string lumen = rounded(kWhiteEfficacy * std::abs(off) * energy.emitted) + " lm of " +
                            rounded(kWhiteEfficacy * energy.emitted) + " lm";
  observer.warn(off > 0 ? percent(off) + " of the light is missing from this result (" + lumen +
                              "): illuminances are too low, not everywhere alike." + what_helps
                        : "this result holds " + percent(-off) + " more light than was sent (" + lumen +
                              "): illuminances are too high, not everywhere alike." + what_helps);
}

/// Light that no path of the measurement met may come through a gap too small for them.
void warn_about_unknown(const Solved& s, Observer& observer) {
  if (!s.error || s.solution.stop != StopReason::converged) return;
  const std::vector<const ErrorOfPart*> unknown = s.error->unknown();
  if (unknown.empty()) return;
  const ErrorOfPart& brightest = **std::ranges::max_element(unknown, {}, &ErrorOfPart::mean_illuminance);
  observer.warn("how wrong '" + brightest.name + "' " +
                (unknown.size() > 1 ? "and " + counted(unknown.size() - 1, "other room") + " are" : std::string("is")) +
                ", is not known: it shows " + rounded(brightest.mean_illuminance) +
                " lx in the mean, but no light was found on the paths that measure the error there. Do not rely on it; "
                "try --error-samples 4096, or look for a small gap in the model.");
}

/// "; so it is in 'hall', 21.0 %, and 3 more rooms": those but the worst that are above what the accuracy stands for.
std::string rooms_above(double stated, const MeasuredError& error, const ErrorOfPart* worst) {
  constexpr std::size_t kShown = 3;
  std::vector<const ErrorOfPart*> above;
  for (const ErrorOfPart& part : error.parts)
    if (&part != worst && error.counts(part) && part.figures.samples > 0 && part.figures.lower() > stated)
      above.push_back(&part);
  std::ranges::sort(above, std::greater<>(), [](const ErrorOfPart* p) { return p->figures.rms_relative; });
  std::string text;
  for (std::size_t k = 0; k < std::min(kShown, above.size()); ++k)
    text += (k == 0 ? "; so it is in '" : ", '") + above[k]->name + "', " + percent(above[k]->figures.rms_relative);
  if (above.size() > kShown) text += ", and " + counted(above.size() - kShown, "more room");
  return text;
}

void warn_about_error(const Solved& s, Observer& observer) {
  if (!s.error || s.settings.target_error) return;  // a target that is missed is said by who asked for it
  const double stated = effort(s.settings.solve.accuracy).vertex_tolerance;
  const ErrorOfPart* worst = s.error->worst();
  const bool is_in_room = worst && worst->figures.lower() > s.error->lower();
  const ErrorFigures& e = is_in_room ? worst->figures : *s.error;
  if (e.lower() <= stated) return;
  observer.warn("the measured error " + (is_in_room ? "in '" + worst->name + "' " : std::string()) + "is " +
                percent(e.rms_relative) + " rms (+- " + percent(e.confidence) + "), more than the " + percent(stated) +
                " that this accuracy stands for" + (is_in_room ? rooms_above(stated, *s.error, worst) : std::string()) +
                ": " +
                (is_by_paths(s.settings.solve.method) || s.settings.solve.method == Method::particles
                     ? "too few " + std::string(is_by_paths(s.settings.solve.method) ? "paths" : "particles") +
                           " find the light. Do not rely on single values; try --accuracy fine."
                     : "light changes faster than the elements show, beside a lamp or a narrow gap. Do not rely on "
                       "single values of the picture; " +
                           cure(s, "try --accuracy fine, a smaller --max-element or --target-error.")));
}

void warn_about_sensors(const Solved& s, Observer& observer) {
  if (!s.error || s.sensor_E.size() == 0) return;
  double most = 0;
  for (std::size_t k = 0; k < s.sensor_E.size(); ++k) most = std::max(most, photometric(s.sensor_E[k]));
  if (!s.error_sensors) {
    if (most == 0 || was_stopped(s) || s.buried_sensors >= s.sensor_E.size()) return;
    observer.warn(
        "how wrong the sensors are is not known: they show up to " + rounded(most) +
        " lx, but no light was found on the paths that measure the error, so it comes through a gap too small "
        "for them. Close the gap in the model, or do not rely on these values.");
    return;
  }
  const double stated = effort(s.settings.solve.accuracy).vertex_tolerance;
  const ErrorOfPart* worst = s.error_sensors->worst();
  const bool is_in_set =
      worst && s.error_sensors->parts.size() > 1 && worst->figures.lower() > s.error_sensors->lower();
  const ErrorFigures& e = is_in_set ? worst->figures : *s.error_sensors;
  constexpr double kUseless = 0.5;  // of a bound
  if (e.bound && e.rms_relative > kUseless)
    return observer.warn("how wrong the sensors are is hardly known: below " + percent(e.rms_relative) +
                         " rms is all that the paths tell which measure it. Do not rely on them; " +
                         cure(s, "try --error-samples 4096."));
  if (e.lower() <= stated) return;
  observer.warn("the measured error of the sensors " + (is_in_set ? "'" + worst->name + "' " : std::string()) + "is " +
                percent(e.rms_relative) + " rms (+- " + percent(e.confidence) + "), more than the " + percent(stated) +
                " that this accuracy stands for: their light comes from little lamps, through narrow gaps or over many "
                "surfaces. Do not rely on single values; " +
                cure(s, "try --accuracy fine."));
}

/// What it means for a person when a law is broken.
std::string broken(Law law) {
  switch (law) {
    case Law::reciprocity:
      return "two surfaces exchange light as if one saw more of the other than the other of it (reciprocity)";
    case Law::row_sums:
      return "more or less light leaves a surface than arrives elsewhere and is lost (row sums)";
    case Law::no_negative_light:
      return "there is less than no light on a surface";
    case Law::radiosity:
      return "what a surface sends is not what it emits and reflects";
    case Law::energy:
      return "there is more or less light than was sent there (energy)";
  }
  return {};
}

void warn_about_laws(const Solved& s, Observer& observer) {
  for (const LawCheck& check : s.laws) {
    const LawInRoom* worst = check.worst();
    if (check.holds() || !worst) continue;
    const auto others = std::ranges::count_if(check.rooms, [](const LawInRoom& room) { return !room.holds(); }) - 1;
    observer.warn("in '" + worst->room + "' " +
                  (others > 0 ? "and " + counted(static_cast<unsigned long long>(others), "other room") + " " : "") +
                  broken(check.law) + ": it is off by " + percent(worst->worst) + ", and up to " +
                  percent(worst->bound) +
                  " is what the accuracy and the check leave open. Do not rely on this result there; " +
                  cure(s, "try --accuracy fine, and look at the model for gaps and faces that lie in each other."));
  }
}

}  // namespace

bool keeps_its_light(const Solved& s) { return std::abs(s.solution.energy.imbalance()) <= kMostImbalance; }

bool keeps_laws(const Solved& s) { return std::ranges::all_of(s.laws, &LawCheck::holds); }

void warn_about_result(const Solved& solved, Observer& observer) {
  if (solved.empty()) return;
  warn_about_energy(solved, observer);
  warn_about_unknown(solved, observer);
  warn_about_error(solved, observer);
  warn_about_sensors(solved, observer);
  warn_about_laws(solved, observer);
}

}  // namespace clerestory
