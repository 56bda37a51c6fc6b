#include "io/scene_file/material_rules.h"

#include <numbers>

#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr Range kReflectance{
    .low = 0, .high = 1, .high_allowed = false, .advice = "a wall cannot reflect more than it receives"};
constexpr Range kTransmittance{.low = 0, .high = 1, .advice = "a sheet cannot pass more than it receives"};
constexpr Range kSpecular{
    .low = 0, .high = 1, .high_allowed = false, .advice = "a lobe cannot reflect more than it receives"};
constexpr Range kExponent{.low = 0, .high = kMostExponent, .advice = "10 is satin, 1000 nearly a mirror"};
constexpr Range kRoughness{
    .low = kLeastRoughness, .high = 1, .advice = "0.1 is polished, 0.5 satin; for a mirror write \"type\": \"mirror\""};
constexpr Range kEmission{
    .low = 0, .high = kMostLight, .advice = "a surface emits no less than nothing and no more than a result can hold"};

/// One way to say what a surface emits; `factor` turns it into W/m2, or W where `total`.
struct Emission {
  std::string_view key;
  double factor;
  bool total;
};
constexpr Emission kEmissions[] = {
    {"exitance", 1, false},                                   // W/m2
    {"luminous_exitance", 1 / kWhiteEfficacy, false},         // lm/m2
    {"radiance", std::numbers::pi, false},                    // W/(m2 sr), the same in all directions
    {"luminance", std::numbers::pi / kWhiteEfficacy, false},  // cd/m2
    {"power", 1, true},                                       // W
    {"luminous_flux", 1 / kWhiteEfficacy, true},              // lm
};

void read_emission(const JsonObject& object, Material& material, ChannelCount& channels) {
  std::string_view given;
  for (const Emission& emission : kEmissions) {
    const auto colour = object.colour(emission.key, kEmission);
    if (!colour) continue;
    if (!given.empty()) {
      throw InputError(
          text(object.where(), ": ", given, " and ", emission.key, " both say what it emits; keep one of them"));
    }
    given = emission.key;
    channels.note(*colour, object.place(emission.key));
    if (emission.total) {
      material.total_power = colour->value * emission.factor;
    } else {
      material.exitance = colour->value * emission.factor;
    }
  }
}

/// "blinds" of a pane that passes `open` without them.
Blinds read_blinds(const JsonObject& pane, const JsonColour& open, ChannelCount& channels) {
  const JsonObject object(pane.at("blinds"), pane.place("blinds"), {"transmittance", "group"});
  const auto closed = object.colour("transmittance", kTransmittance);
  if (!closed)
    throw InputError(text(object.place("transmittance"),
                          " is missing; it is that of the pane with its blinds closed, 0.05 for common venetian ones"));
  channels.note(*closed, object.place("transmittance"));
  if ((open.value - closed->value).min() < 0)
    throw InputError(text(object.place("transmittance"), " = ", closed->value.max(),
                          " is more than the pane passes without blinds, ", open.value.max()));
  return {closed->value, object.word("group").value_or("")};
}

/// What "type": "glossy" has besides the others; its diffuse part is there.
void read_gloss(const JsonObject& object, Material& material, ChannelCount& channels) {
  const auto specular = object.colour("specular", kSpecular);
  if (!specular)
    throw InputError(text(object.place("specular"),
                          " is missing; it is what the lobe reflects at normal incidence, 0.04 for polished stone"));
  channels.note(*specular, object.place("specular"));
  if (!object.has("reflectance")) material.reflectance = Spectrum(0.0);
  const auto exponent = object.number("exponent", kExponent), roughness = object.number("roughness", kRoughness);
  if (exponent.has_value() == roughness.has_value())
    throw InputError(text(object.where(),
                          ": give one of exponent (modified Phong, 0 or more) and roughness (GGX, 0.01 ", "to 1)",
                          exponent ? ", not both" : ""));
  if (const double sum = (material.reflectance + specular->value).max(); !(sum < 1))
    throw InputError(text(object.where(), ": reflectance + specular = ", material.reflectance.max(), " + ",
                          specular->value.max(), " = ", sum,
                          " is outside [0, 1); a surface cannot reflect more than it receives"));
  if (material.sides == 1)
    throw InputError(text(object.place("sides"), " = 1: a glossy surface reflects on both of its sides"));
  material.kind = MaterialKind::glossy;
  material.gloss = Gloss{specular->value, exponent, roughness.value_or(Gloss{}.roughness)};
}

Material read_material(const JsonObject& object, ChannelCount& channels, std::vector<std::string>& warnings) {
  const std::string type = object.choice("type", kMaterialKindNames).value_or("diffuse");
  Material material;
  material.reflectance = Spectrum(0.5);
  if (const auto colour = object.colour("reflectance", kReflectance)) {
    channels.note(*colour, object.place("reflectance"));
    material.reflectance = colour->value;
  }
  const auto transmittance = object.colour("transmittance", kTransmittance);
  if (transmittance) channels.note(*transmittance, object.place("transmittance"));
  read_emission(object, material, channels);
  material.group = object.word("group").value_or("");
  if (!material.group.empty() && !material.emits())
    warnings.push_back(text(object.place("group"), " is not used: the material gives no light to dim"));
  if (const auto sides = object.number("sides", {.low = 1, .high = 2, .advice = "a surface has one lit side or two"})) {
    if (*sides != 1 && *sides != 2) throw InputError(text(object.place("sides"), " = ", *sides, " is neither 1 nor 2"));
    material.sides = static_cast<int>(*sides);
  }
  for (const char* key : {"specular", "exponent", "roughness"})
    if (type != "glossy" && object.has(key))
      throw InputError(text(
          object.place(key), " needs \"type\": \"glossy\"",
          type == "glass" || type == "mirror" ? text("; ", type == "glass" ? "glass" : "a mirror", " is smooth") : ""));
  if (type != "glass" && object.has("blinds"))
    throw InputError(text(object.place("blinds"), ": blinds belong to a pane; write \"type\": \"glass\""));
  if (type == "glass") {
    if (!transmittance) {
      throw InputError(
          text(object.place("transmittance"), " is missing; glass needs it, 0.65 for common double glazing"));
    }
    if (material.emits())
      throw InputError(text(object.where(), ": glass does not emit; give the light to another surface"));
    if (object.has("reflectance")) {
      warnings.push_back(text(object.place("reflectance"),
                              " is not used: what glass reflects follows from its transmittance and its index, 1.52"));
    }
    // 0.92 is what people write for clear glass.
    if (transmittance->value.max() > 0.925) {
      warnings.push_back(text(object.place("transmittance"), " = ", transmittance->value.max(),
                              " is more than the 0.918 of clear glass; taken as glass coated to reflect less"));
    }
    material.kind = MaterialKind::glass;
    material.transmittance = transmittance->value;
    if (object.has("blinds")) material.blinds = read_blinds(object, *transmittance, channels);
  } else if (type == "diffuser") {
    if (!transmittance) {
      throw InputError(text(object.place("transmittance"),
                            " is missing; a diffuser needs it, and its reflectance: 0.3 and 0.5 for a white blind"));
    }
    if (material.sides == 1)
      throw InputError(text(object.place("sides"), " = 1: a diffuser acts on both of its sides"));
    material.kind = MaterialKind::diffuser;
    material.transmittance = transmittance->value;
    if (const double sum = (material.reflectance + material.transmittance).max(); !(sum < 1)) {
      throw InputError(text(object.where(), ": reflectance + transmittance = ", sum,
                            " is outside [0, 1); a sheet cannot give back and pass more than it receives"));
    }
  } else if (transmittance) {
    throw InputError(text(object.place("transmittance"), " needs \"type\": \"glass\" or \"diffuser\""));
  }
  if (type == "mirror") {
    if (!object.has("reflectance"))
      throw InputError(text(object.place("reflectance"), " is missing; a mirror needs it, 0.9 for a common one"));
    if (material.emits())
      throw InputError(text(object.where(), ": a mirror does not emit; give the light to another surface"));
    if (material.sides == 1) throw InputError(text(object.place("sides"), " = 1: a mirror acts on both of its sides"));
    material.kind = MaterialKind::mirror;
  }
  if (type == "glossy") read_gloss(object, material, channels);
  return material;
}

}  // namespace

void ChannelCount::note(const JsonColour& colour, const std::string& place) {
  if (colour.array_length == 0) return;
  if (length_ == 0) {
    length_ = colour.array_length;
    first_place_ = place;
  } else if (length_ != colour.array_length) {
    throw InputError(text(place, " has ", colour.array_length, colour.array_length == 1 ? " value" : " values",
                          ", but ", first_place_.substr(first_place_.find(": ") + 2), " has ", length_,
                          "; one channel and three channels mixed. A plain number goes with both"));
  }
}

bool matches(std::string_view pattern, std::string_view name) {
  // Greedy with one point of return, the last star: linear in practice, never exponential.
  std::size_t p = 0, n = 0, star = pattern.npos, resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      resume = n;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == name[n])) {
      ++p;
      ++n;
    } else if (star != pattern.npos) {
      p = star + 1;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<MaterialRule> read_material_rules(const Json& materials, const std::string& file_name,
                                              ChannelCount& channels, std::vector<std::string>& warnings) {
  if (!materials.is_object()) refuse_type(file_name + ": materials", "an object of name patterns", materials);
  std::vector<MaterialRule> rules;
  for (const auto& [pattern, value] : materials.items()) {
    const JsonObject object(
        value, text(file_name, ": materials '", quotable(pattern), "'"),
        {"type", "reflectance", "transmittance", "sides", "exitance", "luminous_exitance", "radiance", "luminance",
         "power", "luminous_flux", "group", "blinds", "specular", "exponent", "roughness"},
        ": ");
    rules.push_back({pattern, read_material(object, channels, warnings), {}});
  }
  return rules;
}

bool apply_rules(std::vector<MaterialRule>& rules, Material& material) {
  for (MaterialRule& rule : rules) {
    if (!matches(rule.pattern, material.name)) continue;
    rule.used.push_back(material.name);
    const std::string name = material.name;
    material = rule.material;
    material.name = name;
    return true;
  }
  return false;
}

}  // namespace clerestory
