#include "io/parse_json.h"

#include <algorithm>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

/// Line and column, both from 1, of the byte at `offset`.
std::string line_and_column(std::string_view bytes, std::size_t offset) {
  const std::string_view before = bytes.substr(0, std::min(offset, bytes.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t line_start = before.rfind('\n');
  const std::size_t column = 1 + before.size() - (line_start == before.npos ? 0 : line_start + 1);
  return text(line, ":", column);
}

/// "...; last read: 'TOKEN'; expected ...": a token may be as long as the file.
std::string with_short_token(const std::string& what) {
  constexpr std::string_view kBefore = "; last read: '";
  const std::size_t begin = what.find(kBefore), end = what.rfind('\'');
  if (begin == what.npos || end < begin + kBefore.size()) return quotable(what, 200);
  const std::string token = what.substr(begin + kBefore.size(), end - begin - kBefore.size());
  return quotable(what.substr(0, begin), 200) + std::string(kBefore) + quotable(token) +
         quotable(what.substr(end), 100);
}

}  // namespace

template <class AnyJson>
AnyJson parse_json(std::string_view bytes, const std::string& file_name, const JsonLimits& limits) {
  using Event = typename AnyJson::parse_event_t;
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  std::vector<std::set<std::string>> keys;  // of each object that is open
  const auto watch = [&](int depth, Event event, AnyJson& parsed) {
    if (depth > limits.deepest)
      throw InputError(text(file_name, ": is nested deeper than ", limits.deepest, " levels"));
    if (event == Event::object_start) keys.emplace_back();
    if (event == Event::object_end) keys.pop_back();
    if (event == Event::key) {
      const auto& key = parsed.template get_ref<const std::string&>();
      if (!keys.back().insert(key).second) {
        throw InputError(
            text(file_name, ": the key '", quotable(key), "' is given twice in one object; which one counts?"));
      }
      if (keys.back().size() > limits.most_keys) {
        throw InputError(text(file_name, ": more than ", limits.most_keys, " keys in one object"));
      }
    }
    return true;
  };
  try {
    return AnyJson::parse(bytes.begin(), bytes.end(), watch, true, true);
  } catch (const typename AnyJson::parse_error& error) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error while parsing ..."
    std::string what = error.what();
    const std::size_t detail = what.find(": ");
    if (detail != what.npos) what = what.substr(detail + 2);
    throw InputError(text(file_name, ":", line_and_column(bytes, error.byte > 0 ? error.byte - 1 : 0),
                          ": is not valid JSON: ", with_short_token(what)));
  } catch (const typename AnyJson::exception& error) {
    const std::string what = error.what();
    const std::size_t detail = what.find("] ");
    throw InputError(
        text(file_name, ": is not valid JSON: ", quotable(detail == what.npos ? what : what.substr(detail + 2), 200)));
  }
}

template nlohmann::json parse_json(std::string_view, const std::string&, const JsonLimits&);
template nlohmann::ordered_json parse_json(std::string_view, const std::string&, const JsonLimits&);

}  // namespace clerestory
