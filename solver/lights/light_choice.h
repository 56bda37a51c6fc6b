#pragma once
// Chooses one of many luminaires and suns by what it can give at a point.

#include <cstdint>
#include <vector>

#include "solver/lights/light_tree.h"

namespace clerestory {

class LightChoice {
 public:
  struct Sun {
    Vec3 direction;    ///< unit, to it
    double power = 0;  ///< irradiance of a plane that faces it [W/m2], > 0
  };
  LightChoice() = default;
  /// extent  as of LightTree.
  LightChoice(const std::vector<LightBounds>& luminaires, std::vector<Sun> suns, double extent);

  bool empty() const { return luminaires_.empty() && suns_.empty(); }
  /// LightTree::Choice::light is the number of the luminaire, or the number of luminaires more than that of the sun.
  LightTree::Choice choose(const Vec3& p, const Vec3& n, double pick) const;
  /// Of choose(), for that number.
  double probability(std::uint32_t light, const Vec3& p, const Vec3& n) const;

 private:
  struct Shares {
    double luminaires = 0, suns = 0;  ///< probabilities, sum 1 or 0
    double sun_power = 0;             ///< of the suns in front
  };
  Shares shares(const Vec3& p, const Vec3& n) const;

  LightTree luminaires_;
  std::uint32_t count_ = 0;  ///< of luminaires
  std::vector<Sun> suns_;
};

}  // namespace clerestory
