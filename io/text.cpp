#include "io/text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>

namespace clerestory {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f'; }

/// Not so: control characters beyond ASCII, blanks without width, marks that turn the direction of writing.
bool shows(std::string_view character) {
  if (character.size() == 2 && character[0] == '\xc2') return static_cast<unsigned char>(character[1]) >= 0xa0;
  if (character.size() != 3) return true;
  const auto between = [&](std::string_view first, std::string_view last) {
    return first <= character && character <= last;
  };
  return !between("\u200b", "\u200f") && !between("\u2028", "\u202e") && !between("\u2060", "\u206f") &&
         character != "\ufeff";
}

/// Of a decimal number that is not 0, by where its first digit above 0 stands: "0.001e2", "-.5".
bool is_below_one(std::string_view s) {
  const std::size_t e = std::min(s.find_first_of("eE"), s.size());
  const std::string_view digits = s.substr(0, e);
  const auto point = static_cast<long long>(std::min(digits.find('.'), digits.size()));
  const auto first = static_cast<long long>(digits.find_first_of("123456789"));
  std::string_view written = s.substr(std::min(e + 1, s.size()));
  const bool is_negative = written.starts_with('-');
  if (is_negative || written.starts_with('+')) written.remove_prefix(1);
  long long exponent = 0;  // stays 0 when there is none
  const auto parsed = std::from_chars(written.data(), written.data() + written.size(), exponent);
  if (parsed.ec == std::errc::result_out_of_range) return is_negative;
  // 10^(point - first - 1) has that digit before the point, as 10^(point - first) does behind it.
  return (is_negative ? -exponent : exponent) < (first < point ? first + 1 - point : first - point);
}

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

std::string_view unquoted(std::string_view s) {
  s = trimmed(s);
  const bool is_quoted = s.size() >= 2 && s.front() == s.back() && (s.front() == '"' || s.front() == '\'');
  return is_quoted ? trimmed(s.substr(1, s.size() - 2)) : s;
}

std::string_view next_word(std::string_view& rest) {
  while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
  std::size_t n = 0;
  while (n < rest.size() && !is_blank(rest[n])) ++n;
  const std::string_view word = rest.substr(0, n);
  rest.remove_prefix(n);
  return word;
}

std::string_view next_line(std::string_view& rest) {
  std::size_t n = 0;
  while (n < rest.size() && rest[n] != '\n' && rest[n] != '\r') ++n;
  const std::string_view line = rest.substr(0, n);
  const bool crlf = rest.substr(n).starts_with("\r\n");
  rest.remove_prefix(std::min(n + (crlf ? 2 : 1), rest.size()));
  return line;
}

std::optional<double> to_number(std::string_view s) {
  if (s.size() > 1 && s[0] == '+' && s[1] != '-') s.remove_prefix(1);  // from_chars knows no plus sign
  double value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (end != s.data() + s.size() || s.empty()) return std::nullopt;
  if (error == std::errc::result_out_of_range) {  // 1e-400 is 0, 1e400 is too much for anyone
    const double most = std::numeric_limits<double>::infinity();
    return is_below_one(s) ? 0.0 : s[0] == '-' ? -most : most;
  }
  return error == std::errc{} ? std::optional(value) : std::nullopt;
}

std::optional<double> to_decimal(std::string_view s) {
  const std::size_t comma = s.find(',');
  if (comma == s.npos) return to_number(s);
  std::string with_point(s);
  with_point[comma] = '.';
  return to_number(with_point);
}

std::string clean_text(std::string_view s) {
  std::string clean;
  clean.reserve(s.size());
  for (std::size_t i = 0; i < s.size();) {
    const auto byte = [&](std::size_t k) { return i + k < s.size() ? static_cast<unsigned char>(s[i + k]) : 0u; };
    const auto goes_on = [&](std::size_t k) { return (byte(k) & 0xc0u) == 0x80u; };
    const unsigned a = byte(0), b = byte(1);
    std::size_t length = 0;  // 0: no character starts here. The bounds on b rule out long forms and surrogates.
    if (a < 0x80) {
      length = a >= 0x20 && a != 0x7f ? 1 : 0;
    } else if (a >= 0xc2 && a <= 0xdf) {
      length = goes_on(1) ? 2 : 0;
    } else if (a >= 0xe0 && a <= 0xef) {
      const bool legal = !(a == 0xe0 && b < 0xa0) && !(a == 0xed && b > 0x9f);
      length = legal && goes_on(1) && goes_on(2) ? 3 : 0;
    } else if (a >= 0xf0 && a <= 0xf4) {
      const bool legal = !(a == 0xf0 && b < 0x90) && !(a == 0xf4 && b > 0x8f);
      length = legal && goes_on(1) && goes_on(2) && goes_on(3) ? 4 : 0;
    }
    if (length == 0) {
      clean += '?';
      ++i;
    } else {
      clean += s.substr(i, length);
      i += length;
    }
  }
  return clean;
}

std::string quotable(std::string_view s, std::size_t longest) {
  // Beyond this, nothing can be among the first `longest` characters of at most 4 bytes.
  const std::string clean = clean_text(s.substr(0, 4 * longest + 4));
  std::string quoted;
  std::size_t i = 0;
  for (std::size_t count = 0; i < clean.size() && count < longest; ++count) {
    std::size_t next = i + 1;
    while (next < clean.size() && (static_cast<unsigned char>(clean[next]) & 0xc0u) == 0x80u) ++next;
    const std::string_view character = std::string_view(clean).substr(i, next - i);
    quoted += shows(character) ? character : "?";
    i = next;
  }
  return i < clean.size() || s.size() > 4 * longest + 4 ? quoted + "\u2026" : quoted;
}

std::string xml_text(std::string_view s) {
  std::string out;
  for (const char c : clean_text(s)) {
    if (c == '&') {
      out += "&amp;";
    } else if (c == '<') {
      out += "&lt;";
    } else if (c == '>') {
      out += "&gt;";
    } else if (c == '"') {
      out += "&quot;";
    } else {
      out += c;
    }
  }
  return out;
}

std::string message_line(std::string_view message, std::size_t longest) {
  std::string line;
  for (std::size_t begin = 0; begin <= message.size();) {
    const std::size_t end = std::min(message.find(' ', begin), message.size());
    const std::string_view word = message.substr(begin, end - begin);
    const bool path = word.size() <= 4096 && word.find('/') != word.npos;
    if (begin > 0) line += ' ';
    line += word.size() > longest && !path ? quotable(word) : clean_text(word);
    begin = end + 1;
  }
  return line;
}

}  // namespace clerestory
