#pragma once
// Light fixtures of an IFC file, as its reader hands them over in JSON. Only ifc_answer.cpp includes this.

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "io/find_file.h"
#include "io/formats/model.h"

namespace clerestory {

/// Reads the fixtures of one model.
class IfcLights {
 public:
  /// model  whose surfaces are known; gets what is odd as warnings, and the files that were read.
  IfcLights(const std::filesystem::path& ifc_file, Model& model) : ifc_file_(ifc_file), model_(model) {}

  /// A goniometric source of a flux becomes a luminaire: of its own intensities, of the photometric file that it names
  /// where that lies beside the IFC file, else a point. All others have no unit and stay mute.
  ///
  /// throws  std::runtime_error or a JSON exception when `json` is not of the reader's form.
  ModelFixture fixture(const nlohmann::json& json);

 private:
  using Web = std::shared_ptr<const PhotometricWeb>;
  std::optional<Luminaire> luminaire(const nlohmann::json& source, const std::string& fixture);
  Web web_beside(const std::string& named);

  const std::filesystem::path& ifc_file_;
  Model& model_;
  FileFinder finder_;
  std::map<std::filesystem::path, Web> webs_;  // by file; null: it cannot be read, which was said
};

}  // namespace clerestory
