#pragma once
// Whether what a method takes for form factors obeys the laws of form factors.

#include "solver/hierarchy/links.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/model/element_tree.h"
#include "solver/model/laws.h"
#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/spaces/closure.h"

namespace clerestory {

/// |A_i F_ij - A_j F_ji| / max of both, over all pairs of patches. The matrix is made symmetric, so only rounding to
/// float is allowed. Not checked when the monitor stops it.
LawCheck reciprocity_of_matrix(const PatchSet& patches, const FormFactorMatrix& F, const Monitor& monitor = {});

/// The same over links, between surfaces (SurfaceId and room): |x_gh - x_hg| / min(A_g, A_h), x_gh = sum A_p F_pq over
/// p in g and q in h. Both directions are rays of their own; allowed are 5 of their standard errors, counted as for
/// independent rays, and what arrives over nodes that are of more than one surface. Not checked for links that were not
/// made by rays, nor when the monitor stops it.
LawCheck reciprocity_of_links(const PatchSet& leaves, const ElementTree& tree, const Transport& transport,
                              const Monitor& monitor = {});

/// |row sum - share that arrives|, over rows and, weighted by area, over surfaces. `closure` is of rays apart from
/// those of the method. Allowed are 5 standard errors of these rays and the matrix' own row errors; 1e-6 where both say
/// that nothing is lost.
LawCheck row_sums_of_matrix(const PatchSet& patches, const FormFactorMatrix& F, const Closure& closure, int rays);

/// The same over links, by surface.
LawCheck row_sums_of_links(const PatchSet& leaves, const ElementTree& tree, const Transport& transport,
                           const Closure& closure, int rays);

}  // namespace clerestory
