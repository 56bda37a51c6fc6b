#pragma once
// Wavefront MTL: the materials of an OBJ file.

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "io/find_file.h"
#include "io/formats/model.h"

namespace clerestory {

/// Reads the material libraries of one model, which share its textures.
class MtlReader {
 public:
  explicit MtlReader(Model& model) : model_(model) {}

  /// Materials of a library, in its order. What is left out is added to the model's warnings, what they show to its
  /// textures, files that it names to its files.
  ///
  /// throws  InputError naming file and line.
  std::vector<ModelMaterial> read(const std::filesystem::path& library);

  FileFinder& files() { return files_; }

 private:
  struct Image {
    std::string name;
    std::filesystem::path file;  ///< empty where it is not there
  };
  Image image_of(std::string_view rest, const std::filesystem::path& folder);
  /// Its index among the model's textures, which it joins when it is new.
  std::size_t texture(const Image& image);

  Model& model_;
  FileFinder files_;
  std::map<std::pair<std::filesystem::path, std::string>, std::size_t> textures_;  // by file and name
};

}  // namespace clerestory
