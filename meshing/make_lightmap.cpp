#include "meshing/make_lightmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "solver/model/disjoint_sets.h"

namespace clerestory {
namespace {

/// Corner k of patch p is 3 p + k, counted as the triangle's corners are, whichever side p is.
using Corner = std::uint32_t;

struct HalfEdge {
  std::uint32_t low, high;  ///< vertices
  std::uint32_t triangle;
  std::uint8_t from;  ///< corner where the edge starts, in the triangle's order
  bool ascending;     ///< runs from low to high in the triangle's order
};

/// A triangle as seen along an edge.
struct Blade {
  double angle;  ///< around the edge, counter-clockwise seen against its direction from low to high
  const HalfEdge* edge;
};

/// Front sides look counter-clockwise around an edge that runs up, else clockwise.
Side side_towards(const HalfEdge& e, bool counter_clockwise) {
  return e.ascending == counter_clockwise ? kFront : kBack;
}

/// The edge of the patch on one side of e's triangle, counted by the patch's corners.
std::size_t edge_of_patch(const HalfEdge& e, Side side) { return side == kFront ? e.from : 2u - e.from; }

double angle_at(const std::array<Vec3, 3>& x, std::size_t k) {
  const Vec3 e = x[(k + 1) % 3] - x[k], f = x[(k + 2) % 3] - x[k];
  return std::atan2(length(cross(e, f)), dot(e, f));
}

/// Of all triangles, sorted by their ends, then by triangle.
std::vector<HalfEdge> half_edges(const PatchSet& patches) {
  std::vector<std::uint32_t> next(patches.vertices.size() + 1, 0);
  const auto each = [&](const auto& take) {
    for (std::uint32_t t = 0; t < patches.triangle_count(); ++t)
      for (std::uint8_t k = 0; k < 3; ++k) {
        const std::uint32_t a = patches.corners[t][k].value, b = patches.corners[t][(k + 1u) % 3u].value;
        take(HalfEdge{std::min(a, b), std::max(a, b), t, k, a < b});
      }
  };
  each([&](const HalfEdge& e) { ++next[e.low + 1]; });
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<HalfEdge> edges(3 * patches.triangle_count());
  each([&](const HalfEdge& e) { edges[next[e.low]++] = e; });
  const auto at = [&](std::uint32_t i) { return edges.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t v = 0; v + 1 < next.size(); ++v)  // next[v] has moved on to the end of v's edges
    std::sort(at(v > 0 ? next[v - 1] : 0), at(next[v]), [](const HalfEdge& x, const HalfEdge& y) {
      return x.high != y.high ? x.high < y.high : x.triangle < y.triangle;
    });
  return edges;
}

/// Facets around a point that face nearly the same way.
struct Facing {
  Vec3 normal;  ///< of the first of them
  Vec3 inward;  ///< sum of the ways to the centroids of those in the first one's plane
  int in_plane = 0;
  double weight = 0;  ///< angle at the point
};

/// Samples lie in the plane of a facet, whose own normal they take: moved towards the mean of all facets' centroids, a
/// point of a convex edge would sink under the surface.
void place_samples(const PatchSet& patches, VertexLightmap& map) {
  constexpr double kAlike = 0.99;          // cosine of 8 degrees: turning a facet so far changes E by little
  constexpr double kInPlane = 1 - 5e-9;    // 1e-4 rad
  constexpr double kWayToCentroid = 2e-3;  // far enough from edges for single precision rays, too near to be seen
  const std::size_t points = map.position.size(), count = patches.patch_count();
  // Corners by point, in the order of the patches.
  std::vector<std::uint32_t> begin_at(points + 1, 0), at(3 * count);
  for (const auto& c : map.corners)
    for (const std::uint32_t point : c) ++begin_at[point];
  std::partial_sum(begin_at.begin(), begin_at.end(), begin_at.begin());
  for (std::size_t p = count; p-- > 0;)
    for (std::size_t k = 3; k-- > 0;) at[--begin_at[map.corners[p][k]]] = static_cast<std::uint32_t>(3 * p + k);

  map.sample_begin.reserve(points + 1);
  map.sample_begin = {0};
  map.sample_position.reserve(points);
  map.sample_normal.reserve(points);
  map.sample_weight.reserve(points);
  std::vector<Facing> facings;
  for (std::size_t i = 0; i < points; ++i) {
    facings.clear();
    for (std::uint32_t c = begin_at[i]; c < begin_at[i + 1]; ++c) {
      const PatchId p{std::size_t{at[c] / 3}};
      const auto x = patches.corner_positions(p);
      const std::size_t k = at[c] % 3;
      auto facing = std::find_if(facings.begin(), facings.end(),
                                 [&](const Facing& f) { return dot(f.normal, patches.normal[p]) > kAlike; });
      if (facing == facings.end()) facing = facings.insert(facings.end(), Facing{patches.normal[p], {}, 0, 0});
      facing->weight += angle_at(x, k);
      if (dot(facing->normal, patches.normal[p]) < kInPlane) continue;
      facing->inward += (x[0] + x[1] + x[2]) / 3 - x[k];
      ++facing->in_plane;
    }
    double sum = 0;
    for (const Facing& f : facings) sum += f.weight;
    for (const Facing& f : facings) {
      map.sample_position.push_back(map.position[i] + f.inward * (kWayToCentroid / f.in_plane));
      map.sample_normal.push_back(f.normal);
      map.sample_weight.push_back(sum > 0 ? f.weight / sum : 1.0 / static_cast<double>(facings.size()));
    }
    map.sample_begin.push_back(static_cast<std::uint32_t>(map.sample_position.size()));
  }
}

}  // namespace

VertexLightmap make_lightmap(const PatchSet& patches, double crease_deg) {
  if (!patches.splits.empty())
    throw std::logic_error("make_lightmap: halved patches have ElementMesh::leaf_lightmap()");
  const std::size_t count = patches.patch_count();
  constexpr std::uint32_t kNone = VertexLightmap::kNone;
  VertexLightmap map;
  map.neighbour.assign(count, {kNone, kNone, kNone});
  std::vector<HalfEdge> edges = half_edges(patches);
  const double least_cosine = std::cos(crease_deg * std::numbers::pi / 180);
  DisjointSets shared(3 * count);
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
      const HalfEdge &here = *blades[k].edge, &next = *blades[(k + 1) % blades.size()].edge;
      const Side side = side_towards(here, true), next_side = side_towards(next, false);
      const PatchId p = patches.side_patch[here.triangle][side], q = patches.side_patch[next.triangle][next_side];
      if (!p.valid() || !q.valid()) continue;
      map.neighbour[p][edge_of_patch(here, side)] = q.value;
      map.neighbour[q][edge_of_patch(next, next_side)] = p.value;
      // One blade alone has a rim: its front and its back meet there and do not go on smoothly.
      if (blades.size() == 1 || patches.material(p) != patches.material(q) ||
          dot(patches.normal[p], patches.normal[q]) < least_cosine)
        continue;
      const auto corner = [&](PatchId patch, const HalfEdge& e, bool at_low) -> Corner {
        const bool at_start = at_low == e.ascending;
        return 3 * patch.value + (at_start ? e.from : (e.from + 1u) % 3u);
      };
      shared.join(corner(p, here, true), corner(q, next, true));
      shared.join(corner(p, here, false), corner(q, next, false));
    }
    begin = end;
  }

  edges = {};
  map.corners.resize(count);
  std::vector<std::uint32_t> point_of(3 * count, kNone);
  for (std::uint32_t p = 0; p < count; ++p) {
    const TriangleId t = patches.triangle[p];
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = patches.vertices[patches.corners[t][k]];
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t& point = point_of[shared.find(3 * p + k)];
      if (point == kNone) {
        point = static_cast<std::uint32_t>(map.position.size());
        map.position.push_back(x[k]);
        map.patch_of_point.push_back(p);
      }
      // Seen from the back the corners run the other way.
      const std::uint32_t place = patches.side[p] == kFront ? k : (3 - k) % 3;
      map.corners[p][place] = point;
    }
  }
  place_samples(patches, map);
  map.E = Field(map.position.size(), patches.channels);
  return map;
}

}  // namespace clerestory
