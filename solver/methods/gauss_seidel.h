#pragma once
// Gathering on the full matrix, patch after patch.

#include "solver/methods/full_matrix_system.h"

namespace clerestory {

/// Solves B = M + rho (E_direct + F B) by Gauss-Seidel sweeps, each patch gathering what the ones before it have
/// become, and a coarse ambient correction after each sweep (full_matrix_system.h).
///
/// patches   N patches, rho in [0, 1); E_direct: N x channels, irradiance of sky, sun and luminaires [W/m2].
/// returns   E and B of the patches, energy balance, one log line per sweep; stopped early what is there so far.
/// Threads: same bits for any thread count. Cost: two passes over F per sweep and channel; 10 to 35 sweeps.
/// Source: Cohen & Greenberg, "The hemi-cube: a radiosity solution for complex environments", 1985.
Solution gauss_seidel(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct,
                      const GatherOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
