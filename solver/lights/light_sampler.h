#pragma once
// All lights that are worth a shadow ray, chosen in proportion to their flux.

#include <vector>

#include "solver/lights/sky.h"
#include "solver/problem.h"

namespace clerestory {

/// A patch is sampled like a light when it is brighter than kBrighter times the median over the area of all surfaces;
/// dimmer ones are found well enough by the bundle that looks for reflected light. The median and not the mean: a
/// facade in the sun must not hide the sun's patch in the room behind it.
inline constexpr double kBrighter = 4;

/// One point of a light, as seen from where its light is asked for.
struct LightSample {
  Vec3 end;             ///< where the shadow ray goes to, lifted [m]
  Spectrum irradiance;  ///< at the receiver when nothing blocks, divided by the density of the choice
  double density = 0;   ///< of choosing this direction, per solid angle; 0 for lights that a bundle cannot hit
  PatchId patch;        ///< the bright patch it lies on; invalid for other lights
};

class LightSampler {
 public:
  /// glow  N x channels, what the patches send out of themselves: M for paths, which find reflected light on their way;
  ///       B for a gather, where the sun's patch on the floor is as much of a lamp as the lamp. Outlives the sampler.
  LightSampler(const Problem& problem, const Field& glow);

  bool empty() const { return lights_.empty(); }
  bool has_emitters() const { return has_emitters_; }
  const Field& glow() const { return glow_; }
  bool is_explicit(PatchId p) const { return has_emitters_ && explicit_[p]; }

  /// Light `pick` in [0, 1) chosen by flux, and the point (u, v) of it, for receiver point p with normal n.
  /// Glowing patches only when `emitters_only`.
  LightSample sample(const Vec3& p, const Vec3& n, double pick, double u, double v, bool emitters_only) const;

  /// Density per solid angle with which sample() would choose, at p with normal n, the direction that ends on the
  /// explicit patch q at `distance`, `cos_q` being the cosine there.
  double density(PatchId q, const Vec3& p, const Vec3& n, double distance, double cos_q, bool emitters_only) const;

  /// Irradiance at p of luminaires without extent and of the sun: a shadow ray to each lamp, sun_rays to each sun.
  Spectrum small_lights(const Vec3& p, const Vec3& n, int sun_rays, std::uint64_t key) const;

 private:
  enum class Kind : std::uint8_t { patch, point, spot, sun };
  struct Light {
    Kind kind;
    std::uint32_t index;
    double cumulative, cumulative_emitters;  ///< flux of the lights up to and with this one, normalised to 1
    double share, share_emitters;            ///< probability of the choice
  };
  const Problem& problem_;
  const Field& glow_;
  std::vector<Light> lights_;
  std::vector<double> share_of_patch_;  ///< N, in proportion of all lights; empty without emitters
  std::vector<bool> explicit_;
  double emitters_share_ = 0;
  bool has_emitters_ = false;
};

}  // namespace clerestory
