#include "pipeline/report/section_lines.h"

#include <algorithm>

#include "io/picture/iso_lines.h"

namespace clerestory {
namespace {

constexpr double kStraight = 1e-3;  ///< [m] what a line may be off and is still straight

double distance_to_way(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 way = b - a;
  const double l2 = dot(way, way);
  const double t = l2 > 0 ? std::clamp(dot(p - a, way) / l2, 0.0, 1.0) : 0.0;
  return length(p - a - t * way);
}

std::vector<Vec3> straightened(const std::vector<Vec3>& line) {
  std::vector<Vec3> kept;
  for (const Vec3& p : line) {
    while (kept.size() >= 2 && distance_to_way(kept.back(), kept[kept.size() - 2], p) < kStraight) kept.pop_back();
    kept.push_back(p);
  }
  return kept;
}

}  // namespace

std::vector<std::vector<Vec3>> section_lines(std::span<const Vec3> points,
                                             std::span<const std::array<std::uint32_t, 3>> triangles,
                                             const Vec3& origin, const Vec3& normal) {
  std::vector<Vec3> corners;
  std::vector<float> height;
  std::vector<std::array<std::uint32_t, 3>> cut;
  for (const auto& triangle : triangles) {
    double h[3];
    for (std::size_t k = 0; k < 3; ++k) h[k] = dot(points[triangle[k]] - origin, normal);
    const auto [low, high] = std::minmax({h[0], h[1], h[2]});
    if (!(low < 0 && high >= 0)) continue;
    const auto first = static_cast<std::uint32_t>(corners.size());
    for (std::size_t k = 0; k < 3; ++k) {
      corners.push_back(points[triangle[k]]);
      height.push_back(static_cast<float>(h[k]));
    }
    cut.push_back({first, first + 1, first + 2});
  }
  std::vector<std::vector<Vec3>> lines;
  if (cut.empty()) return lines;
  constexpr double kHere[] = {0.0};
  for (const IsoLine& line : iso_lines(corners, cut, height, kHere)) lines.push_back(straightened(line.points));
  return lines;
}

}  // namespace clerestory
