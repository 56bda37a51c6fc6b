#pragma once
// Models of a scene with light on their own vertices -> GLB.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/bake/baked_files.h"
#include "solver/model/model_part.h"
#include "solver/model/scene.h"

namespace clerestory {

/// A glTF file that is read again, for what a scene does not keep of it. Its JSON stays inside.
class GltfModel;

/// Nothing where the model is of another format, or its transform in the scene one that no node of glTF can have
/// (sheared).
///
/// throws  InputError as read_scene()
std::shared_ptr<const GltfModel> read_gltf_again(const PlacedModel& model);

/// A part for each primitive of triangles of each node that is shown.
const std::vector<ModelPart>& parts_of(const GltfModel& model);

struct LitModelFile {
  std::string name;                       ///< of its node where there are several models
  std::shared_ptr<const GltfModel> gltf;  ///< empty: of another format
  std::span<const LitPart> parts;         ///< of gltf, one each
  BakedMesh mesh;                         ///< of other formats
};

/// Of glTF models nodes, names, transforms, cameras, lamps, normals, texture coordinates, materials and textures stay
/// as they are; a mesh that several nodes show becomes one for each. Of others, a node a surface as write_baked_glb().
///
/// returns  textures that could not be read and are left out
/// throws   InputError when it grows beyond 4 GiB
std::vector<std::string> write_model_glb(AtomicFile& file, std::span<const LitModelFile> models,
                                         const BakedNames& names, double exposure);

}  // namespace clerestory
