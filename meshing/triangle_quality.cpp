#include "meshing/triangle_quality.h"

#include <algorithm>
#include <numbers>

namespace clerestory {

void count_edges(const FaceComplex& complex, MeshReport& report) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Face& f : complex.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(f.corner[k], f.corner[(k + 1) % 3]);
      edges.push_back({a, b});
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end] == edges[k]) ++end;
    if (end - k == 1) ++report.boundary_edges;
    if (end - k > 2) ++report.non_manifold_edges;
    k = end;
  }
}

void measure_quality(const PatchSet& patches, MeshReport& report) {
  report.triangles = patches.triangle_count();
  if (report.triangles == 0) return;
  report.longest_edge = 0;
  report.shortest_edge = length(patches.vertices[patches.corners[0][1]] - patches.vertices[patches.corners[0][0]]);
  std::vector<double> angle;
  for (const auto& c : patches.corners) {
    double least = 180;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e = patches.vertices[c[(k + 1) % 3]] - patches.vertices[c[k]];
      const Vec3 f = patches.vertices[c[(k + 2) % 3]] - patches.vertices[c[k]];
      report.longest_edge = std::max(report.longest_edge, length(e));
      report.shortest_edge = std::min(report.shortest_edge, length(e));
      least = std::min(least, std::atan2(length(cross(e, f)), dot(e, f)) * 180 / std::numbers::pi);
    }
    angle.push_back(least);
  }
  const auto middle = angle.begin() + static_cast<std::ptrdiff_t>(angle.size() / 2);
  std::nth_element(angle.begin(), middle, angle.end());
  report.median_angle_deg = *middle;
  report.worst_angle_deg = *std::min_element(angle.begin(), angle.end());
}

}  // namespace clerestory
