#pragma once
// The unit square in cells, fine where what is seen changes: how openings and bright areas are looked at.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solver/model/channels.h"

namespace clerestory {

/// Grids of 4 x 4, 8 x 8, ... cells, each with a point for a pilot ray and one for the ray that counts. Cells are in
/// Morton order: the four of the next grid that cover cell c are 4 c ... 4 c + 3, and neighbours mostly follow each
/// other. The points of a grid are one Owen-scrambled Sobol net, the same for all receivers.
class AreaCells {
 public:
  static constexpr int kGrids = 7;  ///< the last has 256 x 256 cells
  /// last  finest grid that is asked for.
  AreaCells(int last, std::uint64_t seed);

  static constexpr std::uint32_t count(int grid) { return 16u << (2 * grid); }
  const std::vector<std::array<float, 2>>& points(int grid) const { return points_[static_cast<std::size_t>(grid)]; }
  const std::vector<std::array<float, 2>>& pilots(int grid) const { return pilots_[static_cast<std::size_t>(grid)]; }

 private:
  std::array<std::vector<std::array<float, 2>>, kGrids> points_, pilots_;
};

/// How finely an area is looked at.
struct AreaBudget {
  int first, last;        ///< grids that it is looked at on, finer ones only along edges
  double tolerance;       ///< no finer grid once the edges' error is below, of all light at the point [1]
  std::size_t most_rays;  ///< about so many, pilots and what counts together: no finer grid than they allow
};

struct AreaCell {
  std::uint16_t grid, number;  ///< number: in Morton order
  /// Of the unit square.
  double share() const { return 1.0 / AreaCells::count(grid); }
};

/// Cells that cover the unit square once, and the mean of what pilots found in them.
struct AreaPlan {
  std::vector<AreaCell> cells;  ///< empty: all of one grid, `whole`; millions of plans are kept
  std::uint16_t whole = 0;
  Spectrum mean{0.0};

  std::size_t size() const { return cells.empty() ? AreaCells::count(whole) : cells.size(); }
  AreaCell operator[](std::size_t k) const {
    return cells.empty() ? AreaCell{whole, static_cast<std::uint16_t>(k)} : cells[k];
  }
};

/// Sets the values of points of the unit square, any number of them.
using LookAtPoints = std::function<void(std::span<const std::array<float, 2>>, std::span<Spectrum>)>;

/// Cells are divided where neighbours differ by more than a sixth of the brighter one: rays are spent along the edges
/// of what hides an area, and few where the view is even or changes slowly.
///
/// others  value which, all over the area, would give as much as all other light at the point does, roughly.
AreaPlan plan_area(const AreaCells& cells, const AreaBudget& budget, double others, const LookAtPoints& look);

}  // namespace clerestory
