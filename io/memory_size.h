#pragma once
// Amounts of memory as people write them.

#include <cstddef>
#include <optional>
#include <string_view>

namespace clerestory {

/// "500MiB", "500M", "2GiB", "2 G" or a bare number of MiB, as bytes; nothing for anything else, or below 1 MiB.
std::optional<std::size_t> to_memory_size(std::string_view text);

/// For messages: what to_memory_size() takes.
inline constexpr std::string_view kMemorySizes = "give 500MiB, 2GiB or a number of MiB";

}  // namespace clerestory
