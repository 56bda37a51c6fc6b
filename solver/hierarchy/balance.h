#pragma once
// The radiosity equation on links: B = M + rho E + tau E behind, E = E_direct + gather(B).

#include <string>
#include <vector>

#include "solver/hierarchy/links.h"
#include "solver/model/element_tree.h"
#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/model/solution.h"

namespace clerestory {

/// Right-hand sides of the equation, S of them side by side: lane s * channels + c is channel c of number s.
struct Balanced {
  Field E, B;                         ///< N x lanes [W/m2]
  std::vector<EnergyBalance> energy;  ///< S; what is absorbed and escapes once it has arrived
  StopReason stop = StopReason::converged;
  long iterations = 0;
  double residual = 0;  ///< of the worst lane [1]
};

/// Sweeps until sum A |M + rho E - B| of every lane is below `residual` times its flux sum A (M + E_direct). After each
/// one an ambient irradiance e of each space and lane, B += e albedo, makes the area-weighted residual of the space
/// vanish, as in FullMatrixSystem: a few tens of sweeps at reflectance 0.9999 as at 0.5. All of it is linear in the
/// light, so from no first guess the sum of lanes is the balance of their sum, but for the sweeps that the slowest of
/// them wants more.
///
/// M         N x lanes, what is emitted.
/// E_direct  N x lanes: delta light and what comes straight from the sky.
/// B         N x lanes: first guess; empty: M + rho E_direct.
/// Cost      V + links a sweep and eight lanes; a sweep of eight lanes takes 1.4 times as long as one of one.
Balanced balance(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& M,
                 const Field& E_direct, Field B, double residual, const Monitor& monitor = {});

}  // namespace clerestory
