#pragma once
// A folder of a test's own, gone when the test ends.

#include <filesystem>
#include <string>
#include <string_view>

namespace clerestory {

class TempFolder {
 public:
  TempFolder();
  ~TempFolder();
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  /// Path of a file in it, as an argument.
  std::string operator/(std::string_view name) const { return (path_ / name).string(); }
  /// Writes a file and returns its path.
  std::string write(std::string_view name, std::string_view content) const;
  /// Names of the files in it, in order, each followed by a blank.
  std::string listing() const;

 private:
  std::filesystem::path path_;
};

std::string read_text(const std::filesystem::path& file);

}  // namespace clerestory
