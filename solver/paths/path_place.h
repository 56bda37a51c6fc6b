#pragma once
// Where a path touches a surface, and how it goes on from there: diffusely, on either side of a diffuser, or by a lobe.

#include <array>
#include <optional>

#include "solver/illumination/illumination.h"
#include "solver/model/random_stream.h"

namespace clerestory {

/// A place of a path from the receiver, or of one from a light. Directions are unit and away from the surface.
struct PathPlace {
  Vec3 x, n;                   ///< off the surface, on the side that the path goes on from; normal of that side
  Vec3 back;                   ///< to where the path came from
  Spectrum diffuse{1.0};       ///< share that goes on diffusely, over the chance of the side [1]
  const Lobe* lobe = nullptr;  ///< null: there is none
  double by_lobe = 0;          ///< chance to go on by it
  double diffusely_back = 0;   ///< density of `back` among diffuse ways, for who comes the other way [1/sr]

  /// pi f: irradiance that comes along one of the directions d and `back` becomes radiosity, as if all around were as
  /// bright as the other is [1].
  Spectrum reflects(const Vec3& d) const;
  /// No more than this goes on [1].
  Spectrum albedo() const { return lobe ? diffuse + lobe->specular() : diffuse; }
  /// Of going on along d, `diffusely` being that among diffuse ways [1/sr].
  double density(const Vec3& d, double diffusely) const {
    return lobe ? (1 - by_lobe) * diffusely + by_lobe * lobe->density(n, back, d) : diffusely;
  }
  /// Of going on along `back` for who comes the other way, from d [1/sr].
  double density_back(const Vec3& d) const {
    return lobe ? (1 - by_lobe) * diffusely_back + by_lobe * lobe->density(n, d, back) : diffusely_back;
  }
};

/// The side of a surface that a ray came to.
struct PathArrival {
  Vec3 on;        ///< the place, in the very plane of the patch
  Vec3 x, n;      ///< off the surface; normal
  Vec3 back;      ///< to where the ray came from
  double cosine;  ///< of that to n, > 0
};
/// Needs: hit.patch is valid.
PathArrival arrival_of(const Problem& problem, const Hit& hit, const Ray& ray);

/// How a path goes on from there; diffusely_back is the caller's.
PathPlace place_of(const Problem& problem, const Hit& hit, const PathArrival& at, RandomStream& random);

/// One way on, as WayOn.
struct PathWay {
  Vec3 direction;
  double density = 0;   ///< [1/sr]
  Spectrum factor;      ///< pi f cos / (pi density): what becomes of the path's share; black: nowhere
  double by_slits = 1;  ///< what of that the choice of a slit left
};
/// From the receiver: among its diffuse ways some go through slits.
PathWay way_from_eye(const Illumination& light, const PathPlace& at, const std::array<double, 2>& square,
                     RandomStream& random);
/// Of a particle.
PathWay way_from_light(const PathPlace& at, RandomStream& random);

}  // namespace clerestory
