#pragma once
// What patches send each other by way of panes that turn it back.

#include <cstdint>

#include "solver/methods/form_factor_matrix.h"

namespace clerestory {

inline constexpr std::uint32_t kEchoRays = 1024;  ///< from each patch that sees any

/// Adds to F what rays find that glass turns back and lobes send on: F_ij + the share of what leaves i that arrives at
/// j so, with A_i F_ij = A_j F_ji. Of coloured glass the mean of its channels. Two patches of whose 64 pilots none
/// meets glass exchange nothing so.
///
/// Threads: same bits for any thread count. Cost: 64 rays a patch with glass in the scene, 1,024 where it is in view.
void add_echoes(FormFactorMatrix& F, const PatchSet& patches, const RayScene& rays, std::uint64_t seed,
                const Monitor& monitor);

}  // namespace clerestory
