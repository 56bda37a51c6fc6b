#include "meshing/make_lightmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include "meshing/patch_mesh.h"
#include "solver/model/box.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kNone = VertexLightmap::kNone;

struct TriangleEdge {
  std::uint32_t low, high;  ///< vertices
  std::uint32_t triangle;
  std::uint8_t from;  ///< corner where the edge starts, in the triangle's order
  bool ascending;     ///< runs from low to high in the triangle's order
};

/// A triangle as seen along an edge.
struct Blade {
  double angle;  ///< around the edge, counter-clockwise seen against its direction from low to high
  const TriangleEdge* edge;
};

/// Front sides look counter-clockwise around an edge that runs up, else clockwise.
Side side_towards(const TriangleEdge& e, bool counter_clockwise) {
  return e.ascending == counter_clockwise ? kFront : kBack;
}

/// The edge of the patch on one side of e's triangle, counted by the patch's corners.
std::size_t edge_of_patch(const TriangleEdge& e, Side side) { return side == kFront ? e.from : 2u - e.from; }

double angle_at(const std::array<Vec3, 3>& x, std::size_t k) {
  const Vec3 e = x[(k + 1) % 3] - x[k], f = x[(k + 2) % 3] - x[k];
  return std::atan2(length(cross(e, f)), dot(e, f));
}

/// Of all triangles, sorted by their ends, then by triangle.
std::vector<TriangleEdge> triangle_edges(const PatchSet& patches) {
  std::vector<std::uint32_t> next(patches.vertices.size() + 1, 0);
  const auto each = [&](const auto& take) {
    for (std::uint32_t t = 0; t < patches.triangle_count(); ++t)
      for (std::uint8_t k = 0; k < 3; ++k) {
        const std::uint32_t a = patches.corners[t][k].value, b = patches.corners[t][(k + 1u) % 3u].value;
        take(TriangleEdge{std::min(a, b), std::max(a, b), t, k, a < b});
      }
  };
  each([&](const TriangleEdge& e) { ++next[e.low + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<TriangleEdge> edges(3 * patches.triangle_count());
  each([&](const TriangleEdge& e) { edges[next[e.low]++] = e; });
  const auto at = [&](std::uint32_t i) { return edges.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t v = 0; v + 1 < next.size(); ++v)  // next[v] has moved on to the end of v's edges
    std::sort(at(v > 0 ? next[v - 1] : 0), at(next[v]), [](const TriangleEdge& x, const TriangleEdge& y) {
      return x.high != y.high ? x.high < y.high : x.triangle < y.triangle;
    });
  return edges;
}

/// Corner k of patch p, in the patch's order.
struct Corner {
  std::uint32_t p, k;
};

/// A facet as seen from a point in its corner.
struct FacetAtPoint {
  Vec3 first, second;  ///< the edges that it lies between, counter-clockwise
  double angle;        ///< between them

  Vec3 to_centroid() const { return (first + second) / 3; }
  /// The lower one over the two edges [m].
  double height() const {
    const double longer = std::sqrt(std::max(dot(first, first), dot(second, second)));
    return longer > 0 ? length(cross(first, second)) / longer : 0;
  }
  bool holds(const Vec3& d, const Vec3& n) const {
    return dot(cross(first, d), n) >= 0 && dot(cross(d, second), n) >= 0 && dot(d, first + second) > 0;
  }
};

/// Facets around a point that face nearly the same way.
struct Facing {
  Vec3 normal;                         ///< of the first of them
  std::vector<FacetAtPoint> in_plane;  ///< those in the first one's plane
  double weight = 0;                   ///< angle at the point

  /// A little into the surface: towards the mean of the facets' centroids where that is on one of them. Where the
  /// surface goes most of the way around a corner of something else, the mean may be inside of that; then towards the
  /// widest facet's centroid. least_way: share of it.
  Vec3 inward(double least_way, double off_edges) const {
    Vec3 mean;
    for (const FacetAtPoint& f : in_plane) mean += f.to_centroid();
    mean = mean / static_cast<double>(in_plane.size());
    const auto on = std::ranges::find_if(in_plane, [&](const FacetAtPoint& f) { return f.holds(mean, normal); });
    const auto widest = std::ranges::max_element(in_plane, {}, &FacetAtPoint::angle);
    const FacetAtPoint& facet = on != in_plane.end() ? *on : *widest;
    return (on != in_plane.end() ? mean : facet.to_centroid()) *
           std::max(least_way, VertexLightmap::way_inside(facet.height(), off_edges));
  }
};

/// Whether something ends just off patch p's side over its edge k.
bool is_outline(const PatchSet& patches, std::uint32_t p, std::size_t k) {
  if (patches.outlines.empty()) return false;
  const Side side = patches.side[p];
  return patches.outlines[patches.triangle[p]][side] >> (side == kFront ? k : 2 - k) & 1;
}

/// Samples of the last point, around which the given corners lie. They stay in the plane of a facet, whose own normal
/// they take: moved towards the mean of all facets' centroids, a point of a convex edge would sink under the surface.
void place_samples(const PatchSet& patches, std::span<const Corner> around, std::vector<Facing>& facings,
                   VertexLightmap& map) {
  constexpr double kInPlane = 1 - 5e-9;  // 1e-4 rad
  facings.clear();
  double way = VertexLightmap::kWayToCentroid;
  for (const auto& [p, k] : around) {
    if (is_outline(patches, p, k) || is_outline(patches, p, (k + 2u) % 3u)) way = VertexLightmap::kWayFromOutline;
    const Vec3 normal = patches.normal[p];
    const auto x = patches.corner_positions(PatchId{std::size_t{p}});
    auto facing = std::find_if(facings.begin(), facings.end(),
                               [&](const Facing& f) { return dot(f.normal, normal) > VertexLightmap::kAlike; });
    if (facing == facings.end()) facing = facings.insert(facings.end(), Facing{normal, {}, 0});
    const double angle = angle_at(x, k);
    facing->weight += angle;
    if (dot(facing->normal, normal) < kInPlane) continue;
    facing->in_plane.push_back({x[(k + 1) % 3] - x[k], x[(k + 2) % 3] - x[k], angle});
  }
  double sum = 0;
  for (const Facing& f : facings) sum += f.weight;
  for (const Facing& f : facings) {
    map.sample_position.push_back(map.position.back() + f.inward(way, map.off_edges));
    map.sample_normal.push_back(f.normal);
    map.sample_weight.push_back(sum > 0 ? f.weight / sum : 1.0 / static_cast<double>(facings.size()));
  }
  map.sample_begin.push_back(static_cast<std::uint32_t>(map.sample_position.size()));
}

/// Over each edge, the patch met first in the order of the triangles around it.
std::vector<std::array<std::uint32_t, 3>> find_neighbours(const PatchSet& patches) {
  std::vector<std::array<std::uint32_t, 3>> neighbour(patches.patch_count(), {kNone, kNone, kNone});
  const std::vector<TriangleEdge> edges = triangle_edges(patches);
  std::vector<Blade> blades;
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) ++end;
    const Vec3 low = patches.vertices[edges[begin].low];
    const Frame around(normalized(patches.vertices[edges[begin].high] - low));
    blades.clear();
    for (std::size_t k = begin; k < end; ++k) {
      const Vec3 apex = patches.vertices[patches.corners[edges[k].triangle][(edges[k].from + 2u) % 3u]] - low;
      blades.push_back({std::atan2(dot(apex, around.b), dot(apex, around.t)), &edges[k]});
    }
    std::stable_sort(blades.begin(), blades.end(), [](const Blade& a, const Blade& b) { return a.angle < b.angle; });
    for (std::size_t k = 0; k < blades.size(); ++k) {
      const TriangleEdge &here = *blades[k].edge, &next = *blades[(k + 1) % blades.size()].edge;
      const Side side = side_towards(here, true), next_side = side_towards(next, false);
      const PatchId p = patches.side_patch[here.triangle][side], q = patches.side_patch[next.triangle][next_side];
      if (!p.valid() || !q.valid()) continue;
      neighbour[p][edge_of_patch(here, side)] = q.value;
      neighbour[q][edge_of_patch(next, next_side)] = p.value;
    }
    begin = end;
  }
  return neighbour;
}

/// The corner that a half-edge leaves.
Corner corner_at(OpenMesh::SmartHalfedgeHandle out) {
  const auto first = out.face().halfedge();
  return {static_cast<std::uint32_t>(out.face().idx()), out == first ? 0u : out == first.next() ? 1u : 2u};
}

/// Where the surface does not go on smoothly, or light does not.
bool is_crease(const PatchSet& patches, OpenMesh::SmartEdgeHandle edge, double least_cosine) {
  if (edge.is_boundary()) return true;
  const Corner from = corner_at(edge.h0());
  const PatchId p{static_cast<std::size_t>(edge.h0().face().idx())},
      q{static_cast<std::size_t>(edge.h1().face().idx())};
  // At a rim a sheet's front and its back meet.
  return patches.triangle[p] == patches.triangle[q] || patches.material(p) != patches.material(q) ||
         dot(patches.normal[p], patches.normal[q]) < least_cosine || is_outline(patches, from.p, from.k);
}

/// Corners that share a point, by patch: those between the creases on either side of the corner that `out` leaves.
void corners_between_creases(const OpenMesh::EProp<bool>& crease, OpenMesh::SmartHalfedgeHandle out,
                             std::vector<Corner>& corners) {
  corners.clear();
  const auto given = out;
  while (!crease[out.edge()]) {
    out = out.opp().next();
    if (out == given) break;  // smooth all around
  }
  const auto first = out;
  do {
    corners.push_back(corner_at(out));
    if (crease[out.prev().edge()]) break;
    out = out.prev().opp();
  } while (out != first);
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.p < b.p; });
}

/// Points, in the order in which patches and the corners of their triangles first ask for one, and their samples.
void place_points(const PatchSet& patches, double crease_deg, VertexLightmap& map) {
  const PatchMesh mesh = join_patches(patches, map.neighbour);
  OpenMesh::EProp<bool> crease(mesh);
  const double least_cosine = std::cos(crease_deg * std::numbers::pi / 180);
  for (const auto edge : mesh.edges()) crease[edge] = is_crease(patches, edge, least_cosine);

  map.corners.assign(patches.patch_count(), {kNone, kNone, kNone});
  map.sample_begin = {0};
  std::vector<Corner> around;
  std::vector<Facing> facings;
  for (std::uint32_t p = 0; p < patches.patch_count(); ++p) {
    const auto edge = OpenMesh::make_smart(mesh.face_handle(p), mesh).halfedge();
    const bool front = patches.side[p] == kFront;
    for (const auto out : {edge, front ? edge.next() : edge.prev(), front ? edge.prev() : edge.next()}) {
      const std::uint32_t corner = corner_at(out).k;
      if (map.corners[p][corner] != kNone) continue;
      corners_between_creases(crease, out, around);
      for (const auto& [q, k] : around) map.corners[q][k] = static_cast<std::uint32_t>(map.position.size());
      map.position.push_back(patches.corner_positions(PatchId{std::size_t{p}})[corner]);
      map.patch_of_point.push_back(p);
      place_samples(patches, around, facings, map);
    }
  }
}

double diagonal_of(const PatchSet& patches) {
  Box box;
  for (const Vec3& v : patches.vertices) box.add(v);
  return patches.vertices.empty() ? 0 : length(box.upper - box.lower);
}

}  // namespace

VertexLightmap make_lightmap(const PatchSet& patches, double crease_deg) {
  if (!patches.splits.empty())
    throw std::logic_error("make_lightmap: halved patches have ElementMesh::leaf_lightmap()");
  VertexLightmap map;
  map.neighbour = find_neighbours(patches);
  map.off_edges = VertexLightmap::kOffEdges * diagonal_of(patches);
  place_points(patches, crease_deg, map);
  map.E = Field(map.position.size(), patches.channels);
  return map;
}

}  // namespace clerestory
