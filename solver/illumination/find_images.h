#pragma once
// Images of luminaires and suns behind mirrors and panes of glass.

#include "solver/lights/lights.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Adds the images that are worth it: light that a pane or a mirror turns meets a surface as if it came from there, and
/// after several of them as if it came from the image of an image.
///
/// Rays of the lights tell which ways their light takes over mirrors and panes, and how much takes each. Every plane of
/// mirrors has an image of every light; other ways have one if they are taken by a share of the light that is not
/// negligible, up to 15 planes one after another. What is left is noted in Lights::lost_in_mirrors.
///
/// lights  the scene's, local frame; with near planes.
/// Threads: same result for any thread count. Cost: 2^14 rays a light, of many 256; nothing without mirrors and glass.
void add_images(Lights& lights, const PatchSet& patches, const RayScene& rays);

}  // namespace clerestory
