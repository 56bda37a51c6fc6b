#pragma once
// What a sweep over methods and accuracies found: time, memory and error of each run.

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace clerestory {

struct Tradeoff {
  /// True error of a written field, against the reference of the sweep [1].
  struct Error {
    double rms = 0;                       ///< of the mean
    double median = 0, p95 = 0, p99 = 0;  ///< of each point's own value
    double bias = 0;                      ///< of the mean; below 0: too dark
    double confidence = 0;                ///< half-width of the 95 % interval of rms
    bool bound = false;                   ///< smaller than what the reference tells: rms is an upper bound
  };
  struct Row {
    std::string method, settings;
    double wall_s = 0, cpu_s = 0;
    std::size_t peak_bytes = 0, elements = 0, links = 0;
    unsigned long long rays = 0;
    std::string space;                  ///< the room that `worst` is about
    Error worst, all;                   ///< of the worst room, and of all surfaces
    double said_rms = 0, said_p95 = 0;  ///< of its worst room, as the run says itself; NaN: it does not
    bool said_bound = false;
    bool at_front = false;  ///< no other run is as fast and as near to the reference
  };
  struct LeftOut {
    std::string method, settings, why;
  };
  struct Choice {
    double target = 0;               ///< rms in the worst room [1]
    std::optional<std::size_t> row;  ///< the fastest that keeps it, its confidence included; none does
  };

  std::string input, version;
  std::vector<Row> rows;  ///< method by method, from coarse to fine
  std::vector<LeftOut> left_out;
  std::vector<Choice> choices;
  struct Reference {
    std::size_t points = 0;
    long long paths = 0;       ///< from each point
    bool has_gathers = false;  ///< and two gathers from each, of which paths tell the level
    double std_error = 0;  ///< root mean square of the points' own, of the mean, in the worst of the rows' rooms [1]
    double seconds = 0;
    std::vector<std::string> not_told;  ///< rooms whose light it does not find well enough to judge any run
  } reference;
};

inline constexpr std::array<double, 4> kTradeoffTargets = {0.10, 0.05, 0.02, 0.01};

/// Fills at_front and choices from the rows.
void choose(Tradeoff& tradeoff);

/// "--method hierarchical --accuracy draft": what to give to `solve`.
std::string name_of(const Tradeoff::Row& row);
/// "1.2 %", or "below 1.2 %" of a bound.
std::string share_text(double share, bool bound = false);
/// A line a target: which run to choose, its time and its error; or that none keeps it.
std::vector<std::string> choices_as_text(const Tradeoff& tradeoff);
/// How sharp the reference is, in a sentence.
std::string reference_as_text(const Tradeoff& tradeoff);

/// method,settings,wall_s,...: a line a row.
std::string tradeoff_csv(const Tradeoff& tradeoff);

/// One page that needs nothing else: choices, chart, table, what was left out.
std::string tradeoff_page(const Tradeoff& tradeoff);

}  // namespace clerestory
