#include "solver/visibility/turning_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <span>

namespace clerestory {
namespace {

constexpr std::size_t kMostPlanes = 64;

struct Corners {
  std::array<Vec3, 3> x;
  Vec3 unit_normal() const { return normalized(cross(x[1] - x[0], x[2] - x[0])); }
  double area() const { return length(cross(x[1] - x[0], x[2] - x[0])) / 2; }
};
Corners corners_of(const PatchSet& patches, TriangleId t) {
  const auto& corner = patches.corners[t];
  return {{patches.vertices[corner[0]], patches.vertices[corner[1]], patches.vertices[corner[2]]}};
}

void add_to(MirrorPlane& plane, const Corners& triangle) {
  for (const Vec3& x : triangle.x) plane.add(x);
}

void find_mirrors(const PatchSet& patches, double diameter, TurningPlanes& found) {
  auto& planes = found.planes;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    if (!patches.front_material(t).turns_rays()) continue;
    const Corners triangle = corners_of(patches, t);
    const Vec3 a = triangle.x[0], n = triangle.unit_normal();
    if (!(length(n) > 0.5)) continue;  // without area
    if (found.mirrors.empty()) found.mirror_of_triangle.assign(patches.triangle_count(), TurningPlanes::kNoMirror);
    const auto same = [&](const MirrorPlane& plane) {
      return length(cross(plane.normal, n)) < 1e-6 && std::abs(plane.height(a)) < 1e-6 * diameter;
    };
    const auto number = static_cast<std::size_t>(std::ranges::find_if(planes, same) - planes.begin());
    if (number == planes.size() && number < kMostPlanes) planes.push_back(mirror_plane(n, dot(n, a), false));
    found.mirror_of_triangle[t] = static_cast<std::uint32_t>(found.mirrors.size());
    const bool shows = number < planes.size();
    const Vec3 normal = shows ? planes[number].normal : n;
    found.mirrors.push_back({normal, dot(normal, a), shows ? static_cast<std::uint32_t>(number) : kNoPlane,
                             patches.front_material(t).reflectance});
    if (shows) add_to(planes[number], triangle);
  }
}

void find_glass_planes(const PatchSet& patches, double diameter, TurningPlanes& found) {
  struct Panes {
    double area = 0;
    std::vector<TriangleId> triangles;
  };
  // Planes that rounding tells apart are two: their panes are, too.
  std::map<std::array<long, 4>, Panes> by_plane;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    if (!patches.front_material(t).lets_rays_pass()) continue;
    if (found.glass_plane.empty()) found.glass_plane.assign(patches.triangle_count(), kNoPlane);
    const Corners triangle = corners_of(patches, t);
    Vec3 n = triangle.unit_normal();
    if (!(length(n) > 0.5)) continue;
    if (n.x < -1e-5 || (n.x < 1e-5 && (n.y < -1e-5 || (n.y < 1e-5 && n.z < 0)))) n = -n;
    Panes& panes = by_plane[{std::lround(n.x * 1e5), std::lround(n.y * 1e5), std::lround(n.z * 1e5),
                             std::lround(dot(n, triangle.x[0]) / (2e-6 * diameter))}];
    panes.area += triangle.area();
    panes.triangles.push_back(t);
  }
  std::vector<const Panes*> by_area;
  for (const auto& [key, panes] : by_plane) by_area.push_back(&panes);
  std::ranges::stable_sort(by_area, std::greater<>(), [](const Panes* p) { return p->area; });
  for (const Panes* panes : std::span(by_area).first(std::min(kMostPlanes, by_area.size()))) {
    const Corners first = corners_of(patches, panes->triangles[0]);
    const Vec3 n = first.unit_normal();
    const auto number = static_cast<std::uint32_t>(found.planes.size());
    found.planes.push_back(mirror_plane(n, dot(n, first.x[0]), true));
    for (const TriangleId t : panes->triangles) {
      found.glass_plane[t] = number;
      add_to(found.planes[number], corners_of(patches, t));
    }
  }
}

}  // namespace

TurningPlanes find_turning_planes(const PatchSet& patches, double diameter) {
  TurningPlanes found;
  find_mirrors(patches, diameter, found);
  find_glass_planes(patches, diameter, found);
  return found;
}

}  // namespace clerestory
