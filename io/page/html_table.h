#pragma once
// Rows of words and figures as a table of a page.

#include <string>
#include <vector>

namespace clerestory {

/// Words are plain text here: what HTML takes for its own is escaped when they are written.
class HtmlTable {
 public:
  /// A head that begins with '<' stands over words, left-aligned; others stand over figures, right-aligned.
  explicit HtmlTable(const std::vector<std::string>& heads);
  /// kind: a class of the style sheet, "" or "group" (a heading of rows) or "rest".
  void add(const std::vector<std::string>& cells, const std::string& kind = "");
  bool empty() const { return rows_.empty(); }
  std::string html() const;

 private:
  std::vector<std::string> heads_;
  std::vector<bool> words_;
  std::string rows_;
  std::size_t count_ = 0;
};

/// "<dt>words</dt><dd>words</dd>" of each pair.
std::string html_facts(const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace clerestory
