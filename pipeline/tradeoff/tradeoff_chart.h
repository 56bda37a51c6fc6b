#pragma once
// Error against time, the picture of a sweep.

#include "io/chart/chart.h"
#include "pipeline/tradeoff/tradeoff.h"

namespace clerestory {

/// Rms in the worst room over seconds on the clock, both logarithmic: a colour a method, its levels joined by a line
/// and named by their first letter; a wide grey line joins the runs that no other beats in both. Bounds are drawn as
/// rings.
Chart tradeoff_chart(const Tradeoff& tradeoff);

}  // namespace clerestory
