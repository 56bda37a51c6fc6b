#include "io/scene_file/light_entries.h"

#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

PointLuminaire read_luminaire(const JsonObject& object, ChannelCount& channels, std::vector<std::string>& warnings) {
  if (object.has("file")) {
    throw InputError(text(object.place("file"), " '", quotable(object.word("file").value_or("")),
                          "': luminaire files are not available in this version; use \"type\": \"point\" with its ",
                          "luminous_flux"));
  }
  constexpr std::string_view kTypes[] = {"point"};
  if (!object.choice("type", kTypes))
    throw InputError(text(object.place("type"), " is missing; use \"type\": \"point\""));
  PointLuminaire luminaire;
  luminaire.name = object.word("name").value_or("");
  luminaire.group = object.word("group").value_or("");
  object.at("position");
  luminaire.position = *object.vector("position", kCoordinate);
  constexpr Range kFlux{
      .low = 0, .high = kMostLight, .advice = "a lamp emits no less than nothing and no more than a result can hold"};
  const auto flux = object.colour("luminous_flux", kFlux);
  const auto power = object.colour("power", kFlux);
  if (flux && power) {
    throw InputError(text(object.where(), ": luminous_flux and power both say what it emits; keep one of them"));
  }
  if (!flux && !power)
    throw InputError(text(object.place("luminous_flux"), " is missing; a lamp needs its flux in lumens"));
  channels.note(flux ? *flux : *power, object.place(flux ? "luminous_flux" : "power"));
  luminaire.power = flux ? flux->value / kWhiteEfficacy : power->value;
  luminaire.power *= object.number("dimming", {.low = 0, .high = 1000, .advice = "1 is full light"}).value_or(1);
  if (object.unit_vector("aim") || object.number("rotation")) {
    warnings.push_back(
        text(object.where(), ": aim and rotation are not used: a point shines the same in all directions"));
  }
  return luminaire;
}

}  // namespace

void read_light_entries(const JsonObject& root, const std::string& file_name, ChannelCount& channels, Lights& lights,
                        std::vector<std::string>& warnings) {
  if (root.has("luminaires")) {
    std::size_t n = 0;
    for (const Json& entry : as_array(root.at("luminaires"), root.place("luminaires"), "luminaires")) {
      const JsonObject object(
          entry, text(file_name, ": luminaires[", n++, "]"),
          {"name", "type", "file", "position", "aim", "rotation", "luminous_flux", "power", "dimming", "group"});
      lights.points.push_back(read_luminaire(object, channels, warnings));
      if (lights.points.back().name.empty()) lights.points.back().name = text("luminaire ", n);
    }
  }
}

}  // namespace clerestory
