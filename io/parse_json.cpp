#include "io/parse_json.h"

#include <algorithm>
#include <set>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/input_file.h"
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

/// Builds a value from the parser's events, and throws InputError at the first one that is out of bounds. The parser's
/// own builder with a callback looks through the whole array again behind each object in it.
template <class AnyJson>
class BoundedBuilder : public nlohmann::json_sax<AnyJson> {
 public:
  using Base = nlohmann::json_sax<AnyJson>;
  BoundedBuilder(std::string_view bytes, const std::string& file_name, const JsonLimits& limits)
      : bytes_(bytes), file_name_(file_name), limits_(limits) {}

  AnyJson take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(typename Base::number_integer_t value) override { return add(value); }
  bool number_unsigned(typename Base::number_unsigned_t value) override { return add(value); }
  bool number_float(typename Base::number_float_t value, const std::string&) override { return add(value); }
  bool string(std::string& value) override { return add(std::move(value)); }
  bool binary(typename Base::binary_t& value) override { return add(std::move(value)); }
  bool start_object(std::size_t) override {
    open(AnyJson::object());
    keys_.emplace_back();
    return true;
  }
  bool end_object() override {
    keys_.pop_back();
    return close();
  }
  bool start_array(std::size_t) override { return open(AnyJson::array()); }
  bool end_array() override { return close(); }
  bool key(std::string& key) override {
    if (!keys_.back().insert(key).second) {
      throw InputError(
          text(file_name_, ": the key '", quotable(key), "' is given twice in one object; which one counts?"));
    }
    if (keys_.back().size() > limits_.most_keys) {
      throw InputError(text(file_name_, ": more than ", limits_.most_keys, " keys in one object; part it"));
    }
    next_ = &(*open_.back())[key];
    return true;
  }
  bool parse_error(std::size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error while parsing ..."
    const std::string what = error.what();
    const bool has_place = dynamic_cast<const typename AnyJson::parse_error*>(&error) != nullptr;
    const std::size_t detail = what.find(has_place ? ": " : "] ");
    throw InputError(
        text(file_name_, has_place ? ":" + line_and_column(bytes_, position > 0 ? position - 1 : 0) : "",
             ": is not valid JSON: ", with_short_token(detail == what.npos ? what : what.substr(detail + 2))));
  }

 private:
  template <class Value>
  AnyJson* put(Value&& value) {
    if (open_.empty()) return &(root_ = std::forward<Value>(value));
    if (open_.back()->is_object()) return &(*next_ = std::forward<Value>(value));
    open_.back()->push_back(AnyJson(std::forward<Value>(value)));
    return &open_.back()->back();
  }
  template <class Value>
  bool add(Value&& value) {
    put(std::forward<Value>(value));
    return true;
  }
  bool open(AnyJson container) {
    open_.push_back(put(std::move(container)));
    if (open_.size() > static_cast<std::size_t>(limits_.deepest))
      throw InputError(
          text(file_name_, ": is nested deeper than ", limits_.deepest, " levels; is it damaged, or another file?"));
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view bytes_;
  const std::string& file_name_;
  const JsonLimits& limits_;
  AnyJson root_;
  std::vector<AnyJson*> open_;               // each in the one before, which does not grow meanwhile
  AnyJson* next_ = nullptr;                  // the value that the last key is for
  std::vector<std::set<std::string>> keys_;  // of each object that is open
};

}  // namespace

template <class AnyJson>
AnyJson parse_json(std::string_view bytes, const std::string& file_name, const JsonLimits& limits) {
  bytes = text_bytes(bytes, file_name);
  BoundedBuilder<AnyJson> builder(bytes, file_name, limits);
  AnyJson::sax_parse(bytes.begin(), bytes.end(), &builder, AnyJson::input_format_t::json, true, true);
  return builder.take();
}

template nlohmann::json parse_json(std::string_view, const std::string&, const JsonLimits&);
template nlohmann::ordered_json parse_json(std::string_view, const std::string&, const JsonLimits&);

}  // namespace clerestory
