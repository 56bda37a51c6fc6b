#pragma once
// Luminaires with a photometric web: intensity by direction, light from an opening.

#include "solver/lights/light_tree.h"
#include "solver/lights/luminaire_opening.h"
#include "solver/model/light_spec.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Intensity [W/sr] of the whole luminaire towards the unit direction d, linear between the angles of its web.
Spectrum intensity(const WebLuminaire& luminaire, const Vec3& d);

/// Total flux [W].
Spectrum power(const WebLuminaire& luminaire);
LightBounds bounds(const WebLuminaire& luminaire, const Vec3& position);
void turn_into_image(WebLuminaire& luminaire, const MirrorPlane& mirror);

/// Largest distance of a point of the opening from the centre [m].
double reach(const WebLuminaire& luminaire);

/// How many rays the opening is worth at p: 1 from ten times its largest length on, 4 from five times on, nearer 16; 64
/// within one length of the opening, 256 within half of one.
int opening_rays(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p);

/// Place k of `count` on the opening for light_point(), and its weight; the weights sum to 1. Gauss points: what varies
/// smoothly over the opening is integrated to a fraction of what as many random points would miss.
OpeningPlace opening_place(const WebLuminaire& luminaire, int k, int count);

/// Where light for p comes from: the centre, or near by the point of the opening that u and v choose, in [0, 1), even
/// over the two larger of its three lengths.
Vec3 light_point(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p, double u, double v);

/// Where the opening ends as p sees it: `around` in [0, 1) goes once around. The centre where light_point() is that.
Vec3 rim_point(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p, double around);

/// r counts as no less than the radius of a disc of 1/256 of the opening: no point is dazzled by one [m2].
double least_r2(const WebLuminaire& luminaire);

/// Half-angle of the cone around the beam axis that holds all light [rad].
double beam_half_angle(const PhotometricWeb& web);

}  // namespace clerestory
