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

struct SurfaceFactorOptions {
  int samples = 16'384;  ///< point pairs for each pair of triangles with something in between, a multiple of 256
  std::uint64_t seed = 1;
};

/// F is the part of the flux leaving the patches of `from` that arrives at those of `to`.
struct SurfaceFactor {
  std::uint32_t from = 0, to = 0;  ///< group numbers
  double F = 0;
  double std_error = 0;   ///< of F; 0 where nothing blocks
  double visibility = 1;  ///< F over its unoccluded value; 1 where nothing blocks, 0 where all is hidden
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
/// The two directions of a pair are sampled apart, which makes the reciprocity error an honest check.
/// Threads: same bits for any thread count. Cost: 1 to 50 us for each unblocked pair, 0.1 us for each sample.
SurfaceFactors surface_form_factors(const PatchSet& patches, const RayScene& rays, const PatchGroups& groups,
                                    const SurfaceFactorOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
