#include "meshing/make_lightmap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
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
  std::vector<std::vector<Facing>> facings(map.position.size());
  for (std::uint32_t p = 0; p < patches.patch_count(); ++p) {
    const auto x = patches.corner_positions(PatchId{p});
    const Vec3 centroid = (x[0] + x[1] + x[2]) / 3;
    for (std::size_t k = 0; k < 3; ++k) {
      auto& around = facings[map.corners[p][k]];
      auto facing = std::find_if(around.begin(), around.end(),
                                 [&](const Facing& f) { return dot(f.normal, patches.normal[p]) > kAlike; });
      if (facing == around.end()) facing = around.insert(around.end(), Facing{patches.normal[p], {}, 0, 0});
      facing->weight += angle_at(x, k);
      if (dot(facing->normal, patches.normal[p]) < kInPlane) continue;
      facing->inward += centroid - x[k];
      ++facing->in_plane;
    }
  }
  map.sample_begin = {0};
  for (std::size_t i = 0; i < facings.size(); ++i) {
    double sum = 0;
    for (const Facing& f : facings[i]) sum += f.weight;
    for (const Facing& f : facings[i]) {
      map.sample_position.push_back(map.position[i] + f.inward * (kWayToCentroid / f.in_plane));
      map.sample_normal.push_back(f.normal);
      map.sample_weight.push_back(sum > 0 ? f.weight / sum : 1.0 / static_cast<double>(facings[i].size()));
    }
    map.sample_begin.push_back(static_cast<std::uint32_t>(map.sample_position.size()));
  }
}

}  // namespace

VertexLightmap make_lightmap(const PatchSet& patches, double crease_deg) {
  if (!patches.splits.empty())
    throw std::logic_error("make_lightmap: halved patches have ElementMesh::leaf_lightmap()");
  const std::size_t triangles = patches.triangle_count(), count = patches.patch_count();
  constexpr std::uint32_t kNone = VertexLightmap::kNone;
  VertexLightmap map;
  map.neighbour.assign(count, {kNone, kNone, kNone});
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles);
  for (std::uint32_t t = 0; t < triangles; ++t)
    for (std::uint8_t k = 0; k < 3; ++k) {
      const std::uint32_t a = patches.corners[t][k].value, b = patches.corners[t][(k + 1u) % 3u].value;
      edges.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& x, const HalfEdge& y) {
    return x.low != y.low ? x.low < y.low : x.high != y.high ? x.high < y.high : x.triangle < y.triangle;
  });

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

void average_to_points(const PatchSet& patches, const Field& patch_E, VertexLightmap& lightmap) {
  lightmap.E = Field(lightmap.position.size(), patch_E.channels);
  std::vector<double> area(lightmap.position.size());
  for (std::size_t p = 0; p < patches.patch_count(); ++p)
    for (const std::uint32_t point : lightmap.corners[p]) {
      lightmap.E.add(point, patch_E[p] * patches.area[p]);
      area[point] += patches.area[p];
    }
  for (std::size_t i = 0; i < area.size(); ++i)
    for (int k = 0; k < patch_E.channels; ++k) lightmap.E.at(i, k) /= area[i];
}

}  // namespace clerestory
