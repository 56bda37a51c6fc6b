// Any bytes as a number, an amount of memory, and a piece of a message.

#include <cmath>

#include "io/memory_size.h"
#include "io/text.h"
#include "tests/fuzz/fuzz_input.h"

namespace clerestory {
namespace {

/// What strtod makes of it, as far as it knows the same numbers: no hexadecimal ones, no blanks before it.
void compare_with_strtod(const std::string& s, const std::optional<double>& number) {
  if (s.empty() || s.find_first_of("xX \t\r\n\v\f") != s.npos || s.find('\0') != s.npos) return;
  char* end = nullptr;
  const double expected = std::strtod(s.c_str(), &end);
  if (end != s.c_str() + s.size() || std::isnan(expected)) return;
  require(number.has_value(), "a number is not read");
  // Both round to the nearest; below the smallest normal number 0 will do.
  require(*number == expected || (std::abs(expected) < 1e-307 && std::abs(*number) < 1e-307),
          "a number is read as another");
}

}  // namespace
}  // namespace clerestory

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  const std::string s(reinterpret_cast<const char*>(data), size);
  compare_with_strtod(s, to_number(s));
  if (const auto bytes = to_memory_size(s)) require(*bytes >= 1u << 20, "an amount of memory is below 1 MiB");
  const std::string clean = clean_text(s);
  require(clean_text(clean) == clean && clean.size() <= s.size(), "clean text is not clean");
  for (const char c : clean) require(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f, "clean text has a control");
  require(quotable(s).size() <= 60 + 3, "a quotation is long");
  std::string_view rest = s;
  std::size_t letters = 0;
  for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) letters += word.size();
  require(rest.empty() && letters <= s.size(), "words do not end where the text does");
  ++fuzz_tally.read;
  return 0;
}
