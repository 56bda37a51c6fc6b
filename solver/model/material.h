#pragma once
// How a surface takes, reflects, passes and emits light.

#include <optional>
#include <string>

#include "solver/model/channels.h"

namespace clerestory {

enum class MaterialKind { diffuse, glass };

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  Spectrum reflectance{0.5};            ///< diffuse, each in [0, 1)
  Spectrum transmittance{0.0};          ///< glass: share of the light that passes the sheet straight on, each in [0, 1]
  Spectrum exitance{0.0};               ///< M of each side [W/m2]
  std::optional<Spectrum> total_power;  ///< [W] shared over the sides that carry the material; replaces exitance
  int sides = 2;                        ///< 1: the back (wound clockwise) is black and does not emit

  friend bool operator==(const Material&, const Material&) = default;
  bool emits() const { return total_power ? !total_power->is_black() : !exitance.is_black(); }
};

}  // namespace clerestory
