#pragma once
// The tree of nodes of a glTF file. Only the glTF sources include this header, as JSON shows.

#include <functional>

#include "io/affine.h"
#include "io/formats/gltf_file.h"

namespace clerestory {

/// Calls visit(node, its place in the scene, words for messages) for the nodes of the scene that is shown, each under
/// its parent; without a scene, of all trees.
///
/// throws  InputError when the nodes form no trees.
void visit_nodes(
    const GltfFile& file,
    const std::function<void(const GltfFile::Json& node, const Affine& place, const std::string& where)>& visit);

}  // namespace clerestory
