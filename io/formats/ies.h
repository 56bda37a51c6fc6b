#pragma once
// IESNA LM-63 files: 1986, 1991, 1995, 2002 and 2019.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "solver/model/photometric_web.h"

namespace clerestory {

/// Words are separated by blanks, line ends, commas or semicolons; label lines may be in any encoding.
///
/// folder    where the file of a TILT=file line lies.
/// named     gets that file, when given.
/// throws    InputError.
PhotometricWeb parse_ies(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                         std::vector<std::string>& warnings, std::vector<std::filesystem::path>* named = nullptr);
PhotometricWeb read_ies(const std::filesystem::path& file, std::vector<std::string>& warnings,
                        std::vector<std::filesystem::path>* named = nullptr);

}  // namespace clerestory
