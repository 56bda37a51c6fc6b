#pragma once
// Light that does not come from surfaces of the model.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/photometric_web.h"
#include "solver/model/sky_image.h"
#include "solver/model/sky_shape.h"
#include "solver/model/vec.h"

namespace clerestory {

inline constexpr std::uint32_t kNoMirror = 0xffffffff;

/// Point source of equal intensity in all directions.
struct PointLuminaire {
  std::string name;
  Vec3 position;                     ///< [m]
  Spectrum power;                    ///< total flux [W]
  std::string group{};               ///< luminaires that are switched and dimmed together; may be empty
  std::uint32_t mirror = kNoMirror;  ///< of an image: the mirror (RayScene::mirrors) that shows it
};

/// glTF KHR_lights_punctual spot: intensity falls smoothly from the inner to the outer half-angle.
struct SpotLuminaire {
  std::string name;
  Vec3 position;                            ///< [m]
  Vec3 direction;                           ///< unit, away from the lamp
  Spectrum intensity;                       ///< on the axis [W/sr]
  double inner_angle = 0, outer_angle = 0;  ///< half-angles [rad]
  std::uint32_t mirror = kNoMirror;         ///< as of PointLuminaire
};

/// Luminaire of a photometric file. Nearer than ten times its opening's largest length its light comes from the whole
/// opening, farther away from the centre.
struct WebLuminaire {
  std::string name;
  std::shared_ptr<const PhotometricWeb> web;  ///< many luminaires share one
  Vec3 position;                              ///< of the photometric centre [m]
  LuminaireAxes axes;
  Spectrum scale;                    ///< radiant intensity for each candela of the web, dimming included [W/sr / cd]
  std::string group{};               ///< as of PointLuminaire
  std::uint32_t mirror = kNoMirror;  ///< as of PointLuminaire
};

enum class SkyModel { uniform, cie_overcast, cie_clear, cie_general, perez, image };

/// Sky of luminance distribution `model`, scaled to a horizontal irradiance; virtual ground below the horizon.
struct Sky {
  SkyModel model = SkyModel::cie_overcast;
  Spectrum horizontal_irradiance;           ///< of the sky alone, on an open horizontal plane [W/m2]
  double ground_reflectance = 0.2;          ///< of the virtual ground below the horizon [1]
  SkyShape shape{};                         ///< of cie_clear, cie_general and perez
  Vec3 sun{0, 0, 1};                        ///< unit, to the sun that the shape is bright around
  std::shared_ptr<const SkyImage> image{};  ///< of model image, in the radiance that it shows
  bool image_has_ground = false;            ///< the lower half of the image takes the place of the virtual ground
};

/// Sun: a disc of 0.533 degrees of uniform radiance.
struct Sun {
  Vec3 direction;                    ///< unit, to the sun
  Spectrum normal_irradiance;        ///< on a plane that faces the sun [W/m2]
  std::uint32_t mirror = kNoMirror;  ///< as of PointLuminaire
};

/// A plane polygon that light comes out of on one side: a gap between surfaces through which the sky looks into a room,
/// or bright patches that lie together. Only a hint where to look: what it misses is found as well.
struct LightArea {
  std::vector<Vec3> corners;                   ///< counter-clockwise around the normal, local frame [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< that cover it, wound alike [m]
  Vec3 centre, normal;                         ///< normal: unit, to where the light goes
  double radius = 0, area = 0;                 ///< radius: farthest point from the centre [m], area [m2]
  double brightness = 0;                       ///< mean radiance that comes out of it [W/(m2 sr)]
};

struct Lights {
  std::vector<PointLuminaire> points;
  std::vector<SpotLuminaire> spots;
  std::vector<WebLuminaire> webs;
  std::optional<Sky> sky;
  std::vector<Sun> suns;            ///< the scene's sun, and directional lights of a glTF file
  std::vector<LightArea> openings;  ///< found by find_openings(); sky without any is right as well, only noisier

  std::size_t lamp_count() const { return points.size() + spots.size() + webs.size(); }
  bool empty() const { return lamp_count() == 0 && !sky && suns.empty(); }
};

/// Calls visit(lamp, number) for the luminaires of all kinds, which number them through: points, spots, webs.
template <class AnyLights, class Visit>
void for_each_lamp(AnyLights& lights, const Visit& visit) {
  std::size_t number = 0;
  for (auto& lamp : lights.points) visit(lamp, number++);
  for (auto& lamp : lights.spots) visit(lamp, number++);
  for (auto& lamp : lights.webs) visit(lamp, number++);
}

/// visit(lamp) for the luminaire of that number.
template <class Visit>
auto with_lamp(const Lights& lights, std::size_t number, const Visit& visit) {
  if (number < lights.points.size()) return visit(lights.points[number]);
  number -= lights.points.size();
  if (number < lights.spots.size()) return visit(lights.spots[number]);
  return visit(lights.webs[number - lights.spots.size()]);
}

}  // namespace clerestory
