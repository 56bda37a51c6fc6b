#include "solver/illumination/problem.h"

#include "solver/openings/openings.h"

namespace clerestory {

Lights local_lights(const Lights& lights, const PatchSet& patches, const RayScene& rays) {
  Lights local = with_mirror_images(to_local_frame(lights, patches.origin), rays);
  local.openings = find_openings(patches, rays, local);
  return local;
}

Lights to_local_frame(const Lights& lights, const Vec3& origin) {
  Lights local = lights;
  for_each_lamp(local, [&](auto& lamp, std::size_t) { lamp.position -= origin; });
  return local;
}

namespace {

void reflect(PointLuminaire&, const MirrorPlane&) {}
void reflect(SpotLuminaire& lamp, const MirrorPlane& plane) {
  lamp.direction = plane.image_of_direction(lamp.direction);
}
void reflect(WebLuminaire& lamp, const MirrorPlane& plane) {
  for (Vec3* axis : {&lamp.axes.x, &lamp.axes.y, &lamp.axes.z}) *axis = plane.image_of_direction(*axis);
}

template <class Lamp>
void add_images(std::vector<Lamp>& lamps, const std::vector<MirrorPlane>& mirrors) {
  const std::size_t count = lamps.size();
  for (std::uint32_t m = 0; m < mirrors.size(); ++m)
    for (std::size_t k = 0; k < count; ++k) {
      Lamp image = lamps[k];
      image.position = mirrors[m].image_of(image.position);
      reflect(image, mirrors[m]);
      image.mirror = m;
      lamps.push_back(std::move(image));
    }
}

}  // namespace

Lights with_mirror_images(Lights local, const RayScene& rays) {
  const std::vector<MirrorPlane>& mirrors = rays.mirrors();
  add_images(local.points, mirrors);
  add_images(local.spots, mirrors);
  add_images(local.webs, mirrors);
  const std::size_t count = local.suns.size();
  for (std::uint32_t m = 0; m < mirrors.size(); ++m)
    for (std::size_t k = 0; k < count; ++k) {
      Sun image = local.suns[k];
      image.direction = mirrors[m].image_of_direction(image.direction);
      image.mirror = m;
      local.suns.push_back(image);
    }
  return local;
}

}  // namespace clerestory
