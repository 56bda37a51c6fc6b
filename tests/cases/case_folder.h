#pragma once
// A case is a folder: case.txt names rows of the reference and says how close they must be met, scene.json is the scene
// that they are about, with gaps for what differs from row to row.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/csv_rows.h"

namespace clerestory::test {

/// One scene and the rows that it answers.
struct CaseScene {
  std::string scene;
  std::vector<CsvRow> rows;
};

struct CaseFolder {
  std::filesystem::path path;
  std::map<std::string, std::string> said;  ///< lines of case.txt: first word, rest

  double number(const std::string& key, double otherwise) const;
  /// Rows whose scenes are the same, character by character, are solved together.
  std::vector<CaseScene> scenes(const std::filesystem::path& reference) const;
};

CaseFolder read_case(const std::filesystem::path& path);

/// {{NAME}} becomes the word behind NAME in the row's config, or the row's column NAME with commas for blanks;
/// {{NAME | OTHER}} becomes OTHER where the row has neither.
/// throws  std::runtime_error naming the gap that nothing fills.
std::string fill_gaps(const std::string& scene, const CsvRow& row);

}  // namespace clerestory::test
