#include "io/formats/assimp_model.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include "io/find_file.h"
#include "io/formats/add_mesh.h"
#include "io/formats/model_bytes.h"
#include "io/formats/run_apart.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 4ull << 30;

std::string str(const aiString& s) { return {s.data, std::min<std::size_t>(s.length, sizeof(s.data) - 1)}; }

Affine to_affine(const aiMatrix4x4& m) {
  Affine a;
  for (unsigned r = 0; r < 3; ++r) a.A[r] = {as_written(m[r][0]), as_written(m[r][1]), as_written(m[r][2])};
  a.b = {as_written(m[0][3]), as_written(m[1][3]), as_written(m[2][3])};
  return a;
}

/// What float quarter turns leave beside their ones is rounding.
Affine without_rounding(Affine a) {
  double largest = 0;
  for (const Vec3& row : a.A) largest = std::max({largest, std::abs(row.x), std::abs(row.y), std::abs(row.z)});
  const auto clean = [&](double x) { return std::abs(x) < 3e-7 * largest ? 0.0 : x; };
  for (Vec3& row : a.A) row = {clean(row.x), clean(row.y), clean(row.z)};
  return a;
}

/// Names that Assimp makes up are no names.
bool is_made_up(const std::string& name) { return name.empty() || name[0] == '$' || name[0] == '<'; }

double colour_part(float x) { return std::isfinite(x) && x > 0 ? std::min(double{x}, kLargestCoordinate) : 0.0; }
Spectrum to_spectrum(const aiColor3D& c) { return {colour_part(c.r), colour_part(c.g), colour_part(c.b)}; }

/// The image that a material shows in the place of its diffuse colour; nothing where it shows none.
std::optional<ModelTexture> texture_of(const aiMaterial& from, const aiScene& scene,
                                       const std::filesystem::path& folder, FileFinder& finder) {
  aiString path;
  if (from.GetTexture(aiTextureType_DIFFUSE, 0, &path) != aiReturn_SUCCESS &&
      from.GetTexture(aiTextureType_BASE_COLOR, 0, &path) != aiReturn_SUCCESS)
    return std::nullopt;
  const std::string named = str(path);
  ModelTexture texture{named.substr(named.find_last_of("/\\") + 1), {}, {}};
  if (const aiTexture* inside = scene.GetEmbeddedTexture(path.C_Str())) {
    // Height 0: the bytes of an image file; others are pixels without a format, which no file that we know has.
    if (inside->mHeight == 0) texture.bytes.assign(reinterpret_cast<const char*>(inside->pcData), inside->mWidth);
  } else {
    texture.file = finder.file(folder, named).value_or("");
  }
  return texture;
}

ModelMaterial to_material(const aiMaterial& from) {
  ModelMaterial to;
  aiString name;
  from.Get(AI_MATKEY_NAME, name);
  to.material.name = str(name);
  if (to.material.name.empty()) to.material.name = kDefaultMaterial;
  aiColor3D colour;
  to.described = from.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
  if (!to.described) return to;
  to.material.reflectance = to_spectrum(colour);
  if (from.Get(AI_MATKEY_COLOR_EMISSIVE, colour) == aiReturn_SUCCESS) {
    to.material.exitance = std::numbers::pi * to_spectrum(colour);
    to.unitless_glow = !to.material.exitance.is_black();
  }
  float opacity = 1;
  if (from.Get(AI_MATKEY_OPACITY, opacity) == aiReturn_SUCCESS && std::isfinite(opacity)) {
    apply_opacity(to.material, opacity);
  }
  return to;
}

void add_textures(const aiMaterial& material, const std::filesystem::path& folder, FileFinder& finder,
                  std::vector<std::filesystem::path>& files) {
  for (int type = aiTextureType_NONE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    const auto kind = static_cast<aiTextureType>(type);
    aiString name;
    for (unsigned k = 0; k < material.GetTextureCount(kind); ++k)
      if (material.GetTexture(kind, k, &name) == aiReturn_SUCCESS)
        files.push_back(finder.file(folder, str(name)).value_or(folder / str(name)));
  }
}

LocalMesh to_mesh(const aiMesh& from) {
  LocalMesh to;
  to.material = MaterialId(from.mMaterialIndex);
  to.vertices.reserve(from.mNumVertices);
  for (unsigned v = 0; v < from.mNumVertices; ++v) {
    to.vertices.push_back({from.mVertices[v].x, from.mVertices[v].y, from.mVertices[v].z});
  }
  for (unsigned f = 0; f < from.mNumFaces; ++f) {
    const aiFace& face = from.mFaces[f];
    to.corner.insert(to.corner.end(), face.mIndices, face.mIndices + face.mNumIndices);
    to.face_begin.push_back(static_cast<std::uint32_t>(to.corner.size()));
  }
  return to;
}

double number_of(const aiMetadata* meta, const char* key, double otherwise) {
  double d = 0;
  float f = 0;
  std::int32_t i = 0;
  if (!meta) return otherwise;
  if (meta->Get(key, d)) return d;
  if (meta->Get(key, f)) return f;
  if (meta->Get(key, i)) return i;
  return otherwise;
}

/// What the format says of unit and axes.
void set_frame(Model& model, const aiScene& scene, const std::string& extension) {
  // The unit and axes of a DAE file are in the transform of Assimp's root node, which makes them y-up metres.
  if (extension == ".dae") {
    model.metres_per_unit = 1.0;
    model.up = Up::y;
  } else if (extension == ".fbx") {
    const double centimetres = number_of(scene.mMetaData, "UnitScaleFactor", 1.0);
    model.metres_per_unit = std::isfinite(centimetres) && centimetres > 0 ? centimetres / 100 : 0.01;
    const double axis = number_of(scene.mMetaData, "UpAxis", 1.0);
    model.up = axis == 2 ? Up::z : Up::y;
    if ((axis != 1 && axis != 2) || number_of(scene.mMetaData, "UpAxisSign", 1.0) < 0) {
      model.warnings.push_back("the file says that neither +y nor +z is up; y is taken");
    }
  }
}

Model to_model(const aiScene& scene, const std::filesystem::path& file, const std::string& extension) {
  const std::string name = short_name(file);
  Model model;
  set_frame(model, scene, extension);
  FileFinder finder;
  for (unsigned m = 0; m < scene.mNumMaterials; ++m) {
    model.materials.push_back(to_material(*scene.mMaterials[m]));
    if (auto texture = texture_of(*scene.mMaterials[m], scene, file.parent_path(), finder)) {
      ModelMaterial& material = model.materials.back();
      material.texture = model.textures.size();
      material.material.reflectance = Spectrum(1.0);
      material.described = true;
      model.textures.push_back(std::move(*texture));
    }
  }
  const MaterialId no_material(model.materials.size());
  ModelMaterial& none = model.materials.emplace_back();
  none.material.name = kDefaultMaterial;
  none.described = false;

  for (unsigned m = 0; m < scene.mNumMaterials; ++m)
    add_textures(*scene.mMaterials[m], file.parent_path(), finder, model.files);

  struct Open {
    const aiNode* node;
    Affine outer;
    std::size_t owner;  // index into owners: the nearest node above that has a name
  };
  struct Owner {
    std::string name;
    SurfaceId surface;  // once it carries a mesh
  };
  UniqueNames names;
  std::vector<Owner> owners{{"", {}}};
  std::vector<Open> open;
  if (scene.mRootNode) open.push_back({scene.mRootNode, Affine{}, 0});
  std::size_t faces = 0;
  while (!open.empty()) {
    Open at = open.back();
    open.pop_back();
    const Affine place = without_rounding(at.outer * to_affine(at.node->mTransformation));
    if (const std::string own = str(at.node->mName); !is_made_up(own)) {
      at.owner = owners.size();
      owners.push_back({own, {}});
    }
    for (unsigned c = at.node->mNumChildren; c-- > 0;) open.push_back({at.node->mChildren[c], place, at.owner});
    for (unsigned k = 0; k < at.node->mNumMeshes; ++k) {
      if (at.node->mMeshes[k] >= scene.mNumMeshes) continue;
      const aiMesh& mesh = *scene.mMeshes[at.node->mMeshes[k]];
      Owner& owner = owners[at.owner];
      if (!owner.surface.valid()) {
        const std::string of_mesh = str(mesh.mName);
        owner.surface = SurfaceId(model.surfaces.size());
        model.surfaces.push_back(names.take(!owner.name.empty()    ? owner.name
                                            : !is_made_up(of_mesh) ? of_mesh
                                                                   : file.stem().string()));
      }
      LocalMesh local = to_mesh(mesh);
      if (local.material >= no_material) local.material = no_material;
      faces += mesh.mNumFaces;
      if (faces > kMaxFaces)
        throw InputError(text(name, ": more than ", kMaxFaces, " faces; leave out what light does not need"));
      add_mesh(model, local, place, owner.surface, name);
    }
  }
  if (scene.mNumLights > 0) {
    model.warnings.push_back(text(scene.mNumLights, " lights are left out: this format gives them no unit. ",
                                  "Use glTF, or \"luminaires\" of a scene file"));
  }
  if (model.polygons.face_count() == 0) throw InputError(text(name, ": ", kNoFaces));
  return model;
}

/// A DAE or FBX file that begins with the mark of UTF-8, which Assimp does not skip in all of them, without it; empty
/// for other files.
std::string without_mark(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string head(4, '\0');
  in.read(head.data(), static_cast<std::streamsize>(head.size()));
  if (text_bytes(head, short_name(file)).size() == head.size()) return "";
  return std::string(text_bytes(read_input_file(file, kMaxBytes), short_name(file)));
}

Model import(const std::filesystem::path& file, const std::string& extension) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_USE_COLLADA_NAMES, true);  // names, not ids
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);       // no made-up nodes
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // No post-processing: polygons stay polygons, and node transforms are applied here in double.
  const std::string bytes = without_mark(file);
  const aiScene* scene = bytes.empty()
                             ? importer.ReadFile(file.string(), 0)
                             : importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str() + 1);
  if (!scene) throw InputError(text(short_name(file), ": cannot be read: ", quotable(importer.GetErrorString())));
  return to_model(*scene, file, extension);
}

}  // namespace

Model read_with_assimp(const std::filesystem::path& file) {
  check_input_file(file, kMaxBytes);
  const std::string extension = to_lower(file.extension().string());
  const std::string name = short_name(file);
  const std::uint64_t bytes = std::filesystem::file_size(file);
  // An honest megabyte takes well under a second and some 20 MB; the rest is for slow machines.
  const ApartLimits limits{.time = std::chrono::seconds(20 + 4 * (bytes >> 20)),
                           .memory_bytes = (1ull << 30) + 300 * bytes};
  std::string answer;
  try {
    answer = run_apart(
        [&] {
          try {
            return 'M' + to_bytes(import(file, extension));
          } catch (const InputError& error) {
            return 'E' + std::string(error.what());
          }
        },
        limits);
  } catch (const ApartFailure& failure) {
    throw InputError(
        text(name, ": cannot be read: the ", extension, " importer ", failure.what(),
             " on it; the file is damaged or not what its name says. Try to export it again, as glTF or OBJ"));
  }
  if (answer.empty() || answer[0] != 'M')
    throw InputError(answer.empty() ? name + ": cannot be read" : answer.substr(1));
  return from_bytes(std::string_view(answer).substr(1));
}

}  // namespace clerestory
