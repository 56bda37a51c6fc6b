#include "solver/hierarchy/gradients.h"

#include <algorithm>
#include <cmath>

namespace clerestory {

void find_gradients(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const std::vector<double>& E,
                    const std::vector<bool>& of, std::vector<Vec3>& gradient) {
  gradient.resize(E.size());
  std::vector<double> weight(E.size());
  for (std::size_t p = 0; p < E.size(); ++p)
    if (of[p]) gradient[p] = {};
  for (const std::uint32_t leaf : leaves) {
    if (mesh[leaf].penumbra) continue;  // a slope of its own, between sides that have others
    const auto point = mesh.points_of(leaf);
    const auto x = mesh.corner_positions(leaf);
    const Vec3 n = cross(x[1] - x[0], x[2] - x[0]);
    const double twice_area = length(n);
    if (!(twice_area > 0)) continue;
    Vec3 g;
    for (std::size_t k = 0; k < 3; ++k) g += cross(n, x[(k + 2) % 3] - x[(k + 1) % 3]) * E[point[k]];
    // g is the gradient times the square of 2 A; weighted by area, 2 A is left.
    for (const std::uint32_t p : point)
      if (of[p]) gradient[p] += g / twice_area, weight[p] += twice_area;
  }
  for (std::size_t p = 0; p < E.size(); ++p)
    if (weight[p] > 0) gradient[p] = gradient[p] / weight[p];
}

Field leaf_irradiance(const ElementMesh& mesh, const Field& E) {
  constexpr double kMostBulge = 0.1;  // of the mean: more is a shadow's edge, and no curve
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  Field mean(leaves.size(), E.channels);
  std::vector<double> value(E.size());
  std::vector<Vec3> gradient;
  const std::vector<bool> all(E.size(), true);
  for (int c = 0; c < E.channels; ++c) {
    for (std::size_t p = 0; p < value.size(); ++p) value[p] = E.at(p, c);
    find_gradients(mesh, leaves, value, all, gradient);
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const auto point = mesh.points_of(leaves[i]);
      const auto x = mesh.corner_positions(leaves[i]);
      const double corners = (value[point[0]] + value[point[1]] + value[point[2]]) / 3;
      double off = 0;
      for (std::size_t k = 0; k < 3; ++k) off += bulge(x, point, gradient, k) / 3;
      const double most = kMostBulge * std::abs(corners);  // all but dark, an estimate may be below 0
      mean.at(i, c) = corners + std::clamp(off, -most, most);
    }
  }
  return mean;
}

}  // namespace clerestory
