#pragma once
// Directions of the sky's light, by radiance and the cosine to a plane.

#include <span>
#include <vector>

#include "solver/lights/sky.h"
#include "solver/sampling/cumulative_table.h"

namespace clerestory {

/// The sphere in 128 x 256 cells of one solid angle, over height and azimuth, of 4 x 4 in a block.
class SkyDirections {
 public:
  /// What a plane gets of it from its front, by block of cells.
  class Plane {
   public:
    /// normal  unit, to where the light goes.
    Plane(const SkyDirections& sky, const Vec3& normal);

    /// On the plane, luminous mean [W/m2]; with about a hundredth that is there to miss nothing.
    double irradiance() const { return blocks_.sum(); }
    /// Direction of travel, towards the front or, of one in a hundred, away from it.
    Vec3 sample(const SkyDirections& sky, double u, double v) const;
    /// Of sample() [1/sr].
    double density(const SkyDirections& sky, const Vec3& travel) const;

   private:
    CumulativeTable blocks_;
  };

  explicit SkyDirections(const SkyRadiance& sky);

  /// Mean irradiance of a plane that faces the light along its normal [W/m2], luminous mean: quadrature over the cells.
  double irradiance(const Vec3& normal) const;

 private:
  static constexpr int kHeights = 128, kAzimuths = 256, kBlock = 4;
  static constexpr int kBlocks = kHeights * kAzimuths / (kBlock * kBlock);
  static int cell_of(int block, int part) {
    const int blocks_around = kAzimuths / kBlock;
    return (block / blocks_around * kBlock + part / kBlock) * kAzimuths + block % blocks_around * kBlock +
           part % kBlock;
  }
  /// To the sky, at the place (a, b) of the cell.
  static Vec3 towards(int cell, double a, double b);

  std::vector<float> radiance_;   ///< by cell, luminous mean, > 0
  std::vector<double> of_block_;  ///< their sum
};

}  // namespace clerestory
