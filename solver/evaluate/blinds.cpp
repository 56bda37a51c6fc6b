#include "solver/evaluate/blinds.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "solver/model/assert.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostTried = 12;  // 4,096 sets

/// A room in one hour: the groups that let in sun.
struct SunlitRoom {
  std::span<const std::span<const float>> groups;
  std::span<const float> steady;
  std::vector<std::size_t> sunny;  ///< groups
  std::vector<std::size_t> lit;    ///< points that have enough sun with all blinds open; closing makes it no more

  bool closed_in(std::uint64_t set, std::size_t k) const { return (set >> k & 1) != 0; }
  /// Points with sun when the groups of `set`, by their place in `sunny`, are closed.
  std::size_t points_with_sun(std::uint64_t set) const {
    return static_cast<std::size_t>(std::ranges::count_if(lit, [&](std::size_t p) {
      double lux = steady.empty() ? 0 : steady[p];
      for (std::size_t k = 0; k < sunny.size(); ++k)
        if (!closed_in(set, k)) lux += groups[sunny[k]][p];
      return lux >= kSunLux;
    }));
  }
  /// Of places in `sunny`, as bits of groups.
  std::uint64_t groups_of(std::uint64_t set) const {
    std::uint64_t closed = 0;
    for (std::size_t k = 0; k < sunny.size(); ++k)
      if (closed_in(set, k)) closed |= std::uint64_t{1} << sunny[k];
    return closed;
  }
};

struct Choice {
  std::uint64_t set = 0;
  std::size_t left = 0;  ///< points with sun
};

/// Sets by size, each size in order of the earliest groups.
Choice try_all(const SunlitRoom& room, std::size_t allowed, Choice best) {
  const std::size_t n = room.sunny.size();
  for (std::size_t size = 1; size <= n && best.left > allowed; ++size)
    for (std::uint64_t set = 1; set < std::uint64_t{1} << n; ++set) {
      if (static_cast<std::size_t>(std::popcount(set)) != size) continue;
      if (const std::size_t left = room.points_with_sun(set); left < best.left) best = {set, left};
    }
  return best;
}

Choice one_by_one(const SunlitRoom& room, std::size_t allowed, Choice best) {
  while (best.left > allowed) {
    Choice next = best;
    for (std::size_t k = 0; k < room.sunny.size(); ++k) {
      const std::uint64_t set = best.set | std::uint64_t{1} << k;
      if (const std::size_t left = room.points_with_sun(set); left < next.left) next = {set, left};
    }
    if (next.left == best.left) break;  // no group alone helps
    best = next;
  }
  return best;
}

}  // namespace

BlindsOfHour close_blinds(std::span<const std::span<const float>> groups, std::span<const float> steady) {
  CLERESTORY_ASSERT(groups.size(), <=, kMostWindowGroups);
  const std::size_t points = groups.empty() ? steady.size() : groups.front().size();
  SunlitRoom room{groups, steady, {}, {}};
  for (std::size_t g = 0; g < groups.size(); ++g) {
    CLERESTORY_ASSERT(groups[g].size(), ==, points);
    if (std::ranges::any_of(groups[g], [](float lux) { return lux > 0; })) room.sunny.push_back(g);
  }
  for (std::size_t p = 0; p < points; ++p) {
    double lux = steady.empty() ? 0 : steady[p];
    for (const std::size_t g : room.sunny) lux += groups[g][p];
    if (lux >= kSunLux) room.lit.push_back(p);
  }
  const auto allowed = static_cast<std::size_t>(kSunnyShare * static_cast<double>(points) + 1e-9);
  Choice choice{0, room.lit.size()};
  if (choice.left > allowed)
    choice = room.sunny.size() <= kMostTried ? try_all(room, allowed, choice) : one_by_one(room, allowed, choice);
  return {room.groups_of(choice.set), choice.left <= allowed};
}

}  // namespace clerestory
