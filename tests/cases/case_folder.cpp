#include "tests/cases/case_folder.h"

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "tests/support/temp_folder.h"

namespace clerestory::test {

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == text.npos ? "" : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

/// Up to a blank, comma or semicolon; empty where the text does not hold `name`.
std::string word_behind(const std::string& name, const std::string& text) {
  const auto found = text.find(name);
  if (found == text.npos) return "";
  const std::string rest = trimmed(text.substr(found + name.size()));
  return rest.substr(0, rest.find_first_of(" ,;"));
}

std::string filling(const std::string& name, const CsvRow& row) {
  if (const auto column = row.find(name); column != row.end()) {
    std::string cell = column->second;
    std::replace(cell.begin(), cell.end(), ' ', ',');
    return cell;
  }
  return word_behind(name, row.at("config"));
}

/// Rows without a point of their own are measured where points.csv says, by config and quantity.
void add_point(CsvRow& row, const std::vector<CsvRow>& points) {
  for (const CsvRow& point : points)
    if (point.at("config") == row["config"] && point.at("quantity") == row["quantity"])
      for (const auto& [column, cell] : point) row[column] = cell;
}

}  // namespace

std::string fill_gaps(const std::string& scene, const CsvRow& row) {
  std::string out = scene;
  for (std::size_t begin; (begin = out.find("{{")) != out.npos;) {
    const std::size_t end = out.find("}}", begin);
    const std::string gap = out.substr(begin + 2, end - begin - 2);
    const auto bar = gap.find('|');
    std::string with = filling(trimmed(gap.substr(0, bar)), row);
    if (with.empty() && bar != gap.npos) with = trimmed(gap.substr(bar + 1));
    if (with.empty()) throw std::runtime_error("nothing fills {{" + gap + "}} for '" + row.at("config") + "'");
    out.replace(begin, end + 2 - begin, with);
  }
  return out;
}

CaseFolder read_case(const std::filesystem::path& path) {
  CaseFolder folder{path, {}};
  std::istringstream lines(read_text(path / "case.txt"));
  for (std::string line; std::getline(lines, line);)
    if (const auto blank = line.find(' '); blank != line.npos)
      folder.said[line.substr(0, blank)] = line.substr(blank + 1);
  return folder;
}

double CaseFolder::number(const std::string& key, double otherwise) const {
  const auto found = said.find(key);
  return found == said.end() ? otherwise : std::stod(found->second);
}

std::vector<CaseScene> CaseFolder::scenes(const std::filesystem::path& reference) const {
  const std::string pattern = read_text(path / "scene.json");
  const std::vector<CsvRow> points = csv_rows(path / "points.csv");
  const auto names = [&](const char* key, const CsvRow& row) {
    return std::regex_search(row.at("config") + "; " + row.at("quantity"), std::regex(said.at(key)));
  };
  std::vector<CaseScene> out;
  for (CsvRow& row : csv_rows(reference / said.at("reference"))) {
    if (row["case"] != said.at("case")) continue;
    if (said.contains("with") && !names("with", row)) continue;
    if (said.contains("without") && names("without", row)) continue;
    add_point(row, points);
    const std::string scene = fill_gaps(pattern, row);
    auto same = std::ranges::find(out, scene, &CaseScene::scene);
    if (same == out.end()) same = out.insert(out.end(), {scene, {}});
    same->rows.push_back(row);
  }
  return out;
}

}  // namespace clerestory::test
