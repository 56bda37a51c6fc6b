#pragma once
// Gathering on the full matrix, all patches at once.

#include "solver/methods/full_matrix_system.h"

namespace clerestory {

/// Solves B = M + rho (E_direct + F B) by Jacobi sweeps, B <- B + w r with the residual r = M + rho E - B, and a coarse
/// ambient correction after each (full_matrix_system.h).
///
/// The step w is the one that leaves the least residual; with w = 1, the textbook's, two walls that see only each other
/// swing from sweep to sweep and settle no faster than their reflectance allows.
///
/// patches   N patches, rho in [0, 1); E_direct: N x channels, irradiance of sky, sun and luminaires [W/m2].
/// returns   E and B of the patches, energy balance, one log line per sweep; stopped early what is there so far.
/// Threads: same bits for any thread count. Cost: one pass over F per sweep and channel; 15 to 60 sweeps.
Solution jacobi(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct,
                const GatherOptions& options = {}, const Monitor& monitor = {});

}  // namespace clerestory
