#include "io/scene_file/read_scene_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "io/formats/model.h"
#include "io/formats/texture_means.h"
#include "io/input_file.h"
#include "io/memory_size.h"
#include "io/parse_json.h"
#include "io/scene_file/geometry_entries.h"
#include "io/scene_file/json_object.h"
#include "io/scene_file/luminaire_entries.h"
#include "io/scene_file/material_rules.h"
#include "io/scene_file/place_and_time.h"
#include "io/scene_file/place_model.h"
#include "io/scene_file/room_entries.h"
#include "io/scene_file/sensor_entries.h"
#include "io/scene_file/sky_entries.h"
#include "io/scene_file/sky_of_times.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"
#include "solver/model/method.h"

namespace clerestory {
namespace {

void read_geometry(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                   std::vector<MaterialRule>& rules, std::vector<FixtureRule>& fixtures, bool takes_gloss,
                   Scene& scene) {
  std::map<std::filesystem::path, Model> read_before;
  ModelsInScene placed{.takes_gloss = takes_gloss};
  for (const auto& [where, model_file, placement] : geometry_entries(root, file_name, folder)) {
    std::error_code error;  // then read_model says what is wrong
    const std::filesystem::path one_name = std::filesystem::weakly_canonical(model_file, error);
    auto model = read_before.find(one_name);
    if (model == read_before.end()) {
      model = read_before.emplace(one_name, read_model(model_file)).first;
      note_files(scene, model_file, model->second);
      take_texture_means(model->second, [&](const std::string& material) {
        return std::ranges::any_of(
            rules, [&](const MaterialRule& rule) { return matches(rule.pattern, clean_text(material)); });
      });
    } else {
      model->second.warnings.clear();  // said already
      model->second.not_read.clear();
    }
    if (scene.polygons.face_count() + model->second.polygons.face_count() > kMaxFaces) {
      throw InputError(
          text(where, ": more than ", kMaxFaces, " faces in one scene; leave out what light does not need"));
    }
    place_model(
        scene, placed, model->second, model_file, placement,
        [&](Material& material) { return apply_rules(rules, material); },
        [&](const ModelFixture& fixture) { return apply_rules(fixtures, fixture); });
  }
}

/// "2GiB", or a number of MiB.
std::size_t read_memory_size(const JsonObject& object, std::string_view key) {
  const Json& value = object.at(key);
  if (!value.is_string() && !value.is_number()) refuse_type(object.place(key), "text or a number", value);
  const std::string written = value.is_string() ? value.get<std::string>() : value.dump();
  const auto bytes = to_memory_size(written);
  if (!bytes)
    throw InputError(text(object.place(key), " '", quotable(written), "' is no amount of memory; ", kMemorySizes));
  return *bytes;
}

SolverSettings read_settings(const JsonObject& object) {
  SolverSettings settings;
  settings.method = object.choice("method", kMethodNames);
  settings.accuracy = object.choice("accuracy", kAccuracyNames);
  settings.oracle = object.choice("oracle", kOracleNames);
  settings.max_element =
      object.number("max_element", {.low = 0, .low_allowed = false, .advice = "it is an edge in metres"});
  settings.detail = object.number("detail", {.low = 0, .advice = "it is a length in metres"});
  settings.target_error = object.number(
      "target_error",
      {.low = 0, .high = 1, .low_allowed = false, .high_allowed = false, .advice = "it is relative: 0.02 is 2 %"});
  settings.time_limit = object.number("time_limit", {.low = 0, .low_allowed = false, .advice = "it is in seconds"});
  if (object.has("memory_limit")) settings.memory_limit = read_memory_size(object, "memory_limit");
  if (const auto seed =
          object.number("seed", {.low = 0, .high = 9007199254740992.0, .advice = "it is a whole number"})) {
    if (*seed != std::floor(*seed))
      throw InputError(text(object.place("seed"), " = ", *seed, " is not a whole number"));
    settings.seed = static_cast<std::uint64_t>(*seed);
  }
  return settings;
}

/// Every file that the scene names by its keys. Its models and lamps name more; who reads those tells.
void add_named_files(const Json& json, const std::filesystem::path& folder, std::set<std::filesystem::path>& files) {
  for (const auto& [key, value] : json.items()) {
    if (value.is_structured()) add_named_files(value, folder, files);
    const bool names_file = key == "file" || key == "weather" || key == "image";
    if (names_file && value.is_string()) files.insert(folder / value.get<std::string>());
  }
}

void report_rules(const std::vector<MaterialRule>& rules, const std::string& file_name, Scene& scene) {
  for (const MaterialRule& rule : rules) {
    std::vector<std::string> used = rule.used;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    if (used.empty()) scene.unused_materials.push_back(rule.pattern);
    if (rule.material.total_power && used.size() > 1) {
      scene.warnings.push_back(text(file_name, ": materials '", quotable(rule.pattern), "' matches ", used.size(),
                                    " materials; each of them emits all of its flux"));
    }
  }
}

/// A model's north is not taken over in silence, nor forgotten: the sun of a scene depends on it.
void compare_north(const JsonObject& root, const std::string& file_name, Scene& scene) {
  if (!scene.model_north_deg || !root.has("location")) return;
  const Json& location = root.at("location");
  const double said = location.contains("north") && location["north"].is_number() ? location["north"].get<double>() : 0;
  const double off = std::remainder(*scene.model_north_deg - said, 360);
  if (std::abs(off) < 0.1) return;
  scene.warnings.push_back(text(file_name, ": the model says that north is ", *scene.model_north_deg,
                                " degrees clockwise from +y, the scene's location says ", said,
                                "; the scene counts. Write \"north\": ", *scene.model_north_deg,
                                " to follow the model"));
}

}  // namespace

Scene read_scene_file(const std::filesystem::path& file, const ReadOptions& options) {
  const std::string name = short_name(file);
  const Json json = parse_json<Json>(read_input_file(file, kMaxSceneFileBytes), name);
  const JsonObject root = root_of_scene(json, name);
  Scene scene;
  scene.file = file.string();
  std::set<std::filesystem::path> files{file};
  add_named_files(json, file.parent_path(), files);
  scene.files.assign(files.begin(), files.end());
  const std::filesystem::path folder = file.parent_path();
  ChannelCount channels;
  std::vector<MaterialRule> rules;
  // What is quick to check comes first; models may take a while.
  if (root.has("materials")) rules = read_material_rules(root.at("materials"), name, channels, scene.warnings);
  PhotometryFiles photometry;
  read_luminaire_entries(root, name, folder, photometry, channels, scene);
  std::vector<FixtureRule> fixtures = read_fixture_rules(root, name, folder, photometry, channels, scene);
  if (options.for_a_year)
    scene.ground_reflectance = read_ground(root, name);
  else if (options.times.empty())
    scene.daylight = read_sky_entries(root, name, folder, channels, scene.lights, scene.warnings);
  else
    read_sky_of_times(root, name, folder, options.times, channels, scene);
  const PlaceAndTime at = read_place_and_time(root, name);
  scene.place = at.place;
  scene.north_deg = at.north_deg;
  if (root.has("solver")) {
    scene.settings = read_settings(JsonObject(root.at("solver"), name + ": solver",
                                              {"method", "accuracy", "oracle", "max_element", "detail", "target_error",
                                               "time_limit", "memory_limit", "seed"}));
  }
  SensorEntries sensors;
  if (root.has("sensors")) sensors = read_sensor_entries(root.at("sensors"), name, folder);
  read_geometry(root, name, folder, rules, fixtures, options.gloss.has_value(), scene);
  scene.sensors = sets_of(std::move(sensors), scene.spaces);
  if (root.has("rooms")) read_room_entries(root.at("rooms"), name, scene);
  report_rules(rules, name, scene);
  for (const FixtureRule& rule : fixtures)
    if (rule.used == 0)
      scene.warnings.push_back(
          text(name, ": fixtures '", quotable(rule.pattern), "' matches no light fixture that a model places"));
  compare_north(root, name, scene);
  return scene;
}

}  // namespace clerestory
