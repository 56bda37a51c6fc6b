#pragma once
// Every patch against every other: the full matrix of the classic methods.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

struct FormFactorOptions {
  std::uint64_t seed = 1;
  /// Largest matrix to make [bytes]; 0: 60 % of the machine's memory.
  std::size_t memory_limit = 0;
  /// Scale rows of closed patches to sum to 1 exactly. Off: the raw factors.
  bool close_rows = true;
};

/// F_ij [1], visibility included, row-major; A_i F_ij = A_j F_ji to float rounding.
struct FormFactorMatrix {
  std::size_t n = 0;
  std::vector<float> value;         ///< n * n
  std::vector<double> row_sum;      ///< n, of the values as stored
  std::vector<double> raw_row_sum;  ///< n, before rows were scaled
  std::vector<double> row_error;    ///< n, expected error of raw_row_sum (standard error of the rays, quadrature)
  std::vector<bool> closed;         ///< n, all that leaves the patch arrives somewhere: the true row sum is 1
  bool complete = true;             ///< false when the monitor stopped the work: unfinished factors are 0
  std::vector<bool> row_filled;     ///< n, no factor of the row is missing: row_sum says what escapes
  std::vector<double> escapes;      ///< n, of what reaches no patch: the share that leaves the scene, not into glass;
                                    ///< with gloss, whose rows sum to more than 1, of all that is sent
  bool has_gloss = false;
  std::size_t pairs_unblocked = 0;  ///< pairs that face each other, nothing in their shaft
  std::size_t pairs_sampled = 0;    ///< pairs whose visibility was sampled by rays
  unsigned long long rays = 0;

  std::span<const float> row(std::size_t i) const { return {value.data() + i * n, n}; }
  float at(std::size_t i, std::size_t j) const { return value[i * n + j]; }
  /// sum_j F_ij B_j counts times this: 1, but for what rounding to float leaves of a closed row.
  double row_gain(std::size_t i) const { return closed[i] && row_sum[i] > 0 ? 1 / row_sum[i] : 1; }
  /// Largest and rms |raw row sum - 1| of closed rows, how many rows are closed, pairs and rays, as lines for the log.
  std::vector<std::string> log() const;
};

/// Memory that form_factor_matrix() takes for n patches [bytes]: n^2 floats and a few per cent.
std::size_t form_factor_bytes(std::size_t n);

/// What form_factor_matrix() checks first, for callers with long work before it.
/// throws   InputError when the matrix would be larger than the limit, with its size and what to do instead.
void require_matrix_fits(std::size_t patches, const FormFactorOptions& options = {});

/// The full matrix: unblocked pairs by quadrature or closed form (triangle_to_triangle.h), pairs with something in
/// their shaft by sampled visibility (sampled.h). Each pair is taken once and stored both ways by reciprocity.
///
/// In a closed room raw rows sum to 1 within 1e-3. They are then scaled symmetrically, F_ij <- d_i F_ij d_j, until the
/// rows of closed patches sum to 1: at reflectance 0.99 a row error of 1e-3 would grow to 10 %, and a symmetric scale
/// keeps A_i F_ij = A_j F_ji. A row counts as closed when none of its rays escapes, meets glass or a side that takes no
/// part, and its sum is within its error of 1.
///
/// throws   InputError when the matrix would be larger than the limit (require_matrix_fits).
/// Threads: same bits for any thread count. Cost: n^2 / 2 pairs of 0.2 to 2 us.
FormFactorMatrix form_factor_matrix(const PatchSet& patches, const RayScene& rays,
                                    const FormFactorOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
