#pragma once
// What a glTF file shows: the nodes of its scene, and the triangles of their primitives. For the glTF sources only.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/affine.h"
#include "io/formats/gltf_file.h"

namespace clerestory {

struct GltfNode {
  std::size_t index = 0;                ///< in the file's list
  std::optional<std::size_t> parent{};  ///< the same
  Affine place{};                       ///< of its frame into the file's
};

/// Visits the nodes of the scene that is shown, each after its parent; without a scene, all that nobody has as child.
///
/// throws  InputError when they form no tree
void visit_shown_nodes(const GltfFile& file, const std::function<void(const GltfNode&)>& visit);

/// Corners of a primitive's triangles, three by three, of a list, strip or fan (mode 4, 5, 6) of n vertices.
std::vector<std::uint32_t> triangle_corners(GltfFile& file, const nlohmann::json& primitive, std::size_t mode,
                                            std::size_t n, const std::string& where);

}  // namespace clerestory
