#pragma once
// All methods and accuracies on one scene, each in a process of its own, and what their results are worth.

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/arguments.h"
#include "apps/console.h"
#include "io/read_scene.h"
#include "pipeline/tradeoff/sweep_reference.h"
#include "pipeline/tradeoff/tradeoff.h"

namespace clerestory {

/// A folder for files in between, gone at the end. What killed sweeps left beside it is removed.
class WorkFolder {
 public:
  /// throws  InputError when it cannot be made.
  explicit WorkFolder(const std::filesystem::path& in);
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

struct SweptRun {
  Tradeoff::Row row;      ///< without errors
  std::vector<double> E;  ///< the written field at the points of the reference [lx]
};

struct Sweep {
  std::vector<SweptRun> runs;  ///< method by method, from coarse to fine
  std::vector<Tradeoff::LeftOut> left_out;
};

/// `clerestory solve` by every method at every accuracy, as far as `end` and the console let it; a run that is refused,
/// fails or finds no time is left out.
Sweep run_all(const std::string& input, const ReadOptions& read, const CommonArguments& common,
              const SweepReference& reference, const WorkFolder& folder, std::chrono::steady_clock::time_point end,
              Console& console);

/// Traces paths until the reference's own error is a third of every row's, or `end`. Where these would stay above 1 %
/// of a room's mean, it gathers, too. returns  the seconds it took.
double sharpen(SweepReference& reference, const Sweep& sweep, std::chrono::steady_clock::time_point end,
               Console& console);

/// All but input, version and the time that the reference took.
Tradeoff judge(const Sweep& sweep, const SweepReference& reference);

}  // namespace clerestory
