// clerestory: one program, one command a file in commands/.

#include <exception>
#include <iostream>
#include <new>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <unistd.h>

#include "apps/commands/commands.h"
#include "apps/run.h"
#include "io/atomic_file.h"
#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "solver/model/version.h"

namespace clerestory {
namespace {

void add_commands(CLI::App& program, Task& task) {
  add_solve_command(program, task);
  add_check_command(program, task);
  add_mesh_command(program, task);
  add_formfactors_command(program, task);
}

std::string nearest(const std::string& mistyped, const std::vector<std::string>& known) {
  const std::vector<std::string_view> names(known.begin(), known.end());
  return suggestion(mistyped, names);
}

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// CLI11 says what was not expected; a person also wants to know what was.
std::string usage_problem(const CLI::App& program, const CLI::ParseError& error) {
  const auto chosen = program.get_subcommands();
  const CLI::App& reader = chosen.empty() ? program : *chosen.front();
  const std::vector<std::string> extra = reader.remaining();
  if (extra.empty()) return error.what();
  const std::string word = extra.front().substr(0, extra.front().find('='));
  if (word.starts_with("-"))
    return "option '" + word + "' is not known" + (chosen.empty() ? "" : " to " + reader.get_name()) + "; " +
           nearest(word, option_names(reader));
  if (chosen.empty()) return "'" + word + "' is not a command; " + nearest(word, command_names(program));
  return "'" + word + "' is one argument too many";
}

/// Whoever started this may have closed standard input, output or error. The first files to be opened would get their
/// numbers, and every message would go into them.
void open_standard_files() {
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(number, F_GETFD) < 0) ::open("/dev/null", number == STDIN_FILENO ? O_RDONLY : O_WRONLY);
}

/// What is thrown where nobody can catch it, as by a thread that a library makes.
[[noreturn]] void on_terminate() {
  remove_temporaries();
  try {
    if (const auto thrown = std::current_exception()) std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    std::cerr << "error: " << kOutOfMemory << std::endl;
    ::_exit(kInputRefused);
  } catch (const std::exception& e) {
    std::cerr << "error: internal failure: " << e.what() << std::endl;
  } catch (...) {
  }
  ::_exit(kInternalFailure);
}

int run_program(int argc, char** argv) {
  CLI::App program("Clerestory: where light goes in a building, by radiosity", "clerestory");
  program.set_version_flag("--version", "clerestory " + std::string(kVersion));
  program.require_subcommand(1);
  program.footer(
      "clerestory COMMAND --help tells more.\nexample: clerestory solve data/scenes/office.json -o office.vtp");
  Task task;
  add_commands(program, task);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help_or_version) {
    return program.exit(help_or_version);
  } catch (const CLI::ParseError& error) {
    std::cerr << "error: " << message_line(usage_problem(program, error), 80) << "\nSee clerestory --help."
              << std::endl;
    return kWrongUsage;
  }
  return task();
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  clerestory::open_standard_files();
  std::set_terminate(clerestory::on_terminate);
  return clerestory::run_program(argc, argv);
}
