#include "meshing/triangulate_polygon.h"

#include <map>

#include "meshing/planar_triangulation.h"

namespace clerestory {
namespace {

using Indices = std::array<std::uint32_t, 3>;

bool is_convex(std::span<const Vec3> polygon, const Vec3& normal) {
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec3 a = polygon[k], b = polygon[(k + 1) % n], c = polygon[(k + 2) % n];
    if (!(dot(cross(b - a, c - b), normal) > 0)) return false;
  }
  return true;
}

/// That of the area, or, where parts of a polygon that crosses itself cancel, that of its largest triangle from the
/// first corner.
Vec3 plane_normal(std::span<const Vec3> polygon) {
  constexpr double kCancelled = 1e-9;
  Vec3 largest;
  double all = 0;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const Vec3 part = cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]) / 2;
    all += length(part);
    if (length(part) > length(largest)) largest = part;
  }
  const Vec3 area = area_vector(polygon);
  return normalized(length(area) > kCancelled * all ? area : largest);
}

}  // namespace

Vec3 area_vector(std::span<const Vec3> polygon) {
  Vec3 sum;
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += cross(polygon[k] - polygon[0], polygon[k + 1] - polygon[0]);
  return sum / 2;
}

PolygonTriangles triangulate_polygon(std::span<const Vec3> polygon, std::size_t most_crossings) {
  const auto n = static_cast<std::uint32_t>(polygon.size());
  PolygonTriangles result;
  if (n < 3) return result;
  if (n == 3) return {{{0, 1, 2}}, {}};
  const Vec3 normal = plane_normal(polygon);
  if (normal == Vec3{}) return result;
  if (n == 4 && is_convex(polygon, normal)) {
    // The shorter diagonal gives the better angles; within rounding the first, so that any scale gives the same.
    if (length(polygon[2] - polygon[0]) <= length(polygon[3] - polygon[1]) * (1 + 1e-9))
      return {{{0, 1, 2}, {0, 2, 3}}, {}};
    return {{{0, 1, 3}, {1, 2, 3}}, {}};
  }

  const Frame frame(normal);
  const Plane plane{polygon[0], frame.t, frame.b, frame.n};
  Cdt cdt;
  std::vector<std::pair<CdtKernel::Point_2, CdtVertex>> points(n);
  for (std::uint32_t k = 0; k < n; ++k) {
    const Point2 p = plane.flatten(polygon[k]);
    points[k] = {{p.x, p.y}, {k}};
  }
  constexpr std::uint32_t kMany = 4000;  // fewer are found soon enough from anywhere
  if (n > kMany) sort_by_place(points);
  std::vector<Cdt::Vertex_handle> corner(n);
  Cdt::Face_handle near;
  for (const auto& [point, k] : points) {
    corner[k.id] = cdt.insert(point, near);
    if (n > kMany) near = corner[k.id]->face();
  }
  for (std::uint32_t k = 0; k < n; ++k)
    if (corner[k]->info().id == kNoVertex) corner[k]->info().id = k;
  // A doubled edge (to a hole and back) does not part inside from outside.
  std::map<std::array<std::uint32_t, 2>, int> times;
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t a = corner[k]->info().id, b = corner[(k + 1) % n]->info().id;
    if (a != b) ++times[{std::min(a, b), std::max(a, b)}];
  }
  const std::size_t most_vertices = cdt.number_of_vertices() + most_crossings;
  for (const auto& [edge, count] : times) {
    if (count % 2 == 1) cdt.insert_constraint(corner[edge[0]], corner[edge[1]]);
    if (cdt.number_of_vertices() <= most_vertices) continue;
    result.gave_up = true;
    return result;
  }

  for (const auto v : cdt.finite_vertex_handles())
    if (v->info().id == kNoVertex) {
      v->info().id = n + static_cast<std::uint32_t>(result.crossings.size());
      result.crossings.push_back(plane.lift({v->point().x(), v->point().y()}));
    }
  // Parity from the outside in.
  std::deque<Cdt::Face_handle> queue{cdt.infinite_face()};
  if (cdt.dimension() < 2) return result;
  cdt.infinite_face()->info().mark = 0;
  while (!queue.empty()) {
    const auto f = queue.front();
    queue.pop_front();
    for (int i = 0; i < 3; ++i) {
      const auto g = f->neighbor(i);
      if (g->info().mark != kUnmarked) continue;
      g->info().mark = cdt.is_constrained({f, i}) ? 1 - f->info().mark : f->info().mark;
      queue.push_back(g);
    }
  }
  for (const auto f : cdt.finite_face_handles())
    if (f->info().mark == 1)
      result.triangles.push_back(Indices{f->vertex(0)->info().id, f->vertex(1)->info().id, f->vertex(2)->info().id});
  return result;
}

}  // namespace clerestory
