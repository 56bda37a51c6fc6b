#pragma once
// Images of luminaires and suns behind mirrors and panes of glass.

#include "solver/lights/lights.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Adds the images that are worth it: light that a pane or a mirror turns meets a surface as if it came from there, and
/// after several of them as if it came from the image of an image.
///
/// Rays of the lights tell which ways their light takes over mirrors and panes, and how much takes each. Planes count
/// that have a number (RayScene::mirrors). A way over one mirror is worth an image, one over a pane if it turns 2e-4 of
/// the light's flux (of the sun: of what all planes turn of it), one over several, up to 15, if it turns 1e-3. A light
/// has no more than the 64 images that turn most, and those in mirrors that no ray met; all luminaires together have
/// 4096, or twice their number. What is left is noted in Lights::lost_in_mirrors.
///
/// lights  the scene's, local frame; with near planes.
/// Threads: same result for any thread count. Cost: 2^14 rays a light, of many 256; nothing without mirrors and glass.
void add_images(Lights& lights, const PatchSet& patches, const RayScene& rays);

}  // namespace clerestory
