#pragma once
// The radiosity equation on links: B = M + rho E + tau E behind, E = E_direct + gather(B).

#include <string>

#include "solver/hierarchy/links.h"
#include "solver/model/element_tree.h"
#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/model/solution.h"

namespace clerestory {

/// Sweeps until sum A |M + rho E - B| of every channel is below `residual` times the flux sum A (M + E_direct). After
/// each one an ambient irradiance e of each space and channel, B += e albedo, makes the area-weighted residual of the
/// space vanish, as in FullMatrixSystem: a few tens of sweeps at reflectance 0.9999 as at 0.5.
///
/// E_direct  N x channels: delta light and transport.E_sky.
/// B         N x channels: first guess; empty: M + rho E_direct.
/// returns   E, B, residual, iterations, stop, log; of the balance what is absorbed and escapes once it has arrived.
/// Cost      V + links a sweep.
Solution balance(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& E_direct,
                 Field B, double residual, const Monitor& monitor = {});

}  // namespace clerestory
