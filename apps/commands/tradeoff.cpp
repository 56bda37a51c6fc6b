// clerestory tradeoff: what time buys on this scene, method by method and level by level.

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <CLI/CLI.hpp>

#include "apps/commands/commands.h"
#include "apps/finish_report.h"
#include "apps/run.h"
#include "apps/sweep.h"
#include "io/atomic_file.h"
#include "io/output_folder.h"
#include "io/picture/encode.h"
#include "pipeline/lap.h"
#include "pipeline/settings.h"
#include "pipeline/tradeoff/tradeoff_chart.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

constexpr double kUsualLimit = 600;        ///< [s]
constexpr double kShareOfRuns = 0.75;      ///< of the time limit; the reference has the rest
constexpr double kLeastForReference = 30;  ///< [s]
constexpr int kFirstPaths = 8;
constexpr const char* kFiles[] = {"tradeoff.csv", "tradeoff.svg", "tradeoff.png", "index.html"};

struct Arguments {
  CommonArguments common;
  ReadOptions read;
  std::string input, folder;
  std::optional<double> time_limit;
};

/// throws  InputError when DIR cannot be one.
void check_folder(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) return;
  if (!fs::is_directory(folder, error))
    throw InputError("-o " + folder.string() + ": is a file; give a folder, which is made when there is none.");
  for (const char* file : kFiles) check_writable(folder / file);
}

/// What holds for every run, and may not be meant to.
void warn_about_settings(const Scene& scene, Console& console) {
  const SolverSettings& s = scene.settings;
  std::string names;
  const auto add = [&](bool is_set, const char* name) {
    if (is_set) names += (names.empty() ? "" : ", ") + std::string(name);
  };
  add(s.target_error.has_value(), "target_error"), add(s.time_limit.has_value(), "time_limit");
  add(s.memory_limit.has_value(), "memory_limit"), add(s.max_element.has_value(), "max_element");
  if (!names.empty())
    console.warn(scene.file + ": solver." + names +
                 " of the scene holds for every run; leave it out to compare levels.");
}

Clock::time_point after(Clock::time_point start, double seconds) {
  constexpr double kNever = 1e9;
  return start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, kNever)));
}

void say_table(const Tradeoff& t, Console& console) {
  console.say(t.input + ": " + counted(t.rows.size(), "run") +
              (t.left_out.empty() ? "" : ", " + std::to_string(t.left_out.size()) + " left out"));
  for (const Tradeoff::Row& r : t.rows)
    console.say("  " + r.method + " " + r.settings + ": " + duration(r.wall_s) + ", " + bytes(r.peak_bytes) + ", rms " +
                share_text(r.worst.rms, r.worst.bound) +
                (r.worst.bound ? "" : " (+- " + share_text(r.worst.confidence) + ")") + ", p95 " +
                share_text(r.worst.p95) + ", said " + share_text(r.said_rms, r.said_bound));
  console.say("fastest for an rms in the worst room of");
  for (const std::string& line : choices_as_text(t)) console.say("  " + line);
  console.say("  " + reference_as_text(t));
}

void write_outputs(const fs::path& folder, const Tradeoff& t, Outputs& outputs) {
  const Chart chart = tradeoff_chart(t);
  outputs.open(folder / "tradeoff.csv").write(tradeoff_csv(t));
  outputs.open(folder / "tradeoff.svg").write(svg_of(chart));
  outputs.open(folder / "tradeoff.png").write(png_of(chart));
  outputs.open(folder / "index.html").write(tradeoff_page(t));
}

ExitCode tradeoff_command(const Arguments& arguments, Console& console) {
  const fs::path folder = arguments.folder;
  check_folder(folder);
  require_picture_files();
  Lap lap;
  RunReport report = new_report(arguments.input);
  Scene scene = read_scene(arguments.input, arguments.read);
  console.has_read(scene.files);
  warn_about_settings(scene, console);
  lap.add_to(report.seconds.read);

  const double limit = arguments.time_limit.value_or(kUsualLimit);
  const std::uint64_t seed = arguments.common.seed.value_or(settings_of(scene).solve.seed);
  const auto no_time = [&] {
    console.warn("the time limit of " + rounded(limit) +
                 " s came before a run ended; nothing is written. Give it more.");
    return kAccuracyNotReached;
  };
  const auto end_of_runs = after(console.start(), kShareOfRuns * limit);
  std::optional<SweepReference> made;
  try {
    made.emplace(scene, seed, console, end_of_runs);
  } catch (const SweepReference::OutOfTime&) {
    return no_time();
  }
  SweepReference& reference = *made;
  Monitor in_time = console.monitor();
  in_time.deadline = end_of_runs;
  if (!reference.add_paths(kFirstPaths, in_time)) return no_time();
  make_folder(folder);
  console.has_result();  // from here on a signal must end the runs, too
  const WorkFolder work(folder);
  const auto start = Clock::now();
  const Sweep sweep = run_all(arguments.input, arguments.read, arguments.common, reference, work, end_of_runs, console);
  if (sweep.runs.empty() && console.should_stop()) {
    console.warn("interrupted before a run ended; nothing is written.");
    return kInterrupted;
  }
  if (sweep.runs.empty() && end_of_runs <= Clock::now()) return no_time();
  if (sweep.runs.empty()) throw InputError("no run gave a result: " + sweep.left_out.front().why);

  const double for_reference =
      std::max(kLeastForReference, std::chrono::duration<double>(Clock::now() - start).count());
  const double seconds =
      sharpen(reference, sweep, std::min(after(Clock::now(), for_reference), after(console.start(), limit)), console);
  Tradeoff t = judge(sweep, reference);
  t.input = report.input, t.version = report.version, t.reference.seconds = seconds;

  Outputs outputs;
  write_outputs(folder, t, outputs);
  report.settings = {{"time_limit", limit}, {"seed", static_cast<long long>(seed)}};
  finish_report(report, arguments.common, console, outputs);
  say_table(t, console);
  console.commit(outputs);
  console.say("  results " + (folder / "index.html").string() + ", tradeoff.csv, tradeoff.svg, tradeoff.png");
  if (!console.should_stop()) return kDone;
  console.warn("interrupted; the runs that had ended are written.");
  return kInterrupted;
}

}  // namespace

void add_tradeoff_command(CLI::App& program, Task& task) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *program.add_subcommand(
      "tradeoff", "solve by every method and accuracy: time, memory and true error, and which to choose");
  add_input_options(command, arguments->input, arguments->read);
  command
      .add_option("-o,--output", arguments->folder,
                  "folder for tradeoff.csv, .svg, .png and index.html; made if missing")
      ->type_name("DIR")
      ->required();
  add_positive_option(command, "--time-limit", arguments->time_limit, "S",
                      "of all together; what does not fit is left out (default: 600)");
  add_common_options(command, arguments->common);
  command.footer("example: clerestory tradeoff data/scenes/office.json -o office_tradeoff");
  command.callback([arguments, &task] {
    task = [arguments] {
      std::vector<NamedFile> files;
      for (const char* file : kFiles) files.push_back({"-o", (fs::path(arguments->folder) / file).string()});
      return run(arguments->common, arguments->input, std::move(files),
                 [&](Console& console) { return tradeoff_command(*arguments, console); });
    };
  });
}

}  // namespace clerestory
