#include "solver/illumination/place_lights.h"

#include <utility>

#include "solver/illumination/find_images.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/openings/openings.h"

namespace clerestory {
Lights to_local_frame(const LightSpec& spec, const Vec3& origin) {
  Lights lights;
  lights.sky = spec.sky;
  lights.times = spec.times;
  for (Luminaire luminaire : spec.luminaires) {
    luminaire.position -= origin;
    lights.luminaires.push_back({std::move(luminaire)});
  }
  for (const Sun& sun : spec.suns) lights.suns.push_back({sun});
  return lights;
}

Lights place_lights_for_shadows(const LightSpec& spec, const PatchSet& patches, const RayScene& rays) {
  Lights lights = to_local_frame(spec, patches.origin);
  find_near_planes(lights, patches, rays);
  add_images(lights, patches, rays);
  return lights;
}

Lights place_lights(const LightSpec& spec, const PatchSet& patches, const RayScene& rays) {
  Lights lights = place_lights_for_shadows(spec, patches, rays);
  lights.openings = find_openings(patches, rays, lights);
  return lights;
}

}  // namespace clerestory
