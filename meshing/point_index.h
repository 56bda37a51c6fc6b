#pragma once
// Points by place: finds the known point nearest to another within a small radius.

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "solver/model/random_stream.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Hash grid over points of a growing array that it does not own. Cost: one to eight cells a query.
class PointIndex {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  PointIndex(const std::vector<Vec3>& points, double largest_radius) : points_(&points), cell_(8 * largest_radius) {}

  void add(std::uint32_t id) {
    const auto [it, is_new] = head_.try_emplace(key(cell_of((*points_)[id])), id);
    if (next_.size() <= id) next_.resize(id + 1, kNone);
    if (!is_new) {
      next_[id] = it->second;
      it->second = id;
    }
  }
  /// The nearest point at most `radius` from p, the lowest index among equals; kNone if there is none.
  std::uint32_t find(const Vec3& p, double radius) const {
    std::uint32_t best = kNone;
    double best_distance = radius;
    const Cell low = cell_of(p - Vec3{radius, radius, radius}), high = cell_of(p + Vec3{radius, radius, radius});
    for (std::int64_t x = low.x; x <= high.x; ++x)
      for (std::int64_t y = low.y; y <= high.y; ++y)
        for (std::int64_t z = low.z; z <= high.z; ++z) {
          const auto it = head_.find(key({x, y, z}));
          if (it == head_.end()) continue;
          for (std::uint32_t id = it->second; id != kNone; id = next_[id]) {
            const double d = length((*points_)[id] - p);
            if (d < best_distance || (d == best_distance && id < best)) {
              best = id;
              best_distance = d;
            }
          }
        }
    return best;
  }

 private:
  struct Cell {
    std::int64_t x, y, z;
  };
  Cell cell_of(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / cell_)), static_cast<std::int64_t>(std::floor(p.y / cell_)),
            static_cast<std::int64_t>(std::floor(p.z / cell_))};
  }
  static std::uint64_t key(const Cell& c) {
    return stream_key(static_cast<std::uint64_t>(c.x), static_cast<std::uint64_t>(c.y),
                      static_cast<std::uint64_t>(c.z));
  }

  const std::vector<Vec3>* points_;
  double cell_;
  std::unordered_map<std::uint64_t, std::uint32_t> head_;
  std::vector<std::uint32_t> next_;
};

}  // namespace clerestory
