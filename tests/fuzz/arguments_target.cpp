// Any words as a command line: a task that is not run, or an exit code with a message; never anything else.

#include <iostream>
#include <sstream>

#include "apps/command_line.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  // Words are lines, as those of a file; no word holds a zero.
  std::vector<std::string> words{"clerestory"};
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  for (std::string line; words.size() < 64 && std::getline(lines, line);) words.push_back(line.c_str());
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());

  std::ostringstream out, err;
  std::streambuf* const to_out = std::cout.rdbuf(out.rdbuf());
  std::streambuf* const to_err = std::cerr.rdbuf(err.rdbuf());
  const auto asked = read_command_line(static_cast<int>(argv.size()), argv.data());
  std::cout.rdbuf(to_out), std::cerr.rdbuf(to_err);
  if (const ExitCode* code = std::get_if<ExitCode>(&asked)) {
    require(*code == kDone ? !out.str().empty() : *code == kWrongUsage && err.str().starts_with("error: "),
            "it ends without a word");
    ++fuzz_tally.refused;
  } else {
    require(static_cast<bool>(std::get<Task>(asked)), "there is no task");
    ++fuzz_tally.read;
  }
  return 0;
}
