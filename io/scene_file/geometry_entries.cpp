#include "io/scene_file/geometry_entries.h"

#include <algorithm>
#include <cmath>

#include "io/input_file.h"
#include "io/parse_json.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::size_t kMaxGeometry = 10'000;

std::array<double, 16> read_transform(const JsonObject& object) {
  constexpr Range kTransform{.low = kCoordinate.low, .high = kCoordinate.high, .advice = "it moves metres to metres"};
  const std::vector<double> values = *object.numbers("transform", 16, kTransform);
  const std::string place = object.place("transform");
  std::array<double, 16> t{};
  std::copy(values.begin(), values.end(), t.begin());
  if (t[12] != 0 || t[13] != 0 || t[14] != 0 || t[15] != 1) {
    const bool by_columns = t[3] == 0 && t[7] == 0 && t[11] == 0 && t[15] == 1;
    throw InputError(
        text(place, ": the last row is not 0, 0, 0, 1; ",
             by_columns ? "the numbers go row by row, not column by column" : "only affine transforms are read"));
  }
  // Rows first brought to length 1, so that neither a small nor a huge scale counts as flat.
  const Vec3 x = unit_vector({t[0], t[1], t[2]}), y = unit_vector({t[4], t[5], t[6]}),
             z = unit_vector({t[8], t[9], t[10]});
  if (!(std::abs(dot(x, cross(y, z))) > 1e-12)) {
    throw InputError(place + ": flattens the model; its 3 x 3 part has no inverse");
  }
  return t;
}
}  // namespace

JsonObject root_of_scene(const Json& json, const std::string& file_name) {
  return JsonObject(json, file_name,
                    {"geometry", "materials", "fixtures", "luminaires", "sky", "sun", "location", "time", "sensors",
                     "rooms", "solver"},
                    ": ");
}

std::vector<GeometryEntry> geometry_entries(const JsonObject& root, const std::string& file_name,
                                            const std::filesystem::path& folder) {
  const Json& entries = as_array(root.at("geometry"), root.place("geometry"), "models");
  if (entries.empty())
    throw InputError(text(root.place("geometry"), " is empty; name a model: [{ \"file\": \"room.obj\" }]"));
  if (entries.size() > kMaxGeometry)
    throw InputError(text(root.place("geometry"), " has more than ", kMaxGeometry, " entries"));
  std::vector<GeometryEntry> all;
  std::size_t n = 0;
  for (const Json& entry : entries) {
    const JsonObject object(entry, text(file_name, ": geometry[", n++, "]"), {"file", "unit", "up", "transform"});
    Placement placement;
    constexpr std::string_view kUnits[] = {"m", "cm", "mm", "ft", "in"};
    constexpr std::string_view kUps[] = {"y", "z"};
    if (const auto unit = object.choice("unit", kUnits)) placement.metres_per_unit = metres_of_unit(*unit);
    if (const auto up = object.choice("up", kUps)) placement.up = *up == "y" ? Up::y : Up::z;
    if (object.has("transform")) placement.transform = read_transform(object);
    object.at("file");
    const std::string model_name = *object.word("file");
    const std::filesystem::path model_file = folder / model_name;
    if (to_lower(model_file.extension().string()) == ".json") {
      throw InputError(text(object.place("file"), " '", quotable(model_name), "' is a scene file; name a model"));
    }
    require_file(model_file, object.place("file"), model_name);
    all.push_back({object.where(), model_file, placement});
  }
  return all;
}

std::vector<GeometryEntry> read_geometry_entries(const std::filesystem::path& file) {
  const std::string name = short_name(file);
  const Json json = parse_json<Json>(read_input_file(file, kMaxSceneFileBytes), name);
  return geometry_entries(root_of_scene(json, name), name, file.parent_path());
}

}  // namespace clerestory
