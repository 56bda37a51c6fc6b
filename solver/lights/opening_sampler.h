#pragma once
// Chooses openings to look for the sky through, by what they can give where light is asked for.

#include "solver/lights/light_tree.h"
#include "solver/problem.h"

namespace clerestory {

class OpeningSampler {
 public:
  explicit OpeningSampler(const Problem& problem);

  bool empty() const { return tree_.empty(); }

  struct Sample {
    Vec3 direction;         ///< unit
    double per_choice = 0;  ///< solid angle for each share of the choice: 1 / density [sr]; 0: nothing to choose
    double preference = 0;  ///< part of preference(direction) that is due to the opening chosen [1/sr]
    double others = 0;      ///< and the rest of it
  };
  /// LightArea chosen by `pick` in [0, 1), and the direction (u, v) through it, for receiver point p with normal n.
  Sample sample(const Vec3& p, const Vec3& n, double pick, double u, double v) const;

  /// Close to the density of sample() in direction d, all openings that it passes together [1/sr]: what to weigh
  /// against other ways to find the same direction.
  double preference(const Vec3& p, const Vec3& n, const Vec3& d) const;

 private:
  double preference(const Vec3& p, const Vec3& n, const Vec3& d, std::uint32_t but) const;

  const Problem& problem_;
  LightTree tree_;
};

}  // namespace clerestory
