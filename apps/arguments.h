#pragma once
// Options that several commands share.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/read_scene.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace clerestory {

struct CommonArguments {
  int threads = 0;                    ///< 0: all cores
  std::optional<std::uint64_t> seed;  ///< of all random numbers; empty: the scene file's, or 1
  bool quiet = false, verbose = false;
  std::string log, report;  ///< files; empty when not asked for
};

/// --threads, --seed, --quiet, --verbose, --log, --report
void add_common_options(CLI::App& command, CommonArguments& arguments);

/// SOLUTION, of a command that starts from a result.
void add_solution_input(CLI::App& command, std::string& input,
                        const std::string& help = "a result of clerestory solve");

/// INPUT, --unit, --up, --sky, --gloss
void add_input_options(CLI::App& command, std::string& input, ReadOptions& options);

/// An option that takes one of some words.
void add_choice(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                const std::vector<std::string>& choices, const std::string& help);

/// An option that takes a name; `problem` says why not, or nothing.
CLI::Option* add_checked_word(CLI::App& command, const std::string& name, std::optional<std::string>& value,
                              const std::function<std::string(const std::string&)>& problem, const std::string& help);

/// --detail
void add_detail_option(CLI::App& command, std::optional<double>& detail);

/// An option that takes a number above 0, with its unit in the help.
void add_positive_option(CLI::App& command, const std::string& name, std::optional<double>& value,
                         const std::string& unit, const std::string& help);

/// --exposure, in stops
void add_exposure_option(CLI::App& command, double& exposure);

/// Refuses an output that does not end in the extension, or in one of several, as a slip of the pen.
void require_extension(CLI::App& command, const std::string& option, const std::vector<std::string>& extensions);

}  // namespace clerestory
