#include "apps/run.h"

#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <optional>

#include "solver/model/error.h"

namespace clerestory {

namespace {

namespace fs = std::filesystem;

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  const fs::file_status status = fs::status(a, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) return false;  // /dev/null takes all there is
  if (fs::equivalent(a, b, error)) return true;
  const auto place = [&](const std::string& file) { return fs::weakly_canonical(fs::absolute(file, error), error); };
  return !place(a).empty() && place(a) == place(b);
}

/// A slip of the pen must not cost the user a scene, nor one result the other.
void refuse_to_overwrite(const std::string& input, const std::vector<NamedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto& [option, file, is_written] = files[i];
    if (file.empty()) continue;
    if (is_written && is_same_file(file, input))
      throw InputError(option + " " + file + ": is the input; choose another file for it.");
    for (std::size_t k = 0; k < i; ++k) {
      if (files[k].file.empty() || !(is_written || files[k].is_written) || !is_same_file(file, files[k].file)) continue;
      throw InputError(option + " " + file + ": is the file of " + files[k].option +
                       " too; choose another for one of them.");
    }
  }
}

}  // namespace

ExitCode run(const CommonArguments& arguments, const std::string& input, std::vector<NamedFile> files,
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
    files.push_back({"--log", arguments.log});
    files.push_back({"--report", arguments.report});
    refuse_to_overwrite(input, files);
    console.emplace(arguments);
    return work(*console);
  } catch (const Interrupted& e) {
    if (console) console->warn(e.what());
    return kInterrupted;
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
