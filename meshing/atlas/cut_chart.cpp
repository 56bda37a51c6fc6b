#include "meshing/atlas/cut_chart.h"

#include <algorithm>
#include <numeric>

namespace clerestory {

ChartCut best_cut(const std::vector<std::array<Texel, 3>>& texels,
                  const std::vector<std::array<std::uint32_t, 2>>& to_part, bool in_middle,
                  std::array<std::vector<std::uint32_t>, 2>& order) {
  ChartCut best;
  const std::size_t n = texels.size();
  double whole = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto centre = [&](std::uint32_t i) { return texels[i][0][axis] + texels[i][1][axis] + texels[i][2][axis]; };
    order[axis].resize(n);
    std::iota(order[axis].begin(), order[axis].end(), 0u);
    std::stable_sort(order[axis].begin(), order[axis].end(),
                     [&](std::uint32_t a, std::uint32_t b) { return centre(a) < centre(b); });
    // Rectangle of the first i, and of the others.
    const auto sizes = [&](auto begin, auto end) {
      std::vector<double> size{0};
      Texel low{1e300, 1e300}, high{-1e300, -1e300};
      for (auto i = begin; i != end; ++i) {
        for (const Texel& p : texels[*i])
          for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        size.push_back((high[0] - low[0] + 3.5) * (high[1] - low[1] + 3.5));
      }
      return size;
    };
    const std::vector<double> before = sizes(order[axis].begin(), order[axis].end());
    const std::vector<double> after = sizes(order[axis].rbegin(), order[axis].rend());
    whole = before.back();
    std::vector<std::uint32_t> place(n);
    for (std::uint32_t i = 0; i < n; ++i) place[order[axis][i]] = i;
    std::vector<double> parted(n + 1, 0);
    for (const auto& [a, b] : to_part) {
      const auto [low, high] = std::minmax(place[a], place[b]);
      parted[low + 1] += 1, parted[high + 1] -= 1;
    }
    double now = 0;
    for (std::size_t first = 1; first < n; ++first) {
      now += parted[first];
      double cost = before[first] + after[n - first];
      if (!to_part.empty()) cost += 2 * whole * (1 - now / static_cast<double>(to_part.size()));
      if (in_middle) cost = std::max(before[first], after[n - first]);
      if (cost < best.cost) best = {cost, axis, first};
    }
  }
  return best;
}

}  // namespace clerestory
