#pragma once
// The scene's light -> lights among the patches.

#include "solver/lights/lights.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// The lights as a solve wants them: in the local frame of the patches, with images in mirrors, and with the openings
/// through which the sky looks in.
///
/// Images stand behind mirrors and panes, see find_images.h.
Lights place_lights(const LightSpec& spec, const PatchSet& patches, const RayScene& rays);

/// The same for shadow rays: without openings.
Lights place_lights_for_shadows(const LightSpec& spec, const PatchSet& patches, const RayScene& rays);

/// The first of that alone: no images, no openings.
Lights to_local_frame(const LightSpec& spec, const Vec3& origin);

}  // namespace clerestory
