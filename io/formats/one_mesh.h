#pragma once
// Models that are one mesh, or a few, without materials: PLY, STL, OFF.

#include "io/formats/add_mesh.h"

namespace clerestory {

/// A model whose only material is "default", undescribed.
Model model_without_materials();

/// throws  InputError when the model has no face with three corners or more.
void require_faces(const Model& model, const std::string& name);

}  // namespace clerestory
