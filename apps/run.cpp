#include "apps/run.h"

#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>

#include "solver/model/error.h"

namespace clerestory {

namespace {

/// A slip of the pen must not cost the user a scene.
void refuse_to_overwrite(const std::string& input, const std::string& option, const std::string& output) {
  std::error_code not_there;
  if (!output.empty() && std::filesystem::equivalent(input, output, not_there))
    throw InputError(option + " " + output + ": is the input; choose another file for it.");
}

}  // namespace

ExitCode run(const CommonArguments& arguments, const std::string& input,
             const std::function<ExitCode(Console&)>& work) {
  std::optional<Console> console;
  const auto fail = [&](const std::string& message, ExitCode code) {
    if (console)
      console->fail(message);
    else
      std::cerr << "error: " << message << std::endl;
    return code;
  };
  try {
    refuse_to_overwrite(input, "--log", arguments.log);
    refuse_to_overwrite(input, "--report", arguments.report);
    console.emplace(arguments);
    return work(*console);
  } catch (const InputError& e) {
    return fail(e.what(), kInputRefused);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory for this model at this fineness; try a larger --max-element, or --accuracy draft.",
                kInputRefused);
  } catch (const std::exception& e) {
    return fail(std::string("internal failure: ") + e.what() + "; this is a mistake of the program, please report it.",
                kInternalFailure);
  }
}

}  // namespace clerestory
