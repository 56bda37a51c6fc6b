#pragma once
// Irradiance by caustics at points, on surfaces or in the air.

#include <cstddef>
#include <span>
#include <vector>

#include "solver/illumination/light_rows.h"
#include "solver/illumination/problem.h"
#include "solver/model/point_irradiance.h"

namespace clerestory {

struct CausticIrradiance {
  Field E;                       ///< P x channels [W/m2]
  std::vector<double> variance;  ///< P, of its luminous mean, by the spread of the legs
  std::vector<LightRow> rows;    ///< P, E by light; empty unless they were asked for
};

/// Density of the legs through a disc around each point: a kernel 1 - (r / h)^2, h so that about so many of them pass,
/// on what a point sees of its plane within h. Linear light comes out as it is whatever part that is.
///
/// Up to 1/40 of the scene's diameter h grows where legs are few. Threads: same bits for any thread count.
/// Cost: one pass of all legs, 0.3 us each and 0.1 us for each disc they meet; 32 rays a point that any leg passes.
CausticIrradiance caustic_irradiance(const Problem& problem, std::span<const CausticLeg> legs,
                                     std::size_t legs_of_point, std::size_t count, const PointOf& point_of,
                                     bool with_rows = false);

/// That of the problem's own caustics.
CausticIrradiance caustic_irradiance(const Problem& problem, std::size_t count, const PointOf& point_of,
                                     bool with_rows = false);

}  // namespace clerestory
