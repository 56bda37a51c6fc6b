#pragma once
// How a surface takes, reflects, passes and emits light.

#include <optional>
#include <string>
#include <string_view>

#include "solver/model/channels.h"
#include "solver/model/gloss.h"

namespace clerestory {

/// diffuse: reflects only. glass: passes light straight on and reflects some as a plane mirror does. diffuser:
/// reflects, and passes light scattered to its other side, the same from both. mirror: sends light on as a plane mirror
/// does, from both sides. glossy: reflects diffusely, and some more around the mirror's direction.
enum class MaterialKind { diffuse, glass, diffuser, mirror, glossy };
/// In the order of the enumerators.
inline constexpr std::string_view kMaterialKindNames[] = {"diffuse", "glass", "diffuser", "mirror", "glossy"};

/// Blinds of a pane, that are closed where the sun dazzles.
struct Blinds {
  Spectrum transmittance{0.0};  ///< of the pane and the closed blinds, at normal incidence
  std::string group;            ///< windows whose blinds close together

  friend bool operator==(const Blinds&, const Blinds&) = default;
};

struct Material {
  std::string name;
  MaterialKind kind = MaterialKind::diffuse;
  Spectrum reflectance{0.5};            ///< but of glass, each in [0, 1); with what a diffuser passes, or the lobe of a
                                        ///< glossy surface reflects, below 1
  Spectrum transmittance{0.0};          ///< of glass at normal incidence, each in [0, 1]; of a diffuser
  Spectrum exitance{0.0};               ///< M of each side [W/m2]
  std::optional<Spectrum> total_power;  ///< [W] shared over the sides that carry the material; replaces exitance
  std::optional<Blinds> blinds{};       ///< of glass
  std::optional<Gloss> gloss{};         ///< of what is glossy, beside its diffuse reflectance
  int sides = 2;                        ///< 1: the back (wound clockwise) is black and does not emit
  std::string group{};                  ///< of what glows: switched and dimmed together; may be empty

  friend bool operator==(const Material&, const Material&) = default;

  // What a surface of this material does with light. Transport asks these, never the kind: a new kind answers them
  // here, and says in PatchSet::scattered() and PatchSet::scatter() what becomes of light that falls on it.

  /// Reflects some around the mirror's direction; needs: gloss.
  bool is_glossy() const { return kind == MaterialKind::glossy; }
  /// Its sides take light, and are patches; else rays go on from it.
  bool receives() const { return !lets_rays_pass() && !turns_rays(); }
  /// Rays go straight on, with the share that a sheet of `transmittance` passes at their angle; another is turned back.
  bool lets_rays_pass() const { return kind == MaterialKind::glass; }
  /// Rays are turned as by a plane mirror, with the share `reflectance`.
  bool turns_rays() const { return kind == MaterialKind::mirror; }
  /// Of what it receives, the share `transmittance` leaves its other side, scattered.
  bool scatters_through() const { return kind == MaterialKind::diffuser; }
  /// A sheet that is the same from both sides and is cut out of what lies in its plane.
  bool is_sheet() const { return !receives() || scatters_through(); }
  bool emits() const { return total_power ? !total_power->is_black() : !exitance.is_black(); }
};

}  // namespace clerestory
