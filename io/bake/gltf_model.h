#pragma once
// A glTF file that light is put on. JSON shows: for .cpp files of io/bake/ only.

#include <string>
#include <vector>

#include "io/bake/model_glb.h"
#include "io/formats/gltf_file.h"
#include "io/formats/gltf_nodes.h"

namespace clerestory {

class GltfModel {
 public:
  GltfModel(const std::filesystem::path& file, const Affine& place);

  /// Where a part comes from.
  struct Source {
    std::size_t node, mesh, primitive;
    std::vector<std::uint32_t> vertex;  ///< of each position of the part, in the accessors
    Affine place;                       ///< of the node's frame into the scene's
  };

  mutable GltfFile file;  ///< decodes as it is asked
  Affine place;           ///< of the file's frame into the scene's
  std::vector<GltfNode> nodes;
  std::vector<ModelPart> parts;
  std::vector<Source> sources;

 private:
  void add_parts(const GltfNode& node);
};

}  // namespace clerestory
