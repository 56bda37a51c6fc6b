#pragma once
// Light that does not come from surfaces of the model.

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/photometric_web.h"
#include "solver/model/sky_image.h"
#include "solver/model/sky_shape.h"
#include "solver/model/vec.h"

namespace clerestory {

// Kinds of luminaires: their data. What each gives, and in which directions, is in a file of its own in solver/lights/.
// colour() is what all of a luminaire's light is in proportion to.

/// Equal intensity in all directions.
struct PointLuminaire {
  Spectrum power;  ///< total flux [W]

  Spectrum& colour() { return power; }
  const Spectrum& colour() const { return power; }
};

/// glTF KHR_lights_punctual spot: intensity falls smoothly from the inner to the outer half-angle.
struct SpotLuminaire {
  Vec3 direction;                           ///< unit, away from the lamp
  Spectrum intensity;                       ///< on the axis [W/sr]
  double inner_angle = 0, outer_angle = 0;  ///< half-angles [rad]

  Spectrum& colour() { return intensity; }
  const Spectrum& colour() const { return intensity; }
};

/// Luminaire of a photometric file. Nearer than ten times its opening's largest length its light comes from the whole
/// opening, farther away from the centre.
struct WebLuminaire {
  std::shared_ptr<const PhotometricWeb> web;  ///< many luminaires share one
  LuminaireAxes axes;
  Spectrum scale;  ///< radiant intensity for each candela of the web, dimming included [W/sr / cd]

  Spectrum& colour() { return scale; }
  const Spectrum& colour() const { return scale; }
};

/// In the order of Luminaire::kind; file: of a photometric file.
inline constexpr std::string_view kLuminaireKindNames[] = {"point", "spot", "file"};

struct Luminaire {
  std::string name;
  Vec3 position;      ///< of a photometric file's centre [m]
  std::string group;  ///< luminaires that are switched and dimmed together; may be empty
  std::variant<PointLuminaire, SpotLuminaire, WebLuminaire> kind;
};

enum class SkyModel { uniform, cie_overcast, cie_clear, cie_general, perez, image, mean };

/// Sky of luminance distribution `model`, scaled to a horizontal irradiance; virtual ground below the horizon.
struct Sky {
  SkyModel model = SkyModel::cie_overcast;
  Spectrum horizontal_irradiance;           ///< of the sky alone, on an open horizontal plane [W/m2]
  double ground_reflectance = 0.2;          ///< of the virtual ground below the horizon [1]
  SkyShape shape{};                         ///< of cie_clear, cie_general and perez
  Vec3 sun{0, 0, 1};                        ///< unit, to the sun that the shape is bright around
  std::shared_ptr<const SkyImage> image{};  ///< of model image, in the radiance that it shows
  bool image_has_ground = false;            ///< the lower half of the image takes the place of the virtual ground
  std::vector<Sky> parts{};                 ///< of model mean: each counts the same, dark ones too
};

/// Sun: a disc of 0.533 degrees of uniform radiance.
struct Sun {
  Vec3 direction;                     ///< unit, to the sun
  Spectrum normal_irradiance;         ///< on a plane that faces the sun [W/m2]
  std::optional<std::size_t> time{};  ///< of LightSpec::times, that it shines at; none: at all of them
};

/// Light as a scene has it: what is computed of it is in solver/lights/lights.h.
struct LightSpec {
  std::vector<Luminaire> luminaires;
  std::optional<Sky> sky;
  std::vector<Sun> suns;  ///< the scene's sun, and directional lights of a glTF file
  std::size_t times = 1;  ///< that this is the mean of, see light_of_times.h

  bool empty() const { return luminaires.empty() && !sky && suns.empty(); }
};

}  // namespace clerestory
