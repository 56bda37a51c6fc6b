#pragma once
// Strings put together from values, for messages; and the few questions that readers ask of text.

#include <optional>
#include <sstream>
#include <string>
#include <string_view>

namespace clerestory {

/// text("x = ", 1.5) is "x = 1.5".
template <class... Part>
std::string text(const Part&... part) {
  std::ostringstream out;
  out.precision(9);
  (out << ... << part);
  return out.str();
}

std::string to_lower(std::string_view s);
/// s without blanks at either end.
std::string_view trimmed(std::string_view s);
/// s without blanks and then without quotation marks of either kind at both ends.
std::string_view unquoted(std::string_view s);
/// Next word of `rest`, which is moved behind it; empty at the end. Blanks and tabs separate.
std::string_view next_word(std::string_view& rest);
/// Cuts the next line off `rest`, which must not be empty. Lines end in LF, CR LF or CR, which are left out.
std::string_view next_line(std::string_view& rest);
/// All of s as a number ("1e3", "-.5", "nan"); nothing when it is not one.
std::optional<double> to_number(std::string_view s);
/// The same, where a comma may stand for the decimal point.
std::optional<double> to_decimal(std::string_view s);
/// s with control characters and what is not UTF-8 replaced by '?': fit for messages, XML and JSON.
std::string clean_text(std::string_view s);
/// clean_text(s) with the signs that XML and HTML take for their own written otherwise.
std::string xml_text(std::string_view s);
/// A message as one line that can be shown: clean_text(), and words of more than `longest` characters cut, for nobody
/// reads them. Paths stay whole.
std::string message_line(std::string_view message, std::size_t longest = 200);
/// What a message may show of a file: clean_text(s), without characters that do not show, cut after so many.
std::string quotable(std::string_view s, std::size_t longest = 40);

}  // namespace clerestory
