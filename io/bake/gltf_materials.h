#pragma once
// Materials, textures and images of a glTF file in another. JSON shows: for .cpp files of io/bake/ only.

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "io/bake/baked_nodes.h"
#include "io/formats/gltf_file.h"

namespace clerestory {

class GltfMaterials {
 public:
  GltfMaterials(GlbBuilder& glb, GltfFile& file, const BakedNames& names) : glb_(glb), file_(file), names_(names) {}

  /// A material of the file as an unlit one, added when it is first used. One without a texture has the reflectance
  /// that the light was computed with as its colour, one that glows white.
  ///
  /// index      in the file; empty: none
  /// uv_sets    texture coordinates that its primitive has; textures that need more are left out
  /// of_result  material of the result, where light reaches it
  std::size_t operator()(std::optional<std::size_t> index, std::size_t uv_sets,
                         const std::optional<std::uint32_t>& of_result);

  /// Textures that could not be read.
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  using Json = nlohmann::json;

  Json material(const Json& from, std::size_t uv_sets, const std::optional<std::uint32_t>& of_result);
  /// Copies the texture that a member shows, with its own transform.
  void copy_texture(const Json& from, const char* key, std::size_t uv_sets, Json& to);
  std::optional<std::size_t> texture(std::size_t index);
  std::optional<std::size_t> image(std::size_t index, std::string& mime_type);

  GlbBuilder& glb_;
  GltfFile& file_;
  const BakedNames& names_;
  std::map<std::tuple<std::size_t, std::size_t, std::uint32_t>, std::size_t> materials_;
  std::map<std::size_t, std::optional<std::size_t>> textures_;
  std::map<std::size_t, std::size_t> samplers_;
  std::map<std::size_t, std::pair<std::optional<std::size_t>, std::string>> images_;
  std::vector<std::string> left_out_;
};

}  // namespace clerestory
