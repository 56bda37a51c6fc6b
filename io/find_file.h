#pragma once
// Files that another file names, perhaps on another system.

#include <filesystem>
#include <optional>
#include <string_view>

namespace clerestory {

/// s without quotation marks around it, of either kind.
std::string_view unquoted(std::string_view s);

/// The file that `named` means, as seen from `folder`: as it is written, quotation marks apart; else with / for \ and
/// without regard to case. Of several that differ in case only, the first in the order of bytes.
std::optional<std::filesystem::path> find_path(const std::filesystem::path& folder, std::string_view named);

/// The same; else the last part of the name alone, in `folder`: C:\models\wood.png beside the model.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& folder, std::string_view named);

}  // namespace clerestory
