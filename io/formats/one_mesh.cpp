#include "io/formats/one_mesh.h"

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

Model model_without_materials() {
  Model model;
  ModelMaterial& none = model.materials.emplace_back();
  none.material.name = kDefaultMaterial;
  none.described = false;
  return model;
}

void require_faces(const Model& model, const std::string& name) {
  if (model.polygons.face_count() == 0) throw InputError(text(name, ": ", kNoFaces));
}

}  // namespace clerestory
