#pragma once
// Light fixtures of an IFC file, as its reader hands them over in JSON. Only ifc_answer.cpp includes this.

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/formats/model.h"

namespace clerestory {

/// A goniometric source of a flux becomes a luminaire: of its own intensities, of the photometric file that it names
/// where that lies beside the IFC file, else a point. All others have no unit and stay mute.
///
/// warnings  what is odd about them.
/// throws    std::runtime_error or a JSON exception when `json` is not of the reader's form.
ModelFixture read_ifc_fixture(const nlohmann::json& json, std::size_t surfaces, const std::filesystem::path& ifc_file,
                              std::vector<std::string>& warnings);

}  // namespace clerestory
