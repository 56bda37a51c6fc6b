#pragma once
// Dates and times as people write them, and series of them.

#include <string>
#include <vector>

#include "solver/model/solar_position.h"

namespace clerestory {

/// "2026-06-21T12:00", seconds allowed: local standard time.
///
/// place   "office.json: time", for messages.
/// throws  InputError when it is no such time, or one that does not exist.
Moment read_moment(const std::string& time, const std::string& place);

/// "2026-06-21T12:00", with seconds where there are any.
std::string moment_text(const Moment& moment);

/// Hours from the midnight that begins the day of `first`, for either: 30 is 6:00 on the day after.
double hours_since(const Moment& first, const Moment& moment);

/// The times of FROM/TO/STEP, both ends included: "2026-03-21T06:00/20:00/PT1H". TO may be a time of the same day; STEP
/// is an ISO 8601 duration of days, hours, minutes and seconds, PT1H, PT1H30M, P1D.
///
/// what    "--times", for messages.
/// throws  InputError when it is none, ends before it begins, or has more than 200 times.
std::vector<Moment> read_times(const std::string& series, const std::string& what);

}  // namespace clerestory
