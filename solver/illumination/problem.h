#pragma once
// What every method works on.

#include "solver/model/light_spec.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// References only: patches, rays and lights outlive it. Light positions are in the patches' local frame.
struct Problem {
  const PatchSet& patches;
  const RayScene& rays;
  const Lights& lights;
};

/// The lights as all that follows wants them: in the local frame of the patches, with an image behind each mirror, and
/// with the openings through which the sky looks in.
Lights local_lights(const Lights& lights, const PatchSet& patches, const RayScene& rays);

/// Lights moved into the local frame of the patches.
Lights to_local_frame(const Lights& lights, const Vec3& origin);

/// The same with an image of each luminaire and sun behind each plane of mirrors, for light that takes one mirror on
/// its way; more than one, and curved mirrors finer than 64 planes, are not found from lamps and suns.
///
/// local  in the patches' frame. Nothing is added without mirrors.
Lights with_mirror_images(Lights local, const RayScene& rays);

}  // namespace clerestory
