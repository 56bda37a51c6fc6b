#pragma once
// EULUMDAT files.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "solver/model/photometric_web.h"

namespace clerestory {

/// The first set of lamps counts. Decimal commas are read, and texts in any encoding.
///
/// throws    InputError.
PhotometricWeb parse_ldt(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings);
PhotometricWeb read_ldt(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace clerestory
