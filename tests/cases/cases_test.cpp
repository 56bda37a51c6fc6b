// Every folder beside this file with a case.txt: solved by the program, compared with its rows of the reference.

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "tests/cases/solve_case.h"
#include "tests/support/reference_table.h"

namespace clerestory::test {
namespace {

namespace fs = std::filesystem;
const fs::path kCases = fs::path(CLERESTORY_SOURCE_DIR) / "tests" / "cases";

std::vector<std::string> names_of_cases() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kCases))
    if (fs::exists(entry.path() / "case.txt")) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// How far off some values are, and where most.
struct Deviations {
  std::size_t count = 0;
  double sum = 0, worst = 0;
  std::string worst_row;

  void add(double off, double value, const CsvRow& row) {
    ++count, sum += off;
    if (off < worst) return;
    worst = off;
    worst_row = row.at("quantity") + " at " + row.at("point") + " (" + row.at("x") + ", " + row.at("y") + ", " +
                row.at("z") + "): " + std::to_string(value) + " for " + row.at("value");
  }
  double mean() const { return count == 0 ? 0 : sum / static_cast<double>(count); }
};

/// A line of the table.
struct OfConfig {
  std::string config;
  Deviations relative, of_zeros;  ///< rows that are 0 in the reference count in their unit
};

std::vector<OfConfig> table_of(const CaseFolder& folder) {
  std::vector<OfConfig> table;
  for (const CaseScene& scene : folder.scenes(reference_folder())) {
    const std::vector<double> values = solve_case(folder, scene);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const CsvRow& row = scene.rows[i];
      auto line = std::ranges::find(table, row.at("config"), &OfConfig::config);
      if (line == table.end()) line = table.insert(table.end(), {row.at("config"), {}, {}});
      const double wanted = std::stod(row.at("value"));
      if (wanted == 0)
        line->of_zeros.add(std::abs(values[i]), values[i], row);
      else
        line->relative.add(std::abs(values[i] / wanted - 1), values[i], row);
    }
  }
  return table;
}

class Case : public testing::TestWithParam<std::string> {};

TEST_P(Case, HoldsItsNumbers) {
  const CaseFolder folder = read_case(kCases / GetParam());
  const std::vector<OfConfig> table = table_of(folder);
  ASSERT_FALSE(table.empty());
  std::printf("case,config,rows,mean_percent,worst_percent,worst_of_zeros\n");
  for (const auto& [config, relative, of_zeros] : table) {
    std::printf("%s,\"%s\",%zu,%.4f,%.4f,%.2g\n", GetParam().c_str(), config.c_str(), relative.count + of_zeros.count,
                100 * relative.mean(), 100 * relative.worst, of_zeros.worst);
    EXPECT_LE(relative.worst, folder.number("largest", 0)) << config << ", " << relative.worst_row;
    EXPECT_LE(relative.mean(), folder.number("mean", 1)) << config << ", mean of " << relative.count << " rows";
    EXPECT_LE(of_zeros.worst, folder.number("zero", 0)) << config << ", " << of_zeros.worst_row;
  }
}
INSTANTIATE_TEST_SUITE_P(All, Case, testing::ValuesIn(names_of_cases()), [](const auto& i) { return i.param; });

}  // namespace
}  // namespace clerestory::test
