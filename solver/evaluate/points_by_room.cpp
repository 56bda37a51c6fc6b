#include "solver/evaluate/points_by_room.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/model/random_stream.h"

namespace clerestory {

namespace {
constexpr double kShareByChange = 1.0 / 3;  ///< of a room's looks
}

PointsByRoom::PointsByRoom(const PatchSet& patches, std::span<const double> change)
    : patches_(patches),
      order_(patches.patch_count()),
      cumulative_(patches.patch_count()),
      weight_(patches.patch_count()),
      areas_(patches.room_count()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::stable_sort(order_, {}, [&](std::uint32_t i) { return patches_.room_of(i); });
  const double all = patches.total_area();
  if (!(all > 0)) return;
  for (const std::uint32_t i : order_) areas_[patches_.room_of(i)] += patches.area[i];
  double roots = 0, large = 0;
  for (const double area : areas_) roots += std::sqrt(area), large += area >= kLargeRoom * all;
  large_rooms_ = static_cast<std::size_t>(large);
  // An error goes with the change, and its square counts.
  const auto squared_change = [&](std::uint32_t i) {
    return change.empty() ? 0 : patches.area[i] * change[i] * change[i];
  };
  std::vector<double> changes(areas_.size());  // by room
  for (const std::uint32_t i : order_) changes[patches_.room_of(i)] += squared_change(i);
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::uint32_t i = order_[k], room = patches_.room_of(i);
    const double a = areas_[room], of_room = patches.area[i] / a;
    if (!(patches.area[i] > 0)) {
      cumulative_[k] = total_;
      continue;
    }
    const double looks_at_room = (a / all + std::sqrt(a) / roots + (a >= kLargeRoom * all ? 1 / large : 0)) / 3;
    const double in_room = changes[room] > 0
                               ? (1 - kShareByChange) * of_room + kShareByChange * squared_change(i) / changes[room]
                               : of_room;
    const double looks = looks_at_room * in_room;
    weight_[k] = patches.area[i] / all / looks;
    cumulative_[k] = total_ += looks;
  }
}

std::vector<PointInRoom> PointsByRoom::points(std::size_t count, std::uint64_t key) const {
  std::vector<PointInRoom> points;
  RandomStream random(key);
  for (std::size_t s = 0; s < count; ++s) {
    const double place = (static_cast<double>(s) + random.uniform()) / static_cast<double>(count) * total_;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), place);
    const std::size_t k =
        std::min<std::size_t>(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);
    const std::size_t patch = order_[k];
    const double u = random.uniform(), v = random.uniform();
    points.push_back({patch, patches_.room_of(patch), weight_[k], u, v});
  }
  return points;
}

}  // namespace clerestory
