#include "io/page/html_table.h"

#include "io/text.h"

namespace clerestory {
namespace {

constexpr std::size_t kShort = 18;  ///< rows that stay together on paper

std::string cell(const char* tag, const std::string& words, bool left) {
  return text("<", tag, left ? " class=\"words\">" : ">", xml_text(words), "</", tag, ">");
}

}  // namespace

HtmlTable::HtmlTable(const std::vector<std::string>& heads) {
  for (const std::string& head : heads) {
    words_.push_back(head.starts_with('<'));
    heads_.push_back(head.substr(words_.back() ? 1 : 0));
  }
}

void HtmlTable::add(const std::vector<std::string>& cells, const std::string& kind) {
  ++count_;
  rows_ += kind.empty() ? "<tr>" : "<tr class=\"" + kind + "\">";
  for (std::size_t i = 0; i < cells.size(); ++i) rows_ += cell("td", cells[i], words_[i]);
  rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
  std::string head;
  for (std::size_t i = 0; i < heads_.size(); ++i) head += cell("th", heads_[i], words_[i]);
  return std::string("<div class=\"wide") + (count_ <= kShort ? " short" : "") + "\"><table>\n<thead><tr>" + head +
         "</tr></thead>\n<tbody>\n" + rows_ + "</tbody>\n</table></div>\n";
}

std::string html_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  std::string out = "<dl class=\"facts\">\n";
  for (const auto& [what, value] : facts)
    out += "<div><dt>" + xml_text(what) + "</dt><dd>" + xml_text(value) + "</dd></div>\n";
  return out + "</dl>\n";
}

}  // namespace clerestory
