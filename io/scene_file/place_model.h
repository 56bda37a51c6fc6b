#pragma once
// Model -> its place in the scene: metres, z up, names that no other file uses.

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "io/affine.h"
#include "io/formats/model.h"

namespace clerestory {

/// How a model is put into the scene. What the file itself says of its unit and axes wins.
struct Placement {
  std::optional<double> metres_per_unit;
  std::optional<Up> up;
  std::optional<std::array<double, 16>> transform;  ///< row-major, of the scene's frame [m]; last row 0 0 0 1
};

/// From a model's frame into the scene's: first the unit, then the turn of (x, y, z) into (x, -z, y), then the
/// transform.
Affine to_scene(double metres, Up up, const std::optional<std::array<double, 16>>& transform);

/// Metres of "m", "cm", "mm", "ft" or "in"; nothing for other words.
std::optional<double> metres_of_unit(std::string_view unit);

/// Gives a material what the scene file says about its name, and returns whether it says anything.
using MaterialOverride = std::function<bool(Material&)>;

/// Names in use, and a free one beside any other: "wall", "wall (annex)", "wall (annex 2)".
class NamesInUse {
 public:
  std::string take(const std::string& name, const std::string& stem);

 private:
  std::unordered_set<std::string> taken_;
  std::unordered_map<std::string, int> last_;  ///< number given for a name and stem
};

/// What the models that a scene has so far have said; one for all of them, so that the thousandth is not compared with
/// all before it.
struct ModelsInScene {
  bool takes_gloss = false;  ///< of their materials
  NamesInUse surfaces{}, materials{}, spaces{};
  std::unordered_map<std::string, MaterialId> material{};  ///< by name
  std::unordered_set<std::string> warnings{};
};

/// Adds what a model was read from to the scene's files.
void note_files(Scene& scene, const std::filesystem::path& file, const Model& model);

/// The luminaire that the scene file names for a fixture, its position, axes and names in the scene's frame; nothing
/// when it names none.
using FixtureLight = std::function<std::optional<Luminaire>(const ModelFixture&)>;

/// A fixture becomes the luminaire that by_fixture names for it, else those that the model itself describes, and its
/// housing is left out: photometry is of the whole luminaire. What stays without light keeps its surface, and is said.
///
/// throws  InputError naming the surface whose coordinates leave the representable range.
void place_model(Scene& scene, ModelsInScene& before, const Model& model, const std::filesystem::path& file,
                 const Placement& placement, const MaterialOverride& by_scene_file = {},
                 const FixtureLight& by_fixture = {});

}  // namespace clerestory
