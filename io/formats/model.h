#pragma once
// What one model file says, in its own frame and unit, before it takes its place in a scene.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/scene.h"

namespace clerestory {

enum class Up { y, z };

struct Model {
  PolygonSoup polygons;
  std::vector<Material> materials;
  std::vector<std::string> surfaces;
  Lights lights;
  std::vector<std::string> warnings;      ///< without the file's name
  std::optional<double> metres_per_unit;  ///< when the file says its unit
  std::optional<Up> up;                   ///< when the file says its axes
};

inline constexpr double kLargestCoordinate = 1e12;  ///< farther than this a coordinate is a mistake
/// A model's white (Kd 1) reflects this much: nothing real reflects all, and closed white rooms would never darken.
inline constexpr double kWhitestReflectance = 0.99;
inline constexpr double kDefaultReflectance = 0.5;

/// Reads a model by the reader of its extension.
///
/// throws  InputError, also when the extension is unknown or the file has no face.
Model read_model(const std::filesystem::path& file);

Model read_obj(const std::filesystem::path& file);

/// Materials of a Wavefront MTL file, in its order. What is left out is added to `warnings`.
std::vector<Material> read_mtl(const std::filesystem::path& file, std::vector<std::string>& warnings);

/// Takes a transparent material (opacity below 1/2) as glass that passes what it does not cover.
void apply_opacity(Material& material, double opacity);

/// Brings reflectances of 1 and more below 1, and says so, once; says which materials became glass.
void settle_materials(Model& model);

}  // namespace clerestory
