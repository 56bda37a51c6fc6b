#pragma once
// CGAL's constrained Delaunay triangulation as this folder uses it. Include from .cpp files only: it is heavy.

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <unordered_map>
#include <vector>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include "meshing/surface_complex.h"

namespace clerestory {

inline constexpr std::uint32_t kNoVertex = 0xffffffff;
inline constexpr int kUnmarked = -2, kOutside = -1;

struct CdtVertex {
  std::uint32_t id = kNoVertex;  ///< of the vertex in the complex; kNoVertex where two constraints crossed
};
struct CdtFace {
  int mark = kUnmarked;  ///< what the face belongs to: kOutside or the index of a sheet
};

using CdtKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CdtVertexBase = CGAL::Triangulation_vertex_base_with_info_2<CdtVertex, CdtKernel>;
using CdtFaceBase = CGAL::Triangulation_face_base_with_info_2<CdtFace, CdtKernel,
                                                              CGAL::Constrained_triangulation_face_base_2<CdtKernel>>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    CdtKernel, CGAL::Triangulation_data_structure_2<CdtVertexBase, CdtFaceBase>, CGAL::Exact_predicates_tag>;

/// Points along a Hilbert curve: each is then found near the one before, wherever they lie.
inline void sort_by_place(std::span<std::pair<CdtKernel::Point_2, CdtVertex>> points) {
  using Traits =
      CGAL::Spatial_sort_traits_adapter_2<CdtKernel,
                                          CGAL::First_of_pair_property_map<std::pair<CdtKernel::Point_2, CdtVertex>>>;
  CGAL::hilbert_sort(points.begin(), points.end(), Traits());
  // A triangle first: as long as all lie on a line, each is looked for along it from its end.
  const auto bring_forward = [&](std::size_t place, const auto& is_wanted) {
    const auto found = std::find_if(points.begin() + static_cast<std::ptrdiff_t>(place), points.end(),
                                    [&](const auto& p) { return is_wanted(p.first); });
    if (found != points.end()) std::swap(points[place], *found);
  };
  bring_forward(1, [&](const auto& p) { return p != points[0].first; });
  bring_forward(2, [&](const auto& p) { return !CGAL::collinear(points[0].first, points[1].first, p); });
}

/// Draws points and lines of a plane into a triangulation, ids in ascending order so that the result is always the
/// same.
inline std::unordered_map<std::uint32_t, Cdt::Vertex_handle> draw(Cdt& cdt, const Plane& plane,
                                                                  const std::vector<Vec3>& vertices,
                                                                  std::span<const std::array<std::uint32_t, 2>> lines,
                                                                  const std::vector<std::uint32_t>& points) {
  std::vector<std::uint32_t> ids(points);
  for (const auto& l : lines) ids.insert(ids.end(), l.begin(), l.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  std::vector<std::pair<CdtKernel::Point_2, CdtVertex>> drawn;
  for (const std::uint32_t id : ids) {
    const Point2 p = plane.flatten(vertices[id]);
    drawn.push_back({{p.x, p.y}, {id}});
  }
  std::unordered_map<std::uint32_t, Cdt::Vertex_handle> handle;
  Cdt::Face_handle near;
  constexpr std::size_t kMany = 20'000;  // rows of points, one after the other, cost the square of their length
  if (drawn.size() > kMany) sort_by_place(drawn);
  for (const auto& [point, info] : drawn) {
    const Cdt::Vertex_handle v = cdt.insert(point, near);
    if (v->info().id == kNoVertex) v->info() = info;
    near = v->face();
    handle[info.id] = v;
  }
  for (const auto& l : lines)
    if (handle[l[0]] != handle[l[1]]) cdt.insert_constraint(handle[l[0]], handle[l[1]]);
  return handle;
}

/// Marks every cell, a set of faces that constraints enclose: mark_of(largest) gives the mark from the cell's largest
/// face. Faces outside of the convex hull are kOutside.
template <class MarkOf>
void mark_cells(Cdt& cdt, const MarkOf& mark_of) {
  for (const auto f : cdt.all_face_handles()) f->info().mark = cdt.is_infinite(f) ? kOutside : kUnmarked;
  std::vector<Cdt::Face_handle> cell;
  for (const auto seed : cdt.finite_face_handles()) {
    if (seed->info().mark != kUnmarked) continue;
    cell.assign(1, seed);
    seed->info().mark = kOutside;
    Cdt::Face_handle largest = seed;
    double largest_area = 0;
    bool open = false;
    for (std::size_t k = 0; k < cell.size(); ++k) {
      const Cdt::Face_handle f = cell[k];
      const double area = cdt.triangle(f).area();
      if (area > largest_area) {
        largest_area = area;
        largest = f;
      }
      for (int i = 0; i < 3; ++i) {
        if (cdt.is_constrained({f, i})) continue;
        const Cdt::Face_handle g = f->neighbor(i);
        if (cdt.is_infinite(g)) open = true;
        if (g->info().mark != kUnmarked) continue;
        g->info().mark = kOutside;
        cell.push_back(g);
      }
    }
    const int mark = open ? kOutside : mark_of(largest);
    for (const auto f : cell) f->info().mark = mark;
  }
}

}  // namespace clerestory
