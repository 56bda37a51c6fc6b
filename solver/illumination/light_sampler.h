#pragma once
// All lights that are worth a shadow ray, chosen by what they can give where they are asked for.

#include <vector>

#include "solver/illumination/gloss_light.h"
#include "solver/illumination/light_rows.h"
#include "solver/illumination/problem.h"
#include "solver/lights/light_tree.h"
#include "solver/lights/sky.h"

namespace clerestory {

/// A patch is sampled like a light when it is brighter than kBrighter times the median over the area of all surfaces;
/// dimmer ones are found well enough by the bundle that looks for reflected light. The median and not the mean: a
/// facade in the sun must not hide the sun's patch in the room behind it.
inline constexpr double kBrighter = 4;

/// Half of the area of all patches has no more of x (N x channels, >= 0) than this: luminous mean, to the precision of
/// float. counts: N, which of them; empty: all.
double area_median(const PatchSet& patches, const Field& x, const std::vector<bool>& counts = {});

/// One point of a light, as seen from where its light is asked for.
struct LightSample {
  Vec3 end;             ///< where the shadow ray goes to, lifted [m]
  Spectrum irradiance;  ///< at the receiver when nothing blocks, divided by the density of the choice
  double density = 0;   ///< of choosing this direction, per solid angle; 0 for lights that a bundle cannot hit
  PatchId patch;        ///< the bright patch it lies on; invalid for other lights
  MirrorWay way;        ///< of an image
  double weight = 0;    ///< of a bright patch: irradiance = glow * weight [1]
  std::uint32_t light = LightTree::kNone;  ///< number of a luminaire or sun, as in Layer::lights; kNone: a bright patch
  double probability = 0;                  ///< with which that was chosen [1]
};

struct DeltaEffort {
  int sun_rays = 1;        ///< to each sun
  int opening_rays = 256;  ///< to each luminaire, at most; 1, 4, 16, 64 or 256
  int gloss_rays = 16;     ///< pairs, for what glossy surfaces send on
};

class LightSampler {
 public:
  /// glow  N x channels, what the patches send out of themselves: M for paths, which find reflected light on their way;
  ///       B for a gather, where the sun's patch on the floor is a light like any glowing panel. Outlives the sampler.
  LightSampler(const Problem& problem, const Field& glow);

  bool empty() const { return bright_.empty() && luminaires_.empty() && suns_power_ == 0; }
  bool has_bright_patches() const { return !bright_.empty(); }
  const Field& glow() const { return glow_; }
  bool is_bright(PatchId p) const { return has_bright_patches() && number_of_patch_[p] != LightTree::kNone; }

  /// A receiver point p with normal n, for all that is asked there.
  LightTree::Receiver receiver(const Vec3& p, const Vec3& n) const { return {patches_, p, n}; }

  /// Light chosen by `pick` in [0, 1), and the point (u, v) of it. Bright patches only when `bright_patches_only`;
  /// otherwise patches, luminaires and suns share the choice by their power first.
  LightSample sample(const LightTree::Receiver& at, double pick, double u, double v, bool bright_patches_only) const;

  /// Density per solid angle with which sample() would choose the direction that ends on the bright patch q at
  /// `distance`, `cos_q` being the cosine there.
  double density(PatchId q, const LightTree::Receiver& at, double distance, double cos_q,
                 bool bright_patches_only) const;

  /// The same where a ray from there along d (unit) ends; 0 when that is no bright patch that shadow rays look for.
  double density(const Hit& hit, const LightTree::Receiver& at, const Vec3& d, bool bright_patches_only) const;
  double density(const Hit& hit, const Vec3& p, const Vec3& n, const Vec3& d, bool bright_patches_only) const {
    return can_choose(hit) ? density(hit, receiver(p, n), d, bright_patches_only) : 0;
  }

  /// Probability with which sample() would choose the luminaire or sun of this number at p.
  double probability(std::uint32_t light, const Vec3& p, const Vec3& n) const;

  const GlossLight& gloss() const { return gloss_; }

  /// Irradiance at p of luminaires and of the sun, straight and over lobes of glossy surfaces: a shadow ray to each
  /// luminaire, more to openings that are near.
  /// row: null, or where to add what comes of each.
  Spectrum delta_light(const Vec3& p, const Vec3& n, const DeltaEffort& effort, std::uint64_t key,
                       LightRow* row = nullptr) const;

 private:
  bool can_choose(const Hit& hit) const { return !hit.reflected && hit.patch.valid() && is_bright(hit.patch); }
  struct Shares {
    double patches = 0, luminaires = 0, suns = 0;  ///< probabilities, sum 1
  };
  Shares shares(const Vec3& p, const Vec3& n) const;
  LightSample on_patch(const LightTree::Receiver& at, double pick, double u, double v, double share) const;
  LightSample on_luminaire(const Vec3& p, const Vec3& n, double pick, double u, double v, double share) const;
  LightSample on_sun(const Vec3& p, const Vec3& n, double pick, double u, double v, double share) const;
  /// share: of all suns together.
  double probability_of(const PlacedSun& sun, double share) const;

  const Problem& problem_;
  const Field& glow_;
  GlossLight gloss_;
  LightTree patches_, luminaires_;              ///< of bright_; of all luminaires, by number
  std::vector<std::uint32_t> bright_;           ///< patches sampled like lights
  std::vector<std::uint32_t> number_of_patch_;  ///< N, number in bright_ or kNone; empty without any
  double patches_power_ = 0, luminaires_power_ = 0, suns_power_ = 0;  ///< [W]
};

}  // namespace clerestory
