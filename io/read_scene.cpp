#include "io/read_scene.h"

#include "io/formats/model.h"
#include "io/formats/texture_means.h"
#include "io/input_file.h"
#include "io/scene_file/nearest_name.h"
#include "io/scene_file/place_model.h"
#include "io/scene_file/read_scene_file.h"
#include "io/scene_file/sky_entries.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

Scene read_lone_model(const std::filesystem::path& file, const ReadOptions& options) {
  Placement placement;
  if (options.unit) {
    placement.metres_per_unit = metres_of_unit(*options.unit);
    if (!placement.metres_per_unit) {
      throw InputError(text("--unit '", quotable(*options.unit), "' is not known; known are m, cm, mm, ft, in"));
    }
  }
  if (options.up) {
    if (*options.up != "y" && *options.up != "z") {
      throw InputError(text("--up '", quotable(*options.up), "' is not known; known are y, z"));
    }
    placement.up = *options.up == "y" ? Up::y : Up::z;
  }
  Scene scene;
  scene.file = file.string();
  if (options.sky) scene.lights.sky = sky_of_option(*options.sky);
  Model model = read_model(file);
  note_files(scene, file, model);
  take_texture_means(model, [](const std::string&) { return false; });
  ModelsInScene none{.takes_gloss = options.gloss.has_value()};
  place_model(scene, none, model, file, placement);
  return scene;
}

}  // namespace

Scene read_scene(const std::filesystem::path& file, const ReadOptions& options) {
  const bool is_scene_file = to_lower(file.extension().string()) == ".json";
  if (!is_scene_file && !options.times.empty())
    throw InputError(text(short_name(file),
                          ": --times is for a scene file, which says where on earth the model stands; ",
                          "write one with \"location\" and \"sky\" or \"sun\""));
  if (!is_scene_file) return read_lone_model(file, options);
  if (options.unit || options.up || options.sky) {
    throw InputError(text(short_name(file), ": --",
                          options.unit ? "unit"
                          : options.up ? "up"
                                       : "sky",
                          " is for a model given directly; write it into the scene file"));
  }
  return read_scene_file(file, options);
}

}  // namespace clerestory
