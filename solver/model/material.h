#pragma once
// How a surface takes, reflects, passes and emits light.

#include <optional>
#include <string>

#include "solver/model/channels.h"

namespace clerestory {

/// diffuse: reflects only. glass: passes light straight on, reflects nothing that is followed. diffuser: reflects, and
/// passes light scattered to its other side, the same from both. mirror: sends light on as a plane mirror does, from
/// both sides.
enum class MaterialKind { diffuse, glass, diffuser, mirror };

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  Spectrum reflectance{0.5};            ///< but of glass, each in [0, 1); with what a diffuser passes below 1
  Spectrum transmittance{0.0};          ///< of glass at normal incidence, each in [0, 1]; of a diffuser
  Spectrum exitance{0.0};               ///< M of each side [W/m2]
  std::optional<Spectrum> total_power;  ///< [W] shared over the sides that carry the material; replaces exitance
  int sides = 2;                        ///< 1: the back (wound clockwise) is black and does not emit

  friend bool operator==(const Material&, const Material&) = default;
  /// A sheet that is the same from both sides and is cut out of what lies in its plane.
  bool is_sheet() const { return kind != MaterialKind::diffuse; }
  bool emits() const { return total_power ? !total_power->is_black() : !exitance.is_black(); }
};

}  // namespace clerestory
