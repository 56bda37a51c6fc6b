#pragma once
// A lightmap on vertices -> PLY, OBJ, GLB.

#include <string>
#include <vector>

#include "io/atomic_file.h"
#include "solver/model/baked_mesh.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Binary: x y z nx ny nz float, red green blue uchar (shown x exposure, sRGB), illuminance [lx], irradiance_0[,1,2]
/// [W/m2] float; faces vertex_indices. Far from the origin the positions are relative to a comment "origin X Y Z".
///
/// exposure  [m2/W], by exposure_of()
void write_baked_ply(AtomicFile& file, const BakedMesh& mesh, double exposure);

/// What the numbers in BakedMesh::surface and ::material stand for.
struct BakedNames {
  std::vector<std::string> surfaces;
  std::vector<Material> materials;
  std::vector<bool> glows;  ///< by material, as glowing_materials()
};
BakedNames names_of(const WrittenResult& result);

/// Text: v x y z r g b (shown x exposure, sRGB), vn, an object a surface. Positions have all their digits.
void write_baked_obj(AtomicFile& file, const BakedMesh& mesh, const BakedNames& names, double exposure);

struct GlbLook {
  double exposure = 1;   ///< [m2/W], by exposure_of()
  std::string lightmap;  ///< name of the picture on atlas_uv that shows the light in place of COLOR_0; may be empty
  /// The picture as MOZ_lightmap, of materials that are not unlit, and not as base colour texture of such that are.
  bool lightmap_extension = false;
};

/// glTF 2.0, y up: a node and a mesh a surface, a primitive a material of it, with COLOR_0 (shown x exposure, linear,
/// at most 1), _ILLUMINANCE [lx] and _IRRADIANCE [W/m2]; materials are unlit and have the reflectance as base colour.
/// With atlas_uv also TEXCOORD_1. Far from the origin, one node above all moves the positions there.
///
/// throws  InputError when it grows beyond 4 GiB, which is all that a .glb can hold.
void write_baked_glb(AtomicFile& file, const BakedMesh& mesh, const BakedNames& names, const GlbLook& look);

}  // namespace clerestory
