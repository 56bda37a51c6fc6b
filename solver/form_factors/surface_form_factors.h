#pragma once
// Form factors between named groups of triangles, as exact as the geometry allows.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Which group each patch belongs to.
struct PatchGroups {
  std::vector<std::string> name;     ///< by group number
  std::vector<std::uint32_t> group;  ///< N, by PatchId
};

enum class GroupBy {
  object,    ///< a named object of the model
  material,  ///< all that carries one material
  surface,   ///< the patches of an object in one plane: NAME, or NAME/1, NAME/2 ... where it has several
  patch      ///< each triangle by itself: its number
};
PatchGroups group_patches(const PatchSet& patches, GroupBy by);

/// Standard error that rays go for, as a share of F.
inline constexpr double kFactorError = 0.002;

struct SurfaceFactorOptions {
  /// Most point pairs for each pair of triangles with something in between, at least 256, beside those of pilots; 0:
  /// 2^28 divided by the number of groups and that of such pairs which leave the group, no less than 32,768 and no more
  /// than 16,777,216. Taken by 256s. Below 512 pilots have nothing to choose, and are what counts.
  int most_samples = 0;
  /// About so many such pairs are held at a time, 48 bytes each; a group with more is looked at twice, in blocks.
  std::size_t pairs_held = 1 << 20;
  std::uint64_t seed = 1;
};

/// F is the part of the flux leaving the patches of `from` that arrives at those of `to`.
struct SurfaceFactor {
  std::uint32_t from = 0, to = 0;  ///< group numbers
  double F = 0;
  double std_error = 0;   ///< of F, as measured; 0 where nothing blocks
  double visibility = 1;  ///< F over its unoccluded value; 1 where nothing blocks, 0 where all is hidden

  /// Whether its standard error is as small as it should be. Where no ray arrived there is nothing to be a share of.
  bool reached() const { return F == 0 || std_error <= kFactorError * F; }
};

struct SurfaceFactors {
  std::vector<SurfaceFactor> rows;  ///< every ordered pair of groups, self factors included, from by from
  std::vector<double> row_sum;      ///< by group: 1 in a closed scene
  double reciprocity_error = 0;     ///< largest |A_i F_ij - A_j F_ji| / (A_i F_ij + A_j F_ji)
  std::size_t pairs_unblocked = 0, pairs_sampled = 0;  ///< of triangles
  unsigned long long rays = 0;
  bool complete = true;  ///< false when the monitor stopped the work
};

/// Factors between all groups of a PatchSet, each patch acting on its own side and every triangle blocking on both.
/// Pairs of triangles with an empty shaft by closed form or quadrature (1e-6 relative: polygon_to_polygon.h), the
/// others by as much, times their sampled visibility. Coarse triangles serve best: there is nothing to gain from small
/// ones.
///
/// A pilot of 256 samples for each pair of triangles tells where rays are worth most for the factor of their groups.
/// Pairs that want many are parted, so that what is seen through a gap is looked at there. Rays go on until std_error
/// is below kFactorError of F, or most_samples are used up: a pair that wants more is sampled anew, at most six times.
/// Where no ray arrived 16,384 of them say so.
///
/// Bias: none by pilots, which are thrown away. Later rounds end when the very samples that are kept say that their
/// error is small enough, which favours those with a smaller spread, or more light, than there is. By too little to be
/// found: 600 factors through a hole that shows 6.6 % were 0.002 +- 0.006 % of F too high, each with 0.15 % of error.
///
/// The two directions of a pair are sampled apart, which makes the reciprocity error an honest check.
/// Threads: same bits for any thread count. Cost: 1 to 50 us for each unblocked pair, 0.1 us for each sample.
SurfaceFactors surface_form_factors(const PatchSet& patches, const RayScene& rays, const PatchGroups& groups,
                                    const SurfaceFactorOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
