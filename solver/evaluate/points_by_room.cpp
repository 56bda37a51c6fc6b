#include "solver/evaluate/points_by_room.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "solver/model/random_stream.h"

namespace clerestory {

PointsByRoom::PointsByRoom(const PatchSet& patches)
    : patches_(patches),
      order_(patches.patch_count()),
      cumulative_(patches.patch_count()),
      areas_(patches.room_count()),
      weight_(areas_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::ranges::stable_sort(order_, {}, [&](std::uint32_t i) { return patches_.room_of(i); });
  const double all = patches.total_area();
  if (!(all > 0)) return;
  for (const std::uint32_t i : order_) areas_[patches_.room_of(i)] += patches.area[i];
  double roots = 0, large = 0;
  for (const double area : areas_) roots += std::sqrt(area), large += area >= kLargeRoom * all;
  large_rooms_ = static_cast<std::size_t>(large);
  for (std::size_t k = 0; k < areas_.size(); ++k) {
    const double a = areas_[k];
    const double looks = (a / all + std::sqrt(a) / roots + (a >= kLargeRoom * all ? 1 / large : 0)) / 3;
    weight_[k] = looks > 0 ? a / all / looks : 0;
  }
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const double weight = weight_[patches_.room_of(order_[k])];
    cumulative_[k] = total_ += weight > 0 ? patches.area[order_[k]] / weight : 0;
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
    points.push_back({patch, patches_.room_of(patch), weight_[patches_.room_of(patch)], u, v});
  }
  return points;
}

}  // namespace clerestory
