#pragma once
// What lighting standards ask of a set of sensors: mean, extremes, median, uniformity, shares.

#include <optional>
#include <span>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/sensors.h"

namespace clerestory {

/// lux                 illuminance at each point of the set [lx], at least one.
/// daylight_reference  illuminance on open ground [lx], > 0; empty: no daylight factors.
SensorSummary summary_of(const SensorSet& set, std::vector<double> lux, std::optional<double> daylight_reference);

/// One a set, of the irradiance E [W/m2] at the points of all sets, one set after the other.
std::vector<SensorSummary> summaries_of(std::span<const SensorSet> sets, const Field& E,
                                        std::optional<double> daylight_reference);

}  // namespace clerestory
