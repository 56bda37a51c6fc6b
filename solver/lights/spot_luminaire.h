#pragma once
// Luminaires with a cone of light, as glTF has them.

#include "solver/lights/light_tree.h"
#include "solver/model/light_spec.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Intensity [W/sr] towards the unit direction d: full inside the inner cone, none outside the outer one, between them
/// as glTF KHR_lights_punctual says: the square of a ramp in the cosine.
Spectrum intensity(const SpotLuminaire& luminaire, const Vec3& d);
/// Total flux [W].
Spectrum power(const SpotLuminaire& luminaire);
LightBounds bounds(const SpotLuminaire& luminaire, const Vec3& position);
void turn_into_image(SpotLuminaire& luminaire, const MirrorPlane& mirror);

}  // namespace clerestory
