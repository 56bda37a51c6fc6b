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
/// throws    InputError.
PhotometricWeb parse_ies(std::string_view bytes, const std::string& name, const std::filesystem::path& folder,
                         std::vector<std::string>& warnings);
PhotometricWeb read_ies(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace clerestory
