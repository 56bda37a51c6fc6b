#pragma once
// OUT.json of `clerestory annual`: the figures of rooms and grids, with the rules they follow.

#include <string>

#include "solver/model/annual.h"

namespace clerestory {

/// {version, scene, weather: {...}, schedule: {...}, threshold, illuminance_error: {rooms: {total, direct}, grids:
/// {...}}, rules: {...},
///  rooms: [{name, area, points, sDA, sDA_low, sDA_high, ASE, ASE_low, ASE_high, ASE_at_least: {...}, EN17037: {...},
///  LEED_v4_1: {...}, mean_illuminance, hours_blinds_closed, hours_not_complying}], grids: the same}.
/// area is null where it is not known, and each point counts the same. ASE counts more than 250 hours, ASE_at_least 250
/// or more. Shares in %, illuminance in lx.
std::string annual_json(const AnnualReport& report);

}  // namespace clerestory
