// Wavefront MTL: newmtl, Kd, Ke, d and Tr. Source: Ramey, Rose & Tyerman, "MTL material format", 1995.

#include <algorithm>
#include <numbers>

#include "io/formats/model.h"
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

}  // namespace

std::vector<ModelMaterial> read_mtl(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  const std::string name = short_name(file);
  std::vector<ModelMaterial> materials;
  std::vector<double> opacity, dissolve;  // of each material; dissolve -1: not given
  std::size_t line_number = 0;
  for (std::string_view lines = text_bytes(bytes, name); !lines.empty();) {
    std::string_view rest = trimmed(next_line(lines));
    const std::string where = text(name, ":", ++line_number, ": ");
    const std::string_view key = next_word(rest);
    if (key.empty() || key[0] == '#') continue;
    if (key == "newmtl") {
      Material& material = materials.emplace_back().material;
      material.name = trimmed(rest);
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
    if (key == "Kd" || key == "Ke") {
      const std::optional<Spectrum> colour = read_colour(rest, where);
      if (!colour) {
        warnings.push_back(text(where, "spectral and xyz colours are not read; '", material.name, "' keeps ",
                                key == "Kd" ? "reflectance 0.5" : "no emission"));
      } else if (key == "Kd") {
        material.reflectance = *colour;
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
    } else if (key == "map_Kd") {
      current.textured = true;
    }
  }
  // d wins: writers do not agree on whether Tr 1 is clear or solid.
  for (std::size_t m = 0; m < materials.size(); ++m) {
    apply_opacity(materials[m].material, dissolve[m] >= 0 ? dissolve[m] : opacity[m]);
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
