#pragma once
// The tables of tests/reference.

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/csv_rows.h"

namespace clerestory::test {

inline std::filesystem::path reference_folder() {
  return std::filesystem::path(CLERESTORY_SOURCE_DIR) / "tests" / "reference";
}

/// They are part of the checkout: one that is missing is an error, no reason to skip a law.
inline std::vector<CsvRow> reference_table(const std::string& file) {
  std::vector<CsvRow> rows = csv_rows(reference_folder() / file);
  if (rows.empty()) throw std::runtime_error("tests/reference/" + file + " has no rows");
  return rows;
}

}  // namespace clerestory::test
