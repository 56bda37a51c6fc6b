#include "solver/visibility/turning_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
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

/// That the triangle lies in; their count: none.
std::size_t number_of(const std::vector<MirrorPlane>& planes, const Corners& triangle, double diameter) {
  const Vec3 n = triangle.unit_normal();
  const auto same = [&](const MirrorPlane& plane) {
    return length(cross(plane.normal, n)) < 1e-6 && std::abs(plane.height(triangle.x[0])) < 1e-6 * diameter;
  };
  return static_cast<std::size_t>(std::ranges::find_if(planes, same) - planes.begin());
}

void add_to(MirrorPlane& plane, const Corners& triangle) {
  for (const Vec3& x : triangle.x) plane.add(x);
}

/// Planes of mirrors as they come; nothing where they are more than those that show images.
std::optional<std::vector<MirrorPlane>> few_planes(const PatchSet& patches, double diameter) {
  std::vector<MirrorPlane> planes;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    if (!patches.front_material(t).turns_rays()) continue;
    const Corners triangle = corners_of(patches, t);
    const Vec3 n = triangle.unit_normal();
    if (!(length(n) > 0.5)) continue;  // without area
    const auto number = number_of(planes, triangle, diameter);
    if (number < planes.size()) continue;
    if (planes.size() == kMostPlanes) return {};
    planes.push_back(mirror_plane(n, dot(n, triangle.x[0]), false));
  }
  return planes;
}

void find_mirrors(const PatchSet& patches, double diameter, TurningPlanes& found) {
  auto& planes = found.planes;
  if (auto few = few_planes(patches, diameter)) {
    planes = std::move(*few);
  } else {
    const auto is_mirror = [&](TriangleId t) { return patches.front_material(t).turns_rays(); };
    for (const TrianglesInPlane& same : largest_planes(patches, diameter, is_mirror, true))
      planes.push_back(mirror_plane(same.plane.normal, same.plane.offset, false));
  }
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    if (!patches.front_material(t).turns_rays()) continue;
    const Corners triangle = corners_of(patches, t);
    const Vec3 a = triangle.x[0], n = triangle.unit_normal();
    if (!(length(n) > 0.5)) continue;  // without area
    if (found.mirrors.empty()) found.mirror_of_triangle.assign(patches.triangle_count(), TurningPlanes::kNoMirror);
    const std::size_t number = number_of(planes, triangle, diameter);
    found.mirror_of_triangle[t] = static_cast<std::uint32_t>(found.mirrors.size());
    const bool shows = number < planes.size();
    const Vec3 normal = shows ? planes[number].normal : n;
    found.mirrors.push_back({normal, dot(normal, a), shows ? static_cast<std::uint32_t>(number) : kNoPlane,
                             patches.front_material(t).reflectance});
    if (shows) add_to(planes[number], triangle);
  }
}

void find_glass_planes(const PatchSet& patches, double diameter, TurningPlanes& found) {
  const auto is_glass = [&](TriangleId t) { return patches.front_material(t).lets_rays_pass(); };
  for (std::size_t i = 0; i < patches.triangle_count() && found.glass_plane.empty(); ++i)
    if (is_glass(TriangleId{i})) found.glass_plane.assign(patches.triangle_count(), kNoPlane);
  if (found.glass_plane.empty()) return;
  for (TrianglesInPlane& panes : largest_planes(patches, diameter, is_glass, false)) {
    panes.plane.is_glass = true;
    for (const TriangleId t : panes.triangles) found.glass_plane[t] = static_cast<std::uint32_t>(found.planes.size());
    found.planes.push_back(panes.plane);
  }
}

}  // namespace

std::vector<TrianglesInPlane> largest_planes(const PatchSet& patches, double diameter,
                                             const std::function<bool(TriangleId)>& belongs, bool particles_follow) {
  // Planes that rounding tells apart are two: their triangles are, too.
  std::map<std::array<long, 4>, TrianglesInPlane> by_plane;
  for (std::size_t i = 0; i < patches.triangle_count(); ++i) {
    const TriangleId t{i};
    if (!belongs(t)) continue;
    const Corners triangle = corners_of(patches, t);
    Vec3 n = triangle.unit_normal();
    if (!(length(n) > 0.5)) continue;  // without area
    if (n.x < -1e-5 || (n.x < 1e-5 && (n.y < -1e-5 || (n.y < 1e-5 && n.z < 0)))) n = -n;
    TrianglesInPlane& same = by_plane[{std::lround(n.x * 1e5), std::lround(n.y * 1e5), std::lround(n.z * 1e5),
                                       std::lround(dot(n, triangle.x[0]) / (2e-6 * diameter))}];
    same.area += triangle.area();
    same.triangles.push_back(t);
  }
  std::vector<TrianglesInPlane> all;
  for (auto& [key, same] : by_plane) all.push_back(std::move(same));
  std::ranges::stable_sort(all, std::greater<>(), &TrianglesInPlane::area);
  if (particles_follow && all.size() > kMostPlanes) {
    double area = 0;
    for (const TrianglesInPlane& same : all) area += same.area;
    std::erase_if(all, [&](const TrianglesInPlane& same) { return same.area < area / kMostPlanes; });
  }
  all.resize(std::min(kMostPlanes, all.size()));
  for (TrianglesInPlane& same : all) {
    const Corners first = corners_of(patches, same.triangles[0]);
    same.plane = mirror_plane(first.unit_normal(), dot(first.unit_normal(), first.x[0]), false);
    for (const TriangleId t : same.triangles) add_to(same.plane, corners_of(patches, t));
  }
  return all;
}

TurningPlanes find_turning_planes(const PatchSet& patches, double diameter) {
  TurningPlanes found;
  find_mirrors(patches, diameter, found);
  find_glass_planes(patches, diameter, found);
  return found;
}

}  // namespace clerestory
