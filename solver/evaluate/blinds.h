#pragma once
// Blinds after IES LM-83: which of a room's window groups are closed in an hour with sun.

#include <cstddef>
#include <cstdint>
#include <span>

#include "solver/model/annual.h"

namespace clerestory {

inline constexpr std::size_t kMostWindowGroups = 64;  ///< of one room
inline constexpr double kSunnyShare = 0.02;           ///< of a room's points that may have kSunLux of direct sun

struct BlindsOfHour {
  std::uint64_t closed = 0;  ///< bit g: blinds of group g are closed
  bool complies = true;      ///< at most 2 % of the points have sun; if not, `closed` leaves the fewest
};

/// The least set: the fewest groups that, closed, leave at most 2 % of the points with 1,000 lx or more of direct sun;
/// of sets as small the one that leaves the fewest such points, then that whose last group is the earliest. Where no
/// set complies, the smallest that leaves the fewest.
///
/// groups  direct sun through the windows of each to each of the room's points, blinds open [lx]: at most
///         kMostWindowGroups. Closed blinds scatter what they let through, and it counts as no sun.
/// steady  direct sun through windows without blinds [lx], by point; empty: none.
///
/// All sets are tried for up to twelve groups that let in sun (in one hour few do: the sun shines on two facades);
/// beyond that groups are closed one after another, each time the one that leaves the fewest points: the least set too
/// where each point has its sun through one group. Thread safe.
BlindsOfHour close_blinds(std::span<const std::span<const float>> groups, std::span<const float> steady = {});

/// Counts an occupied hour.
inline void add_hour(const BlindsOfHour& hour, BlindsYear& year) {
  year.hours_closed += hour.closed != 0;
  year.hours_not_complying += !hour.complies;
}

}  // namespace clerestory
