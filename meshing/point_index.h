#pragma once
// Points by place: finds the known point nearest to another within a small radius.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "solver/model/random_stream.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Hash grid over points of a growing array that it does not own. Cost: one to eight cells a query.
class PointGrid {
 public:
  static constexpr std::uint32_t kNone = 0xffffffff;

  PointGrid(const std::vector<Vec3>& points, double cell) : points_(&points), cell_(cell) {}

  void add(std::uint32_t id) {
    if (next_.size() <= id) next_.resize(id + 1, kNone);
    if (2 * (cells_ + 1) > first_.size()) grow();
    std::uint32_t& first = slot(cell_of((*points_)[id]));
    if (first == kNone) ++cells_;
    next_[id] = first;
    first = id;
  }
  /// The nearest point at most `radius` from p, the lowest index among equals; kNone if there is none.
  std::uint32_t find(const Vec3& p, double radius) const {
    std::uint32_t best = kNone;
    double best_distance = radius;
    const Cell low = cell_of(p - Vec3{radius, radius, radius}), high = cell_of(p + Vec3{radius, radius, radius});
    for (std::int64_t x = low.x; x <= high.x; ++x)
      for (std::int64_t y = low.y; y <= high.y; ++y)
        for (std::int64_t z = low.z; z <= high.z; ++z) {
          for (std::uint32_t id = first_in({x, y, z}); id != kNone; id = next_[id]) {
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
    bool operator==(const Cell&) const = default;
  };
  Cell cell_of(const Vec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / cell_)), static_cast<std::int64_t>(std::floor(p.y / cell_)),
            static_cast<std::int64_t>(std::floor(p.z / cell_))};
  }
  /// Where the first point of a cell is kept, or is to be.
  std::size_t slot_number(const Cell& c) const {
    const std::size_t mask = first_.size() - 1;
    std::size_t k =
        stream_key(static_cast<std::uint64_t>(c.x), static_cast<std::uint64_t>(c.y), static_cast<std::uint64_t>(c.z)) &
        mask;
    while (first_[k] != kNone && cell_of((*points_)[first_[k]]) != c) k = (k + 1) & mask;
    return k;
  }
  std::uint32_t& slot(const Cell& c) { return first_[slot_number(c)]; }
  std::uint32_t first_in(const Cell& c) const { return first_.empty() ? kNone : first_[slot_number(c)]; }
  void grow() {
    const std::vector<std::uint32_t> before = std::move(first_);
    first_.assign(std::max<std::size_t>(64, 2 * before.size()), kNone);
    for (const std::uint32_t id : before)
      if (id != kNone) slot(cell_of((*points_)[id])) = id;
  }

  const std::vector<Vec3>* points_;
  double cell_;
  std::vector<std::uint32_t> first_;  ///< open hash table of cells: a point of each; half empty, a power of two long
  std::size_t cells_ = 0;
  std::vector<std::uint32_t> next_;  ///< by point, another one of its cell
};

/// Points by place, for radii of any size up to the largest: a grid for each power of 64, made when it is first asked.
/// In one grid a model far smaller than its largest face would lie in one cell.
class PointIndex {
 public:
  static constexpr std::uint32_t kNone = PointGrid::kNone;

  PointIndex(const std::vector<Vec3>& points, double largest_radius) : points_(&points), largest_(largest_radius) {}

  void add(std::uint32_t id) {
    added_.push_back(id);
    for (auto& grid : grids_)
      if (grid) grid->add(id);
  }
  /// As PointGrid::find.
  std::uint32_t find(const Vec3& p, double radius) {
    std::size_t level = 0;
    double fits = largest_;
    for (; level + 1 < grids_.size() && radius < fits / kFiner; ++level) fits /= kFiner;
    auto& grid = grids_[level];
    if (!grid) {
      grid.emplace(*points_, 8 * fits);
      for (const std::uint32_t id : added_) grid->add(id);
    }
    return grid->find(p, radius);
  }

 private:
  static constexpr double kFiner = 64;
  const std::vector<Vec3>* points_;
  double largest_;
  std::vector<std::uint32_t> added_;
  std::array<std::optional<PointGrid>, 6> grids_;
};

}  // namespace clerestory
