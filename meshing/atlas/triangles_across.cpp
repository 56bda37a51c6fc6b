#include "meshing/atlas/triangles_across.h"

#include <algorithm>
#include <tuple>

namespace clerestory {

TrianglesAcross triangles_across(const WrittenResult& result) {
  struct Edge {
    std::uint32_t low, high, triangle;
    std::uint8_t corner;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * result.triangles.size());
  for (std::uint32_t t = 0; t < result.triangles.size(); ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(result.triangles[t][k], result.triangles[t][(k + 1) % 3]);
      edges.push_back({low, high, t, k});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
  });
  TrianglesAcross across(result.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
  const auto same = [](const Edge& a, const Edge& b) { return a.low == b.low && a.high == b.high; };
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t end = i + 1;
    while (end < edges.size() && same(edges[i], edges[end])) ++end;
    const Edge &a = edges[i], &b = edges[end - 1];
    if (end - i == 2 && a.low != a.high && a.triangle != b.triangle)
      across[a.triangle][a.corner] = b.triangle, across[b.triangle][b.corner] = a.triangle;
    i = end;
  }
  return across;
}

}  // namespace clerestory
