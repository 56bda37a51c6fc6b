#pragma once
// Luminaires of equal intensity in all directions.

#include "solver/lights/light_tree.h"
#include "solver/model/light_spec.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Intensity [W/sr] towards the unit direction d.
Spectrum intensity(const PointLuminaire& luminaire, const Vec3& d);
/// Total flux [W].
Spectrum power(const PointLuminaire& luminaire);
LightBounds bounds(const PointLuminaire& luminaire, const Vec3& position);
/// A mirror shows it as it is.
inline void turn_into_image(PointLuminaire&, const MirrorPlane&) {}

}  // namespace clerestory
