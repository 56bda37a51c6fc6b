#include "solver/area_cells.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/model/random_stream.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kGradual = 0.25;  ///< neighbours that differ by less, as share of the brighter, need no finer cells

/// Bits of x, each followed by a zero.
std::uint32_t spread(std::uint32_t x) {
  x = (x | x << 4) & 0x0f0f;
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

/// What the pilots found, by grid; where a grid was not looked at, the coarser one tells.
class Found {
 public:
  explicit Found(int first) : first_(first) {}

  void set(int grid, std::uint32_t number, float value) {
    auto& values = values_[static_cast<std::size_t>(grid)];
    if (values.empty()) values.assign(AreaCells::count(grid), -1.0f);
    values[number] = value;
  }
  float at(int grid, std::uint32_t number) const {
    const auto& values = values_[static_cast<std::size_t>(grid)];
    if (grid > first_ && (values.empty() || values[number] < 0)) return at(grid - 1, number / 4);
    return values[number];
  }
  /// Whether a neighbour of the cell is much brighter or darker; on the first grid also those at its corners.
  bool is_edge(int grid, std::uint32_t number) const {
    const int side = 4 << grid, i = static_cast<int>(gather(number >> 1)), j = static_cast<int>(gather(number));
    float low = at(grid, number), high = low;
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj) {
        if (i + di < 0 || i + di >= side || j + dj < 0 || j + dj >= side) continue;
        if (grid > first_ && di != 0 && dj != 0) continue;
        const float near = at(grid, number_of(static_cast<std::uint32_t>(i + di), static_cast<std::uint32_t>(j + dj)));
        low = std::min(low, near), high = std::max(high, near);
      }
    return high - low > kGradual * high;
  }

 private:
  int first_;
  std::array<std::vector<float>, AreaCells::kGrids> values_;
};

}  // namespace

AreaCells::AreaCells(std::uint64_t seed) {
  for (int grid = 0; grid < kGrids; ++grid) {
    points_[static_cast<std::size_t>(grid)] = net(grid, stream_key(seed, 0xc1));
    pilots_[static_cast<std::size_t>(grid)] = net(grid, stream_key(seed, 0xc2));
  }
}

namespace {

/// The pilots of a coarser grid, when they find the same everywhere.
std::optional<AreaPlan> even_view(const AreaCells& cells, int grid, const LookAtPoints& look) {
  constexpr double kEven = 0.05;
  const std::uint32_t count = AreaCells::count(grid);
  std::vector<Spectrum> values(count);
  look(cells.pilots(grid), values);
  AreaPlan plan;
  double low = luminous_mean(values[0]), high = low;
  for (std::uint32_t c = 0; c < count; ++c) {
    low = std::min(low, luminous_mean(values[c])), high = std::max(high, luminous_mean(values[c]));
    plan.cells.push_back({static_cast<std::uint16_t>(grid), static_cast<std::uint16_t>(c)});
    plan.mean += values[c] / count;
  }
  return high - low <= kEven * high ? std::optional(std::move(plan)) : std::nullopt;
}

}  // namespace

AreaPlan plan_area(const AreaCells& cells, const AreaBudget& budget, double others, const LookAtPoints& look) {
  if (budget.first > 1)
    if (auto plan = even_view(cells, budget.first - 1, look)) return *plan;
  AreaPlan plan;
  Found found(budget.first);
  std::vector<std::uint32_t> here(AreaCells::count(budget.first)), edges;
  for (std::uint32_t c = 0; c < here.size(); ++c) here[c] = c;
  std::vector<std::array<float, 2>> points;
  std::vector<Spectrum> values;
  std::size_t spent = 0;
  double brightest = 0;
  for (int grid = budget.first; !here.empty(); ++grid) {
    points.clear();
    for (const std::uint32_t c : here) points.push_back(cells.pilots(grid)[c]);
    values.resize(points.size());
    look(points, values);
    spent += points.size();
    Spectrum mean = plan.mean;
    for (std::size_t k = 0; k < here.size(); ++k) {
      found.set(grid, here[k], static_cast<float>(luminous_mean(values[k])));
      brightest = std::max(brightest, luminous_mean(values[k]));
      mean += values[k] / AreaCells::count(grid);
    }
    edges.clear();
    if (grid < budget.last)
      for (const std::uint32_t c : here)
        if (found.is_edge(grid, c)) edges.push_back(c);
    // Half of the cells that an edge passes lie beside it; each errs by half of its light, either way.
    const double error = brightest * std::sqrt(static_cast<double>(edges.size()) / 8) / AreaCells::count(grid);
    if (error < budget.tolerance * (luminous_mean(mean) + others)) edges.clear();
    // Each would send four pilots, and four rays that count in the end.
    if (spent + plan.cells.size() + here.size() + 7 * edges.size() > budget.most_rays) edges.clear();
    for (std::size_t k = 0, e = 0; k < here.size(); ++k) {
      if (e < edges.size() && edges[e] == here[k]) {
        ++e;
        continue;
      }
      plan.cells.push_back({static_cast<std::uint16_t>(grid), static_cast<std::uint16_t>(here[k])});
      plan.mean += values[k] * plan.cells.back().share();
    }
    here.clear();
    for (const std::uint32_t c : edges)
      for (std::uint32_t child = 0; child < 4; ++child) here.push_back(4 * c + child);
  }
  return plan;
}

}  // namespace clerestory
