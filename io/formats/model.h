#pragma once
// What one model file says, in its own frame and unit, before it takes its place in a scene.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/scene.h"

namespace clerestory {

enum class Up { y, z };

/// An image that materials of a model show.
struct ModelTexture {
  std::string name;            ///< for people
  std::filesystem::path file;  ///< empty: it is in `bytes`, or not there at all
  std::string bytes;           ///< of an image inside of the model
};

/// What a model says of the gloss of a material: specular = of_all + of_colour x its colour, of which the rest is
/// diffuse.
struct ModelGloss {
  Spectrum of_all{0.0};
  double of_colour = 0;  ///< 1: a metal
  std::optional<double> exponent{};
  double roughness = 1;
};

/// A material as the model has it, and what was assumed about it; the assumptions matter only where the scene file
/// says nothing of the material.
struct ModelMaterial {
  Material material;
  std::optional<ModelGloss> gloss{};
  bool described = true;                    ///< false: the model has only its name, or not even that
  std::optional<std::size_t> texture;       ///< of Model::textures: its colour times this reflectance is what shows
  std::optional<std::size_t> glow_texture;  ///< the same of what it emits
  std::string took, kept;      ///< textures whose means are in its colours, and those that could not be read, and why
  bool unitless_glow = false;  ///< its emission had no unit and was taken as radiance [W/(m2 sr)]
};

/// A product that may be a lamp: scene files name photometric files for such.
struct ModelFixture {
  std::vector<std::string> names;  ///< its own, its type's
  bool is_fixture = true;          ///< false: by its class it may be anything
  Vec3 position;                   ///< of the photometric centre
  Vec3 x{1, 0, 0}, z{0, 0, 1};     ///< its own axes, unit; it shines along -z
  std::optional<SurfaceId> body;   ///< its housing, which is no surface any more once its light is known
  std::vector<Luminaire> lights;   ///< what the file itself says of its light
  std::vector<std::string> mute;   ///< light sources of which the file does not say how much they give: "positional"
};

struct Model {
  PolygonSoup polygons;
  std::vector<ModelMaterial> materials;
  std::vector<ModelTexture> textures;
  std::vector<std::string> surfaces;
  LightSpec lights;
  std::vector<NamedSpace> spaces;
  std::vector<ModelFixture> fixtures;
  std::vector<std::string> warnings;         ///< without the file's name
  std::vector<NotRead> not_read;             ///< what the reader did not use
  std::vector<std::filesystem::path> files;  ///< other files that it names, read or not: materials, buffers, textures
  std::optional<double> north_deg;           ///< true north, from +y clockwise seen from above, when the file says it
  std::optional<double> metres_per_unit;     ///< when the file says its unit
  std::optional<Up> up;                      ///< when the file says its axes
};

/// What is said of a model without a face.
inline constexpr std::string_view kNoFaces =
    "has no faces; nothing to light. Export its surfaces as polygons or triangles";
inline constexpr std::string_view kDefaultMaterial = "default";  ///< name where the model has none
inline constexpr std::size_t kMaxFaces = 30'000'000;  ///< of one scene; more is a mistake, or a file made to do harm
inline constexpr double kLargestCoordinate = 1e12;    ///< farther than this a coordinate is a mistake
/// A model's white (Kd 1) reflects this much: nothing real reflects all, and closed white rooms would never darken.
inline constexpr double kWhitestReflectance = 0.99;

/// Reads a model by the reader of its extension.
///
/// throws  InputError, also when the extension is unknown or the file has no face.
Model read_model(const std::filesystem::path& file);

Model read_obj(const std::filesystem::path& file);
Model read_gltf(const std::filesystem::path& file);  ///< .gltf and .glb
Model read_ply(const std::filesystem::path& file);
Model read_stl(const std::filesystem::path& file);
Model read_off(const std::filesystem::path& file);
Model read_ifc(const std::filesystem::path& file);

/// Takes a transparent material (opacity below 1/2) as glass that passes what it does not cover.
void apply_opacity(Material& material, double opacity);

}  // namespace clerestory
