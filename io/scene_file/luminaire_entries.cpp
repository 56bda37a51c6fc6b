#include "io/scene_file/luminaire_entries.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostLuminaires = 1'000'000;
constexpr Range kFlux{.low = 0,
                      .high = kMostLight,
                      .advice = "a luminaire emits no less than nothing and no more than a result can hold"};

class LuminaireReader {
 public:
  LuminaireReader(const std::filesystem::path& folder, PhotometryFiles& photometry, ChannelCount& channels,
                  Scene& scene)
      : folder_(folder), photometry_(photometry), channels_(channels), scene_(scene) {}

  void read(const JsonObject& object, std::size_t number, LightSpec& lights) {
    std::string name = object.word("name").value_or("");
    if (name.empty()) name = text("luminaire ", number);
    const std::string group = object.word("group").value_or("");
    object.at("position");
    const Vec3 position = *object.vector("position", kCoordinate);
    constexpr std::string_view kTypes[] = {"point"};
    const bool is_point = object.choice("type", kTypes).has_value();
    if (object.has("file")) {
      if (is_point) {
        throw InputError(text(object.where(),
                              ": has a file, which says where its light goes, and \"type\": \"point\"; ",
                              "keep one of them"));
      }
      lights.luminaires.push_back({std::move(name), position, group, read_web(object)});
    } else if (is_point) {
      lights.luminaires.push_back({std::move(name), position, group, PointLuminaire{read_point_power(object)}});
    } else {
      throw InputError(text(object.where(), " says neither \"file\", the name of an .ies or .ldt file, nor \"type\": ",
                            "\"point\"; a luminaire needs one of them"));
    }
  }

  FixtureRule read_rule(const std::string& pattern, const JsonObject& object) {
    FixtureRule rule{pattern, object.word("group").value_or(""), {}, false, 0};
    object.at("file");
    rule.luminaire.web = web_of(object);
    const double rotation = object.number("rotation", kRotation).value_or(0);
    rule.luminaire.axes = aimed(rule.luminaire.web->type, {0, 0, -1}, rotation);
    rule.luminaire.scale = Spectrum(1 / kWhiteEfficacy);
    if (const auto power = read_flux(object)) {
      rule.luminaire.scale = scale_to(*power, object, *rule.luminaire.web);
      rule.flux_is_given = true;
    }
    rule.luminaire.scale *= read_dimming(object);
    return rule;
  }

 private:
  static constexpr Range kRotation{.low = -3600, .high = 3600, .advice = "it is in degrees about aim"};

  static Spectrum scale_to(const Spectrum& power, const JsonObject& object, const PhotometricWeb& web) {
    if (web.flux > 0) return power / web.flux;
    throw InputError(text(object.place("file"), " '", web.name, "' gives no light; its flux cannot be scaled to ",
                          "the one the scene asks for; leave that out, or name another file"));
  }

  /// In watts, or nothing; before dimming.
  std::optional<Spectrum> read_flux(const JsonObject& object) {
    const auto flux = object.colour("luminous_flux", kFlux);
    const auto power = object.colour("power", kFlux);
    if (flux && power) {
      throw InputError(text(object.where(), ": luminous_flux and power both say what it emits; keep one of them"));
    }
    if (!flux && !power) return std::nullopt;
    channels_.note(flux ? *flux : *power, object.place(flux ? "luminous_flux" : "power"));
    return flux ? flux->value / kWhiteEfficacy : power->value;
  }

  static double read_dimming(const JsonObject& object) {
    return object.number("dimming", {.low = 0, .high = 1000, .advice = "1 is full light"}).value_or(1) *
           object
               .number("maintenance_factor", {.low = 0,
                                              .high = 1,
                                              .low_allowed = false,
                                              .advice = "it is what is left of the light of new lamps"})
               .value_or(1);
  }

  Spectrum read_point_power(const JsonObject& object) {
    const auto power = read_flux(object);
    if (!power)
      throw InputError(text(object.place("luminous_flux"), " is missing; a luminaire needs its flux in lumens"));
    if (object.unit_vector("aim") || object.number("rotation")) {
      scene_.warnings.push_back(
          text(object.where(), ": aim and rotation are not used: a point shines the same in all directions"));
    }
    return *power * read_dimming(object);
  }

  WebLuminaire read_web(const JsonObject& object) {
    WebLuminaire luminaire;
    luminaire.web = web_of(object);
    const PhotometricWeb& web = *luminaire.web;
    const Vec3 upright = beam_axis(web.type);
    const Vec3 aim = object.unit_vector("aim").value_or(upright);
    const double rotation = object.number("rotation", kRotation).value_or(0);
    luminaire.axes = aimed(web.type, aim, rotation);
    luminaire.scale = Spectrum(1 / kWhiteEfficacy);
    if (const auto power = read_flux(object)) {
      luminaire.scale = scale_to(*power, object, web);
    } else {
      const double tilt = std::acos(std::clamp(dot(aim, upright), -1.0, 1.0)) * 180 / std::numbers::pi;
      luminaire.scale *= tilt_factor(web, tilt);
    }
    luminaire.scale *= read_dimming(object);
    return luminaire;
  }

  std::shared_ptr<const PhotometricWeb> web_of(const JsonObject& object) {
    const std::string named = *object.word("file");
    require_file(folder_ / named, object.place("file"), named);
    return photometry_.read(folder_ / named, scene_.warnings, scene_.files);
  }

  const std::filesystem::path& folder_;
  PhotometryFiles& photometry_;
  ChannelCount& channels_;
  Scene& scene_;
};

}  // namespace

void read_luminaire_entries(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                            PhotometryFiles& photometry, ChannelCount& channels, Scene& scene) {
  if (!root.has("luminaires")) return;
  const Json& entries = as_array(root.at("luminaires"), root.place("luminaires"), "luminaires");
  if (entries.size() > kMostLuminaires)
    throw InputError(text(root.place("luminaires"), " has more than ", kMostLuminaires, " entries"));
  LuminaireReader reader(folder, photometry, channels, scene);
  std::size_t n = 0;
  for (const Json& entry : entries) {
    const JsonObject object(entry, text(file_name, ": luminaires[", n++, "]"),
                            {"name", "type", "file", "position", "aim", "rotation", "luminous_flux", "power", "dimming",
                             "maintenance_factor", "group"});
    reader.read(object, n, scene.lights);
  }
}

std::vector<FixtureRule> read_fixture_rules(const JsonObject& root, const std::string& file_name,
                                            const std::filesystem::path& folder, PhotometryFiles& photometry,
                                            ChannelCount& channels, Scene& scene) {
  std::vector<FixtureRule> rules;
  if (!root.has("fixtures")) return rules;
  const Json& entries = root.at("fixtures");
  if (!entries.is_object()) refuse_type(root.place("fixtures"), "an object of names and photometric files", entries);
  LuminaireReader reader(folder, photometry, channels, scene);
  for (const auto& [pattern, value] : entries.items()) {
    const std::string place = text(file_name, ": fixtures '", quotable(pattern), "'");
    if (!value.is_string() && !value.is_object()) refuse_type(place, "the name of an .ies or .ldt file", value);
    const Json entry = value.is_string() ? Json{{"file", value}} : value;
    const JsonObject object(entry, place,
                            {"file", "rotation", "luminous_flux", "power", "dimming", "maintenance_factor", "group"});
    rules.push_back(reader.read_rule(pattern, object));
  }
  return rules;
}

std::optional<Luminaire> apply_rules(std::vector<FixtureRule>& rules, const ModelFixture& fixture) {
  for (FixtureRule& rule : rules) {
    const auto is_match = [&](const std::string& name) { return matches(rule.pattern, name); };
    if (std::ranges::none_of(fixture.names, is_match)) continue;
    ++rule.used;
    WebLuminaire luminaire = rule.luminaire;
    const Vec3 y = cross(fixture.z, fixture.x);
    for (Vec3* axis : {&luminaire.axes.x, &luminaire.axes.y, &luminaire.axes.z})
      *axis = fixture.x * axis->x + y * axis->y + fixture.z * axis->z;
    if (!rule.flux_is_given) {
      const double tilt = std::acos(std::clamp(fixture.z.z, -1.0, 1.0)) * 180 / std::numbers::pi;
      luminaire.scale *= tilt_factor(*luminaire.web, tilt);
    }
    return Luminaire{fixture.names.front(), fixture.position, rule.group, luminaire};
  }
  return std::nullopt;
}

}  // namespace clerestory
