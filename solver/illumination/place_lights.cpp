#include "solver/illumination/place_lights.h"

#include <utility>

#include "solver/illumination/near_luminaires.h"
#include "solver/lights/luminaire.h"
#include "solver/openings/openings.h"

namespace clerestory {
namespace {

void add_images(Lights& lights, const std::vector<MirrorPlane>& mirrors) {
  const std::size_t luminaires = lights.luminaires.size(), suns = lights.suns.size();
  for (std::uint32_t m = 0; m < mirrors.size(); ++m) {
    for (std::size_t k = 0; k < luminaires; ++k) {
      PlacedLuminaire image{image_of(lights.luminaires[k], mirrors[m]), m, lights.luminaires[k].near_planes};
      for (NearPlane& plane : image.near_planes) {
        const Vec3 in_plane = mirrors[m].image_of(plane.normal * plane.offset);
        plane.normal = mirrors[m].image_of_direction(plane.normal);
        plane.offset = dot(plane.normal, in_plane);
      }
      lights.luminaires.push_back(std::move(image));
    }
    for (std::size_t k = 0; k < suns; ++k) {
      const PlacedSun& sun = lights.suns[k];
      lights.suns.push_back({{mirrors[m].image_of_direction(sun.direction), sun.normal_irradiance}, m});
    }
  }
}

}  // namespace

Lights to_local_frame(const LightSpec& spec, const Vec3& origin) {
  Lights lights;
  lights.sky = spec.sky;
  for (Luminaire luminaire : spec.luminaires) {
    luminaire.position -= origin;
    lights.luminaires.push_back({std::move(luminaire)});
  }
  for (const Sun& sun : spec.suns) lights.suns.push_back({sun});
  return lights;
}

Lights place_lights(const LightSpec& spec, const PatchSet& patches, const RayScene& rays) {
  Lights lights = to_local_frame(spec, patches.origin);
  find_near_planes(lights, patches, rays);
  add_images(lights, rays.mirrors());
  lights.openings = find_openings(patches, rays, lights);
  return lights;
}

}  // namespace clerestory
