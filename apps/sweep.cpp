#include "apps/sweep.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <optional>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "apps/exit_code.h"
#include "apps/timed_run.h"
#include "io/input_file.h"
#include "io/read_result.h"
#include "io/text.h"
#include "pipeline/tradeoff/field_error.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/model/method.h"

namespace clerestory {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::string_view kWork = ".sweep-";
constexpr double kNearer = 1.0 / 3;  ///< the reference's own error, as a share of each row's
constexpr double kFirstPart = 0.25;  ///< of its time, after which it is known how sharp paths will be
/// Paths that end blunter than this in some room get gathers beside them; these are from a radiosity that has some
/// tenths of a per cent of error of its own, so not before.
constexpr double kBlunt = 0.01, kVeryBlunt = 0.1;
constexpr double kNextLevel = 2;  ///< a finer level takes so much longer at least
constexpr int kMostAttempts = 16;
constexpr std::uintmax_t kMostReport = 1 << 30;

int lock_of(const fs::path& folder) {
  const int found = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
  if (found >= 0 && ::flock(found, LOCK_EX | LOCK_NB) == 0) return found;
  if (found >= 0) ::close(found);
  return -1;
}

/// Whether what was opened is still there by its name.
bool is_at(int opened, const std::string& name) {
  struct stat mine, there;
  return ::fstat(opened, &mine) == 0 && ::stat(name.c_str(), &there) == 0 && mine.st_ino == there.st_ino &&
         mine.st_dev == there.st_dev;
}

double left_until(Clock::time_point end) { return std::chrono::duration<double>(end - Clock::now()).count(); }

/// The reason that a run gave, without the word before it.
std::string reason_of(const TimedRun& run) {
  constexpr std::string_view kError = "error: ";
  for (const std::string& line : run.errors)
    if (line.starts_with(kError)) return quotable(line.substr(kError.size()), 400);
  if (run.exit_code > 128) return text("it was ended by signal ", run.exit_code - 128);
  return text("it ended with exit code ", run.exit_code);
}

/// A number of the report, NaN where it does not say.
double number_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_number() ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

struct Run {
  std::string method, settings;
  std::vector<std::string> arguments;
};

/// All of a level, then the next, so that one long run does not take the time of many; last the matrices, which grow
/// like the square of the elements.
std::vector<Run> runs_of(const std::string& input, const ReadOptions& read, const CommonArguments& common,
                         const fs::path& folder) {
  std::vector<std::string> shared = {"solve",
                                     input,
                                     "-o",
                                     folder / "run.vtp",
                                     "--report",
                                     folder / "run.json",
                                     "--quiet",
                                     "--threads",
                                     std::to_string(common.threads)};
  const auto add = [&](const char* option, const std::optional<std::string>& value) {
    if (value) shared.insert(shared.end(), {option, *value});
  };
  add("--unit", read.unit), add("--up", read.up), add("--sky", read.sky), add("--gloss", read.gloss);
  if (common.seed) shared.insert(shared.end(), {"--seed", std::to_string(*common.seed)});
  std::vector<Run> runs;
  for (const bool with_matrix : {false, true})
    for (const std::string_view accuracy : kAccuracyNames)
      for (std::size_t k = 0; k < std::size(kMethodNames); ++k) {
        const auto m = static_cast<Method>(k);
        if (has_matrix(m) != with_matrix) continue;
        const std::string method(kMethodNames[k]);
        runs.push_back({method, "--accuracy " + std::string(accuracy), shared});
        runs.back().arguments.insert(runs.back().arguments.end(),
                                     {"--method", method, "--accuracy", std::string(accuracy)});
      }
  return runs;
}

Tradeoff::Row row_of(const Run& run, const TimedRun& took, const Json& report) {
  Tradeoff::Row row;
  row.method = run.method, row.settings = run.settings;
  row.wall_s = took.wall_s, row.cpu_s = took.cpu_s;
  row.peak_bytes = report.at("peak_memory_bytes").get<std::size_t>();
  const Json& counts = report.at("counts");
  row.elements = counts.at("elements").get<std::size_t>();
  row.links = counts.at("links").get<std::size_t>();
  row.rays = counts.at("rays").get<unsigned long long>();
  const Json& error = report.at("error");
  const Json said = error.is_object() ? error.value("worst", error) : Json::object();
  row.said_rms = number_at(said, "rms_relative"), row.said_p95 = number_at(said, "p95_relative");
  row.said_bound = said.value("bound", false);
  return row;
}

}  // namespace

WorkFolder::WorkFolder(const fs::path& in) {
  std::error_code error;
  for (fs::directory_iterator entry(in, error), end; !error && entry != end; entry.increment(error)) {
    if (!entry->path().filename().string().starts_with(kWork)) continue;
    const int lock = lock_of(entry->path());
    if (lock < 0) continue;  // of a sweep that lives, or none of ours
    std::error_code ignored;
    fs::remove_all(entry->path(), ignored);
    ::close(lock);
  }
  // Until it is locked, a sweep that starts beside this one may take it for what a killed one left.
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    std::string name = (in / (std::string(kWork) + "XXXXXX")).string();
    if (!::mkdtemp(name.data()))
      throw InputError(in.string() + ": cannot make a folder in it: " + std::strerror(errno));
    lock_ = lock_of(name);
    const bool is_taken = lock_ < 0 ? errno == EWOULDBLOCK || errno == ENOENT : !is_at(lock_, name);
    if (!is_taken) {  // locked, or on a disk that has no locks, where nobody takes it either
      path_ = name;
      return;
    }
    if (lock_ >= 0) ::close(lock_);
    ::rmdir(name.c_str());
  }
  throw InputError(in.string() + ": others take every folder that is made in it; give each sweep a folder of its own.");
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

Sweep run_all(const std::string& input, const ReadOptions& read, const CommonArguments& common,
              const SweepReference& reference, const WorkFolder& folder, Clock::time_point end, Console& console) {
  Sweep sweep;
  const std::vector<Run> runs = runs_of(input, read, common, folder.path());
  std::map<std::string, double> took_before;  // by method, at the level before; infinite: there was no time for it
  for (std::size_t k = 0; k < runs.size() && !console.should_stop(); ++k) {
    const Run& run = runs[k];
    const std::string name = run.method + " " + run.settings;
    const auto leave_out = [&](const std::string& why) {
      sweep.left_out.push_back({run.method, run.settings, why});
      console.step(name + ": left out, " + why);
    };
    double& before = took_before[run.method];
    if (!(kNextLevel * before < left_until(end))) {
      leave_out(before > 0 && std::isfinite(before)
                    ? "there is no time for it: the level before took " + duration(before)
                    : "there is no time for it");
      before = std::numeric_limits<double>::infinity();
      continue;
    }
    console.progress(name, static_cast<double>(k) / static_cast<double>(runs.size()));
    const TimedRun took = run_timed(run.arguments, [&] { return console.should_stop() || left_until(end) <= 0; });
    if (console.should_stop()) break;
    before = took.was_ended ? std::numeric_limits<double>::infinity() : took.wall_s;
    if (took.was_ended) {
      leave_out("it did not end within the time that was left, " + duration(took.wall_s));
      continue;
    }
    if (took.exit_code != kDone && took.exit_code != kAccuracyNotReached) {
      leave_out(reason_of(took));
      continue;
    }
    if (!fs::exists(folder.path() / "run.vtp")) {  // the scene's own time limit
      leave_out("it ended without a result");
      continue;
    }
    const Json report = Json::parse(read_input_file(folder.path() / "run.json", kMostReport));
    const Json& repairs = report.at("repairs");
    // Where both lie relative to what was read, and what is left of digits.
    const double tolerance = reference.tolerance() + repairs.at("simplified_by").get<double>() +
                             number_at(repairs, "max_element") * 1e-3 + 1e-5 * reference.diagonal();
    const FieldValues field = values_at(reference.points(), read_result(folder.path() / "run.vtp"), tolerance);
    for (const char* file : {"run.vtp", "run.json", "run.sensors.csv"}) fs::remove(folder.path() / file);
    sweep.runs.push_back({row_of(run, took, report), field.E});
    const Tradeoff::Row& row = sweep.runs.back().row;
    console.step(name + ": " + duration(row.wall_s) + ", " + bytes(row.peak_bytes) + ", " +
                 counted(row.elements, "element") + ", says rms " + share_text(row.said_rms, row.said_bound) +
                 (took.exit_code == kDone ? "" : "; it stopped early") +
                 (field.not_shown > 0
                      ? "; shows nothing at " + counted(field.not_shown, "point") + " of " + grouped(field.E.size())
                      : ""));
  }
  // For readers, method by method.
  std::ranges::stable_sort(sweep.runs, {},
                           [](const SweptRun& run) { return std::ranges::find(kMethodNames, run.row.method); });
  return sweep;
}

double sharpen(SweepReference& reference, const Sweep& sweep, Clock::time_point end, Console& console) {
  const auto start = Clock::now();
  const double time = left_until(end);
  const Monitor monitor{.progress = {}, .interrupted = [&] { return console.should_stop(); }, .deadline = end};
  const auto in_some_room = [&](double std_error) {
    for (std::uint32_t k = 0; k < reference.rooms().size(); ++k)
      if (reference.rooms()[k].is_large && reference.std_error_of(k) > std_error) return true;
    return false;
  };
  const auto is_sharp = [&] {
    return !in_some_room(kVeryBlunt) && std::ranges::all_of(sweep.runs, [&](const SweptRun& run) {
      const FieldError error = error_of(reference, run.E);
      return !error.worst.bound && reference.std_error_of(error.room) <= kNearer * error.worst.rms_relative;
    });
  };
  double per_path = 0;  // [s]
  const auto add_paths = [&](double seconds_left) {
    while (!console.should_stop() && !is_sharp()) {
      constexpr double kLeastPaths = 64, kMostPaths = 1 << 22;  // a round, for counts in 32 bits
      double paths = std::clamp(static_cast<double>(reference.paths()), kLeastPaths, kMostPaths);
      const double left = left_until(end) - seconds_left;
      if (per_path > 0) paths = std::min(paths, 0.95 * left / per_path);
      if (paths < kLeastPaths || left <= 0) return;
      console.progress("reference", 1 - left_until(end) / time);
      const auto before = Clock::now();
      if (!reference.add_paths(static_cast<int>(paths), monitor)) return;
      per_path = std::chrono::duration<double>(Clock::now() - before).count() / paths;
    }
  };
  add_paths((1 - kFirstPart) * time);
  if (!console.should_stop() && !is_sharp() && in_some_room(kBlunt * std::sqrt(1 / kFirstPart))) {
    console.progress("gathers of the reference", 0);
    // At standard where a run at standard says that there is time.
    const auto fits = [&](const SweptRun& run) {
      return run.row.method == kMethodNames[0] && run.row.settings.ends_with("standard") &&
             kNextLevel * run.row.wall_s < left_until(end);
    };
    reference.add_gathers(std::ranges::any_of(sweep.runs, fits) ? Accuracy::standard : Accuracy::draft, monitor);
  }
  add_paths(0);
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Tradeoff judge(const Sweep& sweep, const SweepReference& reference) {
  const auto figures = [](const ErrorFigures& e) {
    return Tradeoff::Error{e.rms_relative,  e.median_relative, e.p95_relative, e.p99_relative,
                           e.bias_relative, e.confidence,      e.bound};
  };
  Tradeoff t;
  t.left_out = sweep.left_out;
  for (const SweptRun& run : sweep.runs) {
    const FieldError error = error_of(reference, run.E);
    Tradeoff::Row& row = t.rows.emplace_back(run.row);
    row.space = reference.rooms()[error.room].name;
    row.worst = figures(error.worst), row.all = figures(error.all);
    t.reference.std_error = std::max(t.reference.std_error, reference.std_error_of(error.room));
  }
  for (std::uint32_t k = 0; k < reference.rooms().size(); ++k)
    if (reference.rooms()[k].is_large && !reference.tells(k)) t.reference.not_told.push_back(reference.rooms()[k].name);
  t.reference.points = reference.points().size();
  t.reference.paths = reference.paths();
  t.reference.has_gathers = reference.has_gathers();
  choose(t);
  return t;
}

}  // namespace clerestory
