#pragma once
// Numbers of a text file, one after the other, with the line they stand on.

#include <algorithm>
#include <string>
#include <string_view>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

/// Line by line or word by word over one text. Lines end in LF, CR LF or CR.
class NumberWords {
 public:
  /// separators  what stands between words besides blanks and line ends.
  NumberWords(std::string_view bytes, std::string file, std::string_view separators)
      : rest_(text_bytes(bytes, file)), file_(std::move(file)), separators_(separators) {}

  [[noreturn]] void refuse(const std::string& what) const { throw InputError(text(file_, ":", line_, ": ", what)); }

  /// The whole next line; false at the end.
  bool line(std::string_view& out) {
    if (rest_.empty()) return false;
    ++line_;
    out = next_line(rest_);
    words_ = {};
    return true;
  }

  /// The next word, on this line or a later one; empty at the end.
  std::string_view word() {
    while (true) {
      const std::size_t begin = words_.find_first_not_of(separators_);
      if (begin != words_.npos) {
        words_.remove_prefix(begin);
        const std::string_view found = words_.substr(0, words_.find_first_of(separators_));
        words_.remove_prefix(found.size());
        return found;
      }
      if (std::string_view next; line(next))
        words_ = next;
      else
        return {};
    }
  }

  /// The next word as a number. what: "candela 3 of plane H = 30".
  template <class What>
  double number(const What& what) {
    const std::string_view w = word();
    if (w.empty()) refuse(text("the file ends before ", what()));
    return checked(w, what);
  }
  template <class What>
  double checked(std::string_view w, const What& what) const {
    std::string with_point;
    if (w.find(',') != w.npos) {  // a decimal comma, where commas do not separate
      with_point = w;
      with_point[with_point.find(',')] = '.';
      w = with_point;
    }
    const auto value = to_number(w);
    if (!value) refuse(text("'", quotable(w), "' is not a number; expected ", what()));
    if (!(*value > -1e12 && *value < 1e12)) refuse(text(what(), " = ", quotable(w), " is out of every range"));
    return *value;
  }

  std::size_t line_number() const { return line_; }

 private:
  std::string_view rest_, words_;
  std::string file_;
  std::string_view separators_;
  std::size_t line_ = 0;
};

}  // namespace clerestory
