#pragma once
// Files that another file names, perhaps on another system.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace clerestory {

/// Looks for what one model names. A folder is listed once, however many of the names are of no file there; what comes
/// into it meanwhile may not be found.
class FileFinder {
 public:
  /// The file that `named` means, as seen from `folder`: as it is written, quotation marks apart; else with / for \ and
  /// without regard to case. Of several that differ in case only, the first in the order of bytes.
  std::optional<std::filesystem::path> path(const std::filesystem::path& folder, std::string_view named);

  /// The same; else the last part of the name alone, in `folder`: C:\models\wood.png beside the model.
  std::optional<std::filesystem::path> file(const std::filesystem::path& folder, std::string_view named);

 private:
  using Listing = std::unordered_map<std::string, std::filesystem::path>;  ///< names by their lower case
  const Listing& listing(const std::filesystem::path& folder);
  std::optional<std::filesystem::path> entry(const std::filesystem::path& folder, const std::filesystem::path& part);
  std::optional<std::filesystem::path> any_case(std::filesystem::path at, const std::filesystem::path& named);

  std::map<std::filesystem::path, Listing> listings_;
};

}  // namespace clerestory
