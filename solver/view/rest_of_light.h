#pragma once
// A result's light without what comes straight from luminaires and suns.

#include "solver/model/monitor.h"
#include "solver/model/written_result.h"
#include "solver/view/fine_light.h"

namespace clerestory {

/// Irradiance of each point, less what FineLight finds there; not below 0. A point on the edge of a shadow has all or
/// nothing of a light, by which side of it the solve looked from: within these bounds the rest is as at its neighbours.
///
/// returns  P x channels [W/m2]; empty when the monitor stopped it.
/// Threads: same bits for any thread count. Cost: up to 16 rays to each light from each corner of a triangle.
Field rest_of_light(const WrittenResult& result, const FineLight& light, const Monitor& monitor = {});

/// Irradiance of each point by light of luminaires and suns that glossy surfaces turn to it: what rays that look around
/// in the result's light do not meet. Returns as above.
Field light_by_gloss(const WrittenResult& result, const FineLight& light, const Monitor& monitor = {});

}  // namespace clerestory
