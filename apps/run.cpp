#include "apps/run.h"

#include <exception>
#include <iostream>
#include <new>
#include <optional>

#include "solver/model/error.h"

namespace clerestory {

ExitCode run(const CommonArguments& arguments, const std::function<ExitCode(Console&)>& work) {
  std::optional<Console> console;
  const auto fail = [&](const std::string& message, ExitCode code) {
    if (console)
      console->fail(message);
    else
      std::cerr << "error: " << message << std::endl;
    return code;
  };
  try {
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
