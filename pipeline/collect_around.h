#pragma once
// Scene and its solution -> what a result holds beside the light on surfaces.

#include <optional>
#include <vector>

#include "pipeline/solved.h"
#include "solver/model/scene.h"
#include "solver/model/scene_around.h"

namespace clerestory {

/// Illuminance on open ground [lx] that daylight factors are shares of; empty without a sky and where the sun shines.
std::optional<double> daylight_reference(const LightSpec& lights);

/// Triangles of glass and of mirrors, before patches are parted.
std::vector<PaneTriangle> panes_of(const PatchSet& patches);

/// The layers that were solved, with what they have of the sky; none where there was no time for them.
std::vector<ShownLayer> shown_layers(const Solved& solved);

SceneAround collect_around(const Scene& scene, const Solved& solved);

}  // namespace clerestory
