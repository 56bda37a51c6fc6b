#include "solver/sampling/area_cells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kGradual = 0.15;  ///< neighbours that differ by less, as share of the brighter, need no finer cells

/// Bits of x, each followed by a zero.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 4) & 0x0f0f;  // of up to eight
  x = (x | x << 2) & 0x3333;
  return (x | x << 1) & 0x5555;
}
std::uint32_t gather(std::uint32_t x) {
  x &= 0x5555;
  x = (x | x >> 1) & 0x3333;
  x = (x | x >> 2) & 0x0f0f;
  return (x | x >> 4) & 0x00ff;
}
std::uint32_t number_of(std::uint32_t i, std::uint32_t j) { return spread(i) << 1 | spread(j); }

std::vector<std::array<float, 2>> net(int grid, std::uint64_t key) {
  const std::uint32_t count = AreaCells::count(grid), side = 4u << grid;
  std::vector<std::array<float, 2>> points(count);
  const float below_one = 0x1.fffffep-1f;
  // The first points of the sequence, as many as there are cells, have one in each.
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto u = sobol4(k, key);
    points[number_of(static_cast<std::uint32_t>(u[0] * side), static_cast<std::uint32_t>(u[1] * side))] = {
        std::min(static_cast<float>(u[0]), below_one), std::min(static_cast<float>(u[1]), below_one)};
  }
  return points;
}

constexpr int kNothing = -1;

/// Grids of pilots, coarse to fine, and what they found.
class Pilots {
 public:
  Pilots(const AreaCells& cells, int first, const LookAtPoints& look) : cells_(cells), look_(look), first_(first) {
    std::vector<std::uint32_t> all(AreaCells::count(first));
    for (std::uint32_t c = 0; c < all.size(); ++c) all[c] = c;
    look_at(first, all);
  }

  std::size_t spent() const { return spent_; }
  double brightest() const { return brightest_; }

  /// Cells of the finest grid so far, of which a neighbour is much brighter or darker.
  std::vector<std::uint32_t> edges(int grid) const {
    std::vector<std::uint32_t> edges;
    for (const std::uint32_t c : at(grid).looked_at)
      if (differs(grid, c, [](int, std::uint32_t) { return true; })) edges.push_back(c);
    return edges;
  }

  /// Looks at the quarters of these cells of `grid`; where one differs from a neighbour that was left whole, at the
  /// quarters of that neighbour as well, and so on along the edge: its cells may all have looked alike by chance.
  void divide(int grid, std::vector<std::uint32_t> chosen, std::size_t most) {
    while (!chosen.empty()) {
      std::vector<std::uint32_t> quarters;
      for (const std::uint32_t c : chosen) {
        at(grid).divided[c] = true;
        for (std::uint32_t k = 0; k < 4; ++k) quarters.push_back(4 * c + k);
      }
      look_at(grid + 1, quarters);
      chosen.clear();
      if (spent_ > most) return;
      for (const std::uint32_t q : quarters)
        differs(grid + 1, q, [&](int neighbour_grid, std::uint32_t neighbour) {
          if (neighbour_grid == grid) chosen.push_back(neighbour);
          return false;
        });
      std::sort(chosen.begin(), chosen.end());
      chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    }
  }

  AreaPlan plan() const {
    AreaPlan plan;
    for (int grid = first_; grid < AreaCells::kGrids; ++grid)
      for (const std::uint32_t c : at(grid).looked_at) {
        if (at(grid).divided[c]) continue;
        plan.cells.push_back({static_cast<std::uint16_t>(grid), static_cast<std::uint16_t>(c)});
        plan.mean += at(grid).value[c] * plan.cells.back().share();
      }
    return plan;
  }

 private:
  struct Grid {
    std::vector<std::uint32_t> looked_at;
    std::vector<Spectrum> value;
    std::vector<float> luminous;  ///< kNothing where it was not looked at
    std::vector<bool> divided;
  };
  Grid& at(int grid) { return grids_[static_cast<std::size_t>(grid)]; }
  const Grid& at(int grid) const { return grids_[static_cast<std::size_t>(grid)]; }

  void look_at(int grid, const std::vector<std::uint32_t>& chosen) {
    Grid& g = at(grid);
    if (g.luminous.empty()) {
      g.value.resize(AreaCells::count(grid));
      g.luminous.assign(AreaCells::count(grid), kNothing);
      g.divided.resize(AreaCells::count(grid));
    }
    points_.clear();
    for (const std::uint32_t c : chosen) points_.push_back(cells_.pilots(grid)[c]);
    values_.resize(points_.size());
    look_(points_, values_);
    spent_ += points_.size();
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      g.looked_at.push_back(chosen[k]);
      g.value[chosen[k]] = values_[k];
      g.luminous[chosen[k]] = static_cast<float>(luminous_mean(values_[k]));
      brightest_ = std::max(brightest_, luminous_mean(values_[k]));
    }
  }

  /// Calls found(grid, number) for neighbours of a cell that differ from it, finer ones apart, until one returns true.
  template <class FoundOne>
  bool differs(int grid, std::uint32_t number, const FoundOne& found) const {
    const int side = 4 << grid, i = static_cast<int>(gather(number >> 1)), j = static_cast<int>(gather(number));
    const float own = at(grid).luminous[number];
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        if (i + di < 0 || i + di >= side || j + dj < 0 || j + dj >= side) continue;
        if (grid > first_ && di != 0 && dj != 0) continue;
        int at_grid = grid;
        std::uint32_t near = number_of(static_cast<std::uint32_t>(i + di), static_cast<std::uint32_t>(j + dj));
        while (at_grid > first_ && at(at_grid).luminous[near] == kNothing) --at_grid, near /= 4;
        const float other = at(at_grid).luminous[near];
        if (std::abs(own - other) > kGradual * std::max(own, other) && found(at_grid, near)) return true;
      }
    return false;
  }

  const AreaCells& cells_;
  const LookAtPoints& look_;
  int first_;
  std::array<Grid, AreaCells::kGrids> grids_;
  std::size_t spent_ = 0;
  double brightest_ = 0;
  std::vector<std::array<float, 2>> points_;
  std::vector<Spectrum> values_;
};

}  // namespace

AreaCells::AreaCells(int last, std::uint64_t seed) {
  for (int grid = 0; grid <= last; ++grid) {
    points_[static_cast<std::size_t>(grid)] = net(grid, stream_key(seed, kAreaPoints));
    pilots_[static_cast<std::size_t>(grid)] = net(grid, stream_key(seed, kAreaPilots));
  }
}

namespace {

/// Of edges that pass so many cells: half of them lie beside it, and each errs by half of its light, either way.
double error_of_edges(double brightest, std::size_t edges, int grid) {
  return brightest * std::sqrt(static_cast<double>(edges) / 8) / AreaCells::count(grid);
}

/// The pilots of a coarser grid, when they find the same everywhere, or what they may have missed does not matter.
std::optional<AreaPlan> even_view(const AreaCells& cells, int grid, double tolerance, double others,
                                  const LookAtPoints& look) {
  constexpr double kEven = 0.05;
  const std::uint32_t count = AreaCells::count(grid);
  std::vector<Spectrum> values(count);
  look(cells.pilots(grid), values);
  AreaPlan plan{.cells = {}, .whole = static_cast<std::uint16_t>(grid)};
  double low = luminous_mean(values[0]), high = low;
  for (std::uint32_t c = 0; c < count; ++c) {
    low = std::min(low, luminous_mean(values[c])), high = std::max(high, luminous_mean(values[c]));
    plan.mean += values[c] / count;
  }
  const bool is_enough = high - low <= kEven * high ||
                         error_of_edges(high - low, count, grid) < tolerance * (luminous_mean(plan.mean) + others);
  return is_enough ? std::optional(std::move(plan)) : std::nullopt;
}

}  // namespace

AreaPlan plan_area(const AreaCells& cells, const AreaBudget& budget, double others, const LookAtPoints& look) {
  if (budget.first > 0)
    if (auto plan = even_view(cells, budget.first - 1, budget.tolerance, others, look)) return *plan;
  Pilots pilots(cells, budget.first, look);
  for (int grid = budget.first; grid < budget.last; ++grid) {
    std::vector<std::uint32_t> edges = pilots.edges(grid);
    const double error = error_of_edges(pilots.brightest(), edges.size(), grid);
    const AreaPlan so_far = pilots.plan();
    if (edges.empty() || error < budget.tolerance * (luminous_mean(so_far.mean) + others)) return so_far;
    // Each would send four pilots, and four rays that count in the end.
    if (pilots.spent() + so_far.size() + 7 * edges.size() > budget.most_rays) return so_far;
    pilots.divide(grid, std::move(edges), budget.most_rays);
  }
  return pilots.plan();
}

}  // namespace clerestory
