#pragma once
// The bytes of a file, or a clear reason why not.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace clerestory {

/// Name by which messages call a file: the last part of its path.
std::string short_name(const std::filesystem::path& file);

/// For files that another file names: which key of it names one that is not there.
///
/// place   "office.json: geometry[0].file";  named  the file as it is written there.
/// throws  InputError when there is no such file, and when it is a folder.
void require_file(const std::filesystem::path& file, const std::string& place, const std::string& named);

/// throws  InputError when `file` is missing, not a regular file, not readable, empty or longer than max_bytes.
void check_input_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

/// The whole file. Throws as check_input_file does.
std::string read_input_file(const std::filesystem::path& file, std::uintmax_t max_bytes);

/// The bytes of a text without the mark that some editors put before UTF-8.
///
/// throws  InputError when they are UTF-16, with a mark of its own or without.
std::string_view text_bytes(std::string_view bytes, const std::string& name);

}  // namespace clerestory
