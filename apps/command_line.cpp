#include "apps/command_line.h"

#include <iostream>

#include <CLI/CLI.hpp>

#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "solver/model/version.h"

namespace clerestory {
namespace {

void add_commands(CLI::App& program, Task& task) {
  add_solve_command(program, task);
  add_check_command(program, task);
  add_mesh_command(program, task);
  add_bake_command(program, task);
  add_formfactors_command(program, task);
  add_tradeoff_command(program, task);
  add_report_command(program, task);
  add_annual_command(program, task);
  add_merge_command(program, task);
  add_render_command(program, task);
  add_mix_command(program, task);
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

}  // namespace

std::variant<Task, ExitCode> read_command_line(int argc, const char* const* argv) {
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
    program.exit(help_or_version);
    return kDone;
  } catch (const CLI::ParseError& error) {
    std::cerr << "error: " << message_line(usage_problem(program, error), 80) << "\nSee clerestory --help."
              << std::endl;
    return kWrongUsage;
  }
  return task;
}

}  // namespace clerestory
