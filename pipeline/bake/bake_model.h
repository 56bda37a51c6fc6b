#pragma once
// A result and the models it was solved for -> light on their own vertices.

#include <string>
#include <vector>

#include "io/bake/baked_files.h"
#include "io/bake/model_glb.h"
#include "solver/model/scene.h"
#include "solver/model/written_result.h"

namespace clerestory {

struct BakedScene {
  std::vector<LitModelFile> models;
  BakedNames names;            ///< of meshes of other formats than glTF
  std::vector<LitPart> parts;  ///< that the models look into
  double missing_share = 0;    ///< of the result's area, where no model has a face [1]
};

/// throws  InputError when a glTF model can no longer be read
BakedScene bake_scene(const WrittenResult& result, const Scene& scene);

/// All of it as one mesh, for formats without nodes; its surfaces are the second, by name.
struct NamedMesh {
  BakedMesh mesh;
  BakedNames names;
};
NamedMesh as_one_mesh(const BakedScene& scene);

}  // namespace clerestory
