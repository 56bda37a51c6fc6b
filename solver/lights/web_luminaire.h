#pragma once
// Luminaires with a photometric web: intensity by direction, light from an opening.

#include "solver/model/light_spec.h"

namespace clerestory {

/// Intensity [W/sr] of the whole luminaire towards the unit direction d, linear between the angles of its web.
Spectrum intensity(const WebLuminaire& lamp, const Vec3& d);

/// Total flux [W].
Spectrum power(const WebLuminaire& lamp);

/// Largest distance of a point of the opening from the centre [m].
double reach(const WebLuminaire& lamp);

/// How many rays the opening is worth at p: 1 where p is farther away than ten times its largest length, 4 up to five
/// times, else 16, and up to 256 where p is nearer than that length.
int opening_rays(const WebLuminaire& lamp, const Vec3& p);

/// Place k of `count` on the opening for light_point(), and its weight; the weights sum to 1. Gauss points: what varies
/// smoothly over the opening is integrated to a fraction of what as many random points would miss.
struct OpeningPlace {
  double u = 0.5, v = 0.5, weight = 1;
};
OpeningPlace opening_place(const WebLuminaire& lamp, int k, int count);

/// Where light for p comes from: the centre, or near by the point of the opening that u and v choose, in [0, 1), even
/// over the two larger of its three lengths.
Vec3 light_point(const WebLuminaire& lamp, const Vec3& p, double u, double v);

/// Irradiance [W/m2] at p on a plane of unit normal n when all light comes from q, I cos / r2, and nothing blocks. The
/// mean over the points q of an opening is what it gives: each point sends the web's intensity, so the flux is the
/// web's whatever the distance. r counts as no less than the radius of a disc of 1/256 of the opening: no p is dazzled
/// by one.
Spectrum open_irradiance(const WebLuminaire& lamp, const Vec3& q, const Vec3& p, const Vec3& n);

/// Half-angle of the cone around the beam axis that holds all light [rad].
double beam_half_angle(const PhotometricWeb& web);

}  // namespace clerestory
