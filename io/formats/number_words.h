#pragma once
// Numbers of a text file, one after the other, with the line they stand on.

#include <string>
#include <string_view>
#include <vector>

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

  /// The next word as a number, with a decimal comma where commas do not separate. what: "candela 3 of plane H = 30".
  template <class What>
  double number(const What& what) {
    const std::string_view w = word();
    if (w.empty()) refuse(text("the file ends before ", what()));
    return checked(w, what);
  }
  template <class What>
  double checked(std::string_view w, const What& what) const {
    const auto value = to_decimal(w);
    if (!value) refuse(text("'", quotable(w), "' is not a number; expected ", what()));
    if (!(*value > -1e12 && *value < 1e12)) refuse(text(what(), " = ", quotable(w), " is out of every range"));
    return *value;
  }

  /// What stands behind the data. Text is left out with a warning; numbers mean that the data is not what it seems.
  template <class Refuse>
  void end(std::vector<std::string>& warnings, const Refuse& refuse_numbers) {
    const std::string_view first = word();
    if (first.empty()) return;
    const std::size_t line = line_;
    if (!to_decimal(first)) {
      warnings.push_back(
          text(file_, ":", line, ": the text behind the data, '", quotable(first), " ...', is left out"));
      return;
    }
    std::size_t more = 1;
    for (std::string_view w = word(); !w.empty(); w = word()) more += to_decimal(w).has_value();
    line_ = line;
    refuse_numbers(more);
  }

  std::size_t line_number() const { return line_; }

 private:
  std::string_view rest_, words_;
  std::string file_;
  std::string_view separators_;
  std::size_t line_ = 0;
};

}  // namespace clerestory
