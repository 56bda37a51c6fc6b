#pragma once
// Chooses openings to look through, by what they can give where light is asked for.

#include <cstdint>
#include <vector>

#include "solver/lights/light_tree.h"
#include "solver/lights/lights.h"
#include "solver/openings/openings.h"

namespace clerestory {

class OpeningSampler {
 public:
  /// extent: see LightTree.
  OpeningSampler(std::vector<LightArea> openings, double extent);

  bool empty() const { return tree_.empty(); }
  /// Whether sample() may find any there.
  bool reaches(const Vec3& p, const Vec3& n) const { return !empty() && tree_.reaches(p, n); }

  struct Sample {
    Vec3 direction;             ///< unit
    double per_choice = 0;      ///< solid angle for each share of the choice: 1 / density [sr]; 0: nothing to choose
    double preference = 0;      ///< part of preference(direction) that is due to the opening chosen [1/sr]
    std::uint32_t opening = 0;  ///< the one chosen
  };
  /// Opening chosen by `pick` in [0, 1), and the direction (u, v) through it, for receiver point p with normal n.
  Sample sample(const Vec3& p, const Vec3& n, double pick, double u, double v) const;

  /// Close to the density of sample() in direction d, all openings that it passes together, but one [1/sr]: what to
  /// weigh against other ways to find the same direction.
  double preference(const Vec3& p, const Vec3& n, const Vec3& d, std::uint32_t but = 0xffffffff) const;

 private:
  std::vector<LightArea> openings_;
  std::vector<OpeningSphere> spheres_;  ///< of the openings
  LightTree tree_;
};

}  // namespace clerestory
