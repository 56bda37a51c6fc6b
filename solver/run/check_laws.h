#pragma once
// A finished solve against the laws of radiosity.

#include <vector>

#include "solver/illumination/problem.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/kept_transport.h"
#include "solver/model/laws.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/run/solve.h"

namespace clerestory {

/// What a method took for form factors: one of them, or neither.
struct UsedTransport {
  KeptTransport links;
  FormFactorMatrix matrix;
};

/// Every law by room, in the order of Law; those without a meaning for the method say why.
///
/// problem  with the elements that the solution belongs to, values as the method left them. unhalved: with the patches
///          that they were halved from, or the same.
/// monitor  a law that there is no time for is not checked, and says so.
/// Cost     4 million rays for form factors, a quarter of a million for energy, and the direct light of the patches
/// twice more.
std::vector<LawCheck> check_laws(const Problem& problem, const Problem& unhalved, const VertexLightmap& lightmap,
                                 const Solution& solution, const UsedTransport& used, const SolveOptions& options,
                                 const Monitor& monitor = {});

}  // namespace clerestory
