#include "io/text.h"

#include <cctype>
#include <charconv>
#include <limits>

namespace clerestory {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

}  // namespace

std::string to_lower(std::string_view s) {
  std::string lower(s);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
  return s;
}

std::string_view next_word(std::string_view& rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  std::size_t n = 0;
  while (n < rest.size() && !is_blank(rest[n])) ++n;
  const std::string_view word = rest.substr(0, n);
  rest.remove_prefix(n);
  return word;
}

std::optional<double> to_number(std::string_view s) {
  if (s.size() > 1 && s[0] == '+' && s[1] != '-') s.remove_prefix(1);  // from_chars knows no plus sign
  double value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (end != s.data() + s.size() || s.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {  // 1e-400 is 0, 1e400 is too much for anyone
    const std::size_t exponent = s.find_first_of("eE");
    const bool tiny = exponent != s.npos && exponent + 1 < s.size() && s[exponent + 1] == '-';
    return tiny ? 0.0 : std::numeric_limits<double>::infinity();
  }
  return error == std::errc{} ? std::optional(value) : std::nullopt;
}

std::string quotable(std::string_view s) {
  constexpr std::size_t kLongest = 60;
  std::string clean(s.substr(0, kLongest));
  for (char& c : clean) {
    if (c < 0x20 || c == 0x7f) c = '?';
  }
  return s.size() > kLongest ? clean + "..." : clean;
}

}  // namespace clerestory
