#include "solver/hierarchy/feet.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace clerestory {
namespace {

/// Of the corner of an outline, beyond half a turn [radian]: legs with up to some thirty sides have more.
constexpr double kSticksIn = 0.2;

/// Angle of the surface around each point [radian].
std::vector<double> angles_around(const ElementMesh& mesh, const std::vector<std::uint32_t>& leaves) {
  std::vector<double> angle(mesh.points().position.size());
  for (const std::uint32_t leaf : leaves) {
    const auto point = mesh.points_of(leaf);
    const auto x = mesh.corner_positions(leaf);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
      angle[point[k]] += std::atan2(length(cross(a, b)), dot(a, b));
    }
  }
  return angle;
}

}  // namespace

std::size_t cut_at_feet(ElementMesh& mesh, const ShortestEdge& shortest_edge, double share, std::size_t most_points) {
  const std::vector<double> angle = angles_around(mesh, mesh.leaves());  // no cut changes it
  const auto sticks_in = [&](std::uint32_t p) { return p < angle.size() && angle[p] > std::numbers::pi + kSticksIn; };
  const auto is_foot_middle = [&](std::uint32_t p) {
    return p >= angle.size() && std::ranges::all_of(mesh.ends(p), sticks_in);
  };
  // Share of the edge at which it is cut, 0 where it is not.
  const auto where = [&](std::uint32_t leaf, std::size_t k) {
    const std::size_t next = (k + 1) % 3;
    const auto point = mesh.points_of(leaf);
    const std::uint32_t from = point[k], to = point[next];
    const double at = sticks_in(from) && sticks_in(to)        ? 0.5
                      : sticks_in(from) && is_foot_middle(to) ? 0.25
                      : is_foot_middle(from) && sticks_in(to) ? 0.75
                                                              : 0;
    if (at == 0) return 0.0;
    const std::uint32_t across = mesh.neighbours(leaf)[k];
    if (across != VertexLightmap::kNone && std::ranges::count(mesh.points_of(across), from) > 0) return 0.0;
    const auto x = mesh.corner_positions(leaf);
    return length(x[next] - x[k]) > share * shortest_edge.of(mesh.patches(), mesh[leaf].patch) ? at : 0;
  };
  std::size_t cut = 0;
  for (std::size_t before = cut + 1; before != cut;) {  // a leaf may have two such edges
    before = cut;
    for (const std::uint32_t leaf : mesh.leaves())
      for (std::size_t k = 0; k < 3 && mesh[leaf].is_leaf() && mesh.points().position.size() < most_points; ++k)
        if (const double at = where(leaf, k); at > 0) mesh.cut(leaf, k, at), ++cut;
  }
  return cut;
}

}  // namespace clerestory
