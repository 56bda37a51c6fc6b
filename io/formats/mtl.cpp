// Wavefront MTL: newmtl, Kd, Ke, their textures map_Kd and map_Ke, d and Tr. Source: Ramey, Rose & Tyerman, "MTL
// material format", 1995.

#include "io/formats/mtl.h"

#include <algorithm>
#include <numbers>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 256u << 20;

/// "r g b", or one number for all three; nothing for the spectral and CIE XYZ forms.
std::optional<Spectrum> read_colour(std::string_view rest, const std::string& where) {
  Spectrum colour;
  int count = 0;
  for (std::string_view word = next_word(rest); !word.empty() && count < 3; word = next_word(rest)) {
    if (count == 0 && (word == "spectral" || word == "xyz")) return std::nullopt;
    const std::optional<double> value = to_number(word);
    if (!value || !(*value >= 0 && *value <= kLargestCoordinate)) {
      throw InputError(text(where, "'", quotable(word), "' is not a number from 0 to ", kLargestCoordinate));
    }
    colour[count++] = *value;
  }
  if (count == 0) throw InputError(text(where, "a colour needs one or three numbers, and there is none"));
  if (count == 1) return Spectrum(colour[0]);
  if (count == 2) throw InputError(text(where, "a colour needs one or three numbers, and there are two"));
  return colour;
}

/// What is no colour is none: few ask for gloss, and nobody shall lose a model for it.
Spectrum colour_of_gloss(std::string_view rest, const std::string& where) {
  try {
    return read_colour(rest, where).value_or(Spectrum(0.0));
  } catch (const InputError&) {
    return Spectrum(0.0);
  }
}

/// By a keyword in lower case.
bool names_texture(std::string_view key) {
  return key.starts_with("map_") || key == "bump" || key == "disp" || key == "decal" || key == "refl" || key == "norm";
}

/// What stands behind the options of a texture: "-s 2 2 1 -clamp on my wood.png".
std::string_view image_name(std::string_view rest) {
  struct Option {
    std::string_view name;
    int arguments;
    bool may_be_fewer;
  };
  constexpr Option kOptions[] = {
      {"-blendu", 1, false}, {"-blendv", 1, false},  {"-boost", 1, false}, {"-bm", 1, false}, {"-cc", 1, false},
      {"-clamp", 1, false},  {"-imfchan", 1, false}, {"-mm", 2, false},    {"-o", 3, true},   {"-s", 3, true},
      {"-t", 3, true},       {"-texres", 1, false},  {"-type", 1, false}};
  for (;;) {
    rest = trimmed(rest);
    std::string_view behind = rest;
    const std::string word = to_lower(next_word(behind));
    const auto option = std::ranges::find_if(kOptions, [&](const Option& o) { return o.name == word; });
    if (option == std::end(kOptions)) return rest;
    rest = behind;
    for (int k = 0; k < option->arguments; ++k) {
      const std::string_view argument = next_word(behind);
      if (option->may_be_fewer && !to_number(argument)) break;
      rest = behind;
    }
  }
}

}  // namespace

MtlReader::Image MtlReader::image_of(std::string_view rest, const std::filesystem::path& folder) {
  const std::string_view named = image_name(rest);
  auto file = files_.file(folder, named);
  if (const std::size_t options = named.find(" -"); !file && options != named.npos)
    file = files_.file(folder, named.substr(0, options));  // they may follow as well
  if (file) return {short_name(*file), *file};
  const std::string_view name = unquoted(named);
  return {std::string(name.substr(name.find_last_of("/\\") + 1)), {}};
}

std::size_t MtlReader::texture(const Image& image) {
  const auto [at, is_new] = textures_.try_emplace({image.file, image.name}, model_.textures.size());
  if (is_new) model_.textures.push_back({image.name, image.file, {}});
  return at->second;
}

std::vector<ModelMaterial> MtlReader::read(const std::filesystem::path& file) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  const std::string name = short_name(file);
  std::vector<ModelMaterial> materials;
  std::vector<double> opacity, dissolve;  // of each material; dissolve -1: not given
  std::vector<ModelGloss> gloss;          // of each; one without an exponent is none
  std::vector<bool> has_highlight;        // illum 0 and 1 have none
  std::size_t line_number = 0;
  for (std::string_view lines = text_bytes(bytes, name); !lines.empty();) {
    std::string_view rest = trimmed(next_line(lines));
    const std::string where = text(name, ":", ++line_number, ": ");
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') continue;
    const std::string map = to_lower(key);
    const Image image = names_texture(map) ? image_of(rest, file.parent_path()) : Image{};
    if (!image.file.empty()) model_.files.push_back(image.file);
    if (key == "newmtl") {
      Material& material = materials.emplace_back().material;
      material.name = trimmed(rest);
      materials.back().described = false;  // until there is a colour
      gloss.emplace_back(), has_highlight.push_back(true);
      opacity.push_back(1);
      dissolve.push_back(-1);
      continue;
    }
    if (materials.empty()) {
      if (key == "Kd" || key == "Ke") throw InputError(text(where, key, " stands before the first newmtl"));
      continue;
    }
    ModelMaterial& current = materials.back();
    Material& material = current.material;
    if (key == "Ks") {
      gloss.back().of_all = colour_of_gloss(rest, where);
    } else if (key == "Ns" || key == "illum") {
      const auto value = to_number(next_word(rest));
      if (!value || !(*value >= 0)) continue;  // of no weight unless gloss is asked for
      if (key == "Ns")
        gloss.back().exponent = std::min(*value, kMostExponent);
      else
        has_highlight.back() = *value >= 2;
    } else if (key == "Kd" || key == "Ke") {
      const std::optional<Spectrum> colour = read_colour(rest, where);
      if (!colour) {
        current.described = current.described || key == "Kd";
        model_.warnings.push_back(text(where, "spectral and xyz colours are not read; '", material.name, "' keeps ",
                                       key == "Kd" ? "reflectance 0.5" : "no emission"));
      } else if (key == "Kd") {
        material.reflectance = *colour;
        current.described = true;
      } else {
        material.exitance = std::numbers::pi * *colour;
        current.unitless_glow = !material.exitance.is_black();
      }
    } else if (key == "d" || key == "Tr") {
      std::string_view word = next_word(rest);
      if (word == "-halo") word = next_word(rest);
      const std::optional<double> value = to_number(word);
      if (!value || !(*value >= 0 && *value <= 1)) {
        throw InputError(text(where, key, " = '", quotable(word), "' is outside [0, 1]"));
      }
      (key == "d" ? dissolve : opacity).back() = key == "d" ? *value : 1 - *value;
    } else if (map == "map_kd" || map == "map_ke") {
      (map == "map_kd" ? current.texture : current.glow_texture) = texture(image);
    }
  }
  // d wins: writers do not agree on whether Tr 1 is clear or solid.
  for (std::size_t m = 0; m < materials.size(); ++m) {
    apply_opacity(materials[m].material, dissolve[m] >= 0 ? dissolve[m] : opacity[m]);
    // Without a colour, or with black, as some write it there, the texture says all.
    ModelMaterial& material = materials[m];
    if (material.texture && (!material.described || material.material.reflectance.is_black()))
      material.material.reflectance = Spectrum(1.0);
    if (gloss[m].exponent && has_highlight[m]) material.gloss = gloss[m];
    material.described = material.described || material.texture || !material.material.receives();
  }
  return materials;
}

void apply_opacity(Material& material, double opacity) {
  if (!(opacity < 0.5)) return;
  material.kind = MaterialKind::glass;
  material.transmittance = Spectrum(1 - std::max(opacity, 0.0));
  material.exitance = Spectrum(0.0);
}

}  // namespace clerestory
