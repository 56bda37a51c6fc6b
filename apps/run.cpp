#include "apps/run.h"

#include <cerrno>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <system_error>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

ExitCode run(const CommonArguments& arguments, const std::string& input, std::vector<NamedFile> files,
             const std::function<ExitCode(Console&)>& work) {
  std::optional<Console> console;
  const auto fail = [&](const std::string& message, ExitCode code) {
    if (console)
      console->fail(message);
    else
      std::cerr << "error: " << message_line(message) << std::endl;
    return code;
  };
  const auto out_of_memory = [&] { return fail(kOutOfMemory, kInputRefused); };
  try {
    files.insert(files.begin(), {kInput, input, false});
    files.push_back({"--log", arguments.log});
    files.push_back({"--report", arguments.report});
    console.emplace(arguments, std::move(files));
    return work(*console);
  } catch (const InputError& e) {
    return fail(e.what(), kInputRefused);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::system_error& e) {  // a thread that cannot be made
    if (e.code() == std::errc::resource_unavailable_try_again || e.code() == std::errc::not_enough_memory)
      return out_of_memory();
    return fail(std::string("internal failure: ") + e.what() + kPleaseReport, kInternalFailure);
  } catch (const std::exception& e) {
    return fail(std::string("internal failure: ") + e.what() + kPleaseReport, kInternalFailure);
  }
}

}  // namespace clerestory
