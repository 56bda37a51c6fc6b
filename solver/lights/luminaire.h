#pragma once
// What luminaires of any kind give at a point.
//
// A kind is a file here, NAME_luminaire.h, with four functions: intensity, power, bounds, turn_into_image; kinds whose
// light comes out of an opening have six more (web_luminaire.h). Data: solver/model/light_spec.h.

#include "solver/lights/light_tree.h"
#include "solver/lights/luminaire_opening.h"
#include "solver/model/light_spec.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Intensity [W/sr] towards the unit direction d.
Spectrum intensity(const Luminaire& luminaire, const Vec3& d);
/// Total flux [W].
Spectrum power(const Luminaire& luminaire);
/// For a tree of luminaires; LightBounds::power is an intensity.
LightBounds bounds(const Luminaire& luminaire);
/// The luminaire as the mirror shows it.
Luminaire image_of(Luminaire luminaire, const MirrorPlane& mirror);

/// Largest distance of a point that light comes from to the position [m].
double reach(const Luminaire& luminaire);
/// How many rays the opening is worth at p; 1: the luminaire is a point from there.
int opening_rays(const Luminaire& luminaire, const Vec3& p);
/// Place k of `count` on the opening for light_point(), and its weight; the weights sum to 1.
OpeningPlace opening_place(const Luminaire& luminaire, int k, int count);
/// Where light for p comes from: the position, or near by the point of the opening that u and v in [0, 1) choose.
Vec3 light_point(const Luminaire& luminaire, const Vec3& p, double u, double v);

/// Where that place ends as p sees it: `around` in [0, 1) goes once around its rim.
Vec3 rim_point(const Luminaire& luminaire, const Vec3& p, double around);

/// Irradiance [W/m2] at point p with unit normal n from the luminaire's point q, when nothing blocks: I cos / r2. The
/// mean over the points q of an opening is what it gives: each sends the luminaire's intensity, so the flux is the
/// luminaire's whatever the distance.
Spectrum open_irradiance(const Luminaire& luminaire, const Vec3& q, const Vec3& p, const Vec3& n);
/// The same from the position.
Spectrum open_irradiance(const Luminaire& luminaire, const Vec3& p, const Vec3& n);

}  // namespace clerestory
