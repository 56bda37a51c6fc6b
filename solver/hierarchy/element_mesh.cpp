#include "solver/hierarchy/element_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/hierarchy/leaves_behind.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kNone = VertexLightmap::kNone;

/// Order of edges by length; ends decide between equal ones, so that both elements at an edge agree.
struct EdgeKey {
  double length2;
  std::uint32_t low, high;
  friend auto operator<=>(const EdgeKey&, const EdgeKey&) = default;
};

EdgeKey edge_key(const std::vector<Vec3>& vertices, std::uint32_t a, std::uint32_t b) {
  const auto [low, high] = std::minmax(a, b);
  const Vec3 d = vertices[high] - vertices[low];
  return {dot(d, d), low, high};
}

}  // namespace

ElementMesh::ElementMesh(const PatchSet& patches, VertexLightmap map)
    : patches_(patches),
      vertices_(patches.vertices),
      points_(std::move(map)),
      first_middle_(points_.position.size()),
      leaf_count_(patches.patch_count()) {
  elements_.resize(patches.patch_count());
  for (std::uint32_t p = 0; p < elements_.size(); ++p) {
    Element& e = elements_[p];
    const auto& c = patches.corners[patches.triangle[p]];
    const bool front = patches.side[p] == kFront;
    e.vertex = {c[0].value, c[front ? 1 : 2].value, c[front ? 2 : 1].value};
    e.point = points_.corners[p];
    e.neighbour = points_.neighbour[p];
    e.patch = p;
    find_longest_edge(e);
  }
  points_.corners = {}, points_.neighbour = {}, points_.E = {};
  // Both must agree that they meet, or halving would wait for one that never comes.
  std::vector<std::pair<std::uint32_t, std::size_t>> alone;
  for (std::uint32_t p = 0; p < elements_.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t q = elements_[p].neighbour[k];
      if (q == kNone) continue;
      const std::size_t back = edge_towards(q, elements_[p].vertex[(k + 1) % 3], elements_[p].vertex[k]);
      if (back == 3 || elements_[q].neighbour[back] != p) alone.emplace_back(p, k);
    }
  for (const auto& [p, k] : alone) elements_[p].neighbour[k] = kNone;
}

std::array<Vec3, 3> ElementMesh::corner_positions(std::size_t e) const {
  const auto& v = elements_[e].vertex;
  return {vertices_[v[0]], vertices_[v[1]], vertices_[v[2]]};
}

double ElementMesh::edge_length(std::size_t e, std::size_t k) const {
  const auto& v = elements_[e].vertex;
  return length(vertices_[v[(k + 1) % 3]] - vertices_[v[k]]);
}

void ElementMesh::find_longest_edge(Element& e) const {
  EdgeKey longest = edge_key(vertices_, e.vertex[0], e.vertex[1]);
  e.edge = 0;
  for (std::uint8_t k = 1; k < 3; ++k)
    if (const EdgeKey key = edge_key(vertices_, e.vertex[k], e.vertex[(k + 1u) % 3]); key > longest)
      longest = key, e.edge = k;
}

std::size_t ElementMesh::edge_towards(std::uint32_t element, std::uint32_t from, std::uint32_t to) const {
  const auto& v = elements_[element].vertex;
  for (std::size_t k = 0; k < 3; ++k)
    if (v[k] == from && v[(k + 1) % 3] == to) return k;
  return 3;
}

void ElementMesh::split(std::span<const std::uint32_t> marked) {
  std::vector<std::uint32_t> path;
  for (const std::uint32_t e : marked) {
    path.assign(1, e);
    while (!path.empty()) {
      const std::uint32_t at = path.back();
      const Element& here = elements_[at];
      if (!here.is_leaf()) {  // halved on the way to another
        path.pop_back();
        continue;
      }
      const std::uint32_t next = here.neighbour[here.edge];
      const bool waits = next != kNone && edge_towards(next, here.vertex[(here.edge + 1u) % 3],
                                                       here.vertex[here.edge]) != elements_[next].edge;
      if (waits) {
        path.push_back(next);
      } else {
        halve_with_neighbour(at);
        path.pop_back();
      }
    }
  }
}

void ElementMesh::halve_with_neighbour(std::uint32_t element) {
  const Element e = elements_[element];
  const std::size_t k = e.edge, next = (k + 1) % 3;
  const std::uint32_t other = e.neighbour[k];
  const Vec3 middle = (vertices_[e.vertex[k]] + vertices_[e.vertex[next]]) / 2;
  const auto vertex = static_cast<std::uint32_t>(vertices_.size());
  vertices_.push_back(middle);
  if (other == kNone) {
    halve(element, vertex, add_point(element, kNone, middle));
    return;
  }
  const Element q = elements_[other];
  const bool smooth = q.point[q.edge] == e.point[next] && q.point[(q.edge + 1u) % 3] == e.point[k];
  const std::uint32_t point = add_point(element, smooth ? other : kNone, middle);
  const std::uint32_t point_there = smooth ? point : add_point(other, kNone, middle);
  halve(element, vertex, point);
  halve(other, vertex, point_there);
  const std::uint32_t a = elements_[element].first_half, b = elements_[other].first_half;
  // The neighbour's edge runs the other way: its second half lies at our first.
  elements_[a].neighbour[0] = b + 1, elements_[b + 1].neighbour[0] = a;
  elements_[a + 1].neighbour[0] = b, elements_[b].neighbour[0] = a + 1;
}

/// The halves' neighbours across the halved edge are left to the caller.
void ElementMesh::halve(std::uint32_t element, std::uint32_t vertex, std::uint32_t point) {
  const Element e = elements_[element];
  const std::size_t start = e.edge, end = (start + 1) % 3, apex = (start + 2) % 3;
  const auto first = static_cast<std::uint32_t>(elements_.size()), second = first + 1;
  Element half = e;
  half.level = static_cast<std::uint8_t>(e.level + 1);
  half.vertex = {e.vertex[start], vertex, e.vertex[apex]};
  half.point = {e.point[start], point, e.point[apex]};
  half.neighbour = {kNone, second, e.neighbour[apex]};
  find_longest_edge(half);
  elements_.push_back(half);
  half.vertex = {vertex, e.vertex[end], e.vertex[apex]};
  half.point = {point, e.point[end], e.point[apex]};
  half.neighbour = {kNone, e.neighbour[end], first};
  find_longest_edge(half);
  elements_.push_back(half);
  elements_[element].first_half = first;
  ++leaf_count_;
  const auto now_meets = [&](std::uint32_t neighbour, std::size_t edge, std::uint32_t whom) {
    if (neighbour == kNone) return;
    const std::size_t k = edge_towards(neighbour, e.vertex[(edge + 1) % 3], e.vertex[edge]);
    if (k < 3) elements_[neighbour].neighbour[k] = whom;
  };
  now_meets(e.neighbour[apex], apex, first);
  now_meets(e.neighbour[end], end, second);
}

std::uint32_t ElementMesh::add_point(std::uint32_t element, std::uint32_t other, const Vec3& middle) {
  constexpr double kAlike = 0.99;  // as for the lightmap's own points
  constexpr double kWayToCentroid = 2e-3;
  const Element& e = elements_[element];
  const auto point = static_cast<std::uint32_t>(points_.position.size());
  points_.position.push_back(middle);
  points_.patch_of_point.push_back(e.patch);
  ends_.push_back({e.point[e.edge], e.point[(e.edge + 1u) % 3]});
  const auto sample = [&](const Element& facet, double weight) {
    const Vec3 to_centroid = (vertices_[facet.vertex[(facet.edge + 2u) % 3]] - middle) / 3;
    points_.sample_position.push_back(middle + to_centroid * kWayToCentroid);
    points_.sample_normal.push_back(patches_.normal[facet.patch]);
    points_.sample_weight.push_back(weight);
  };
  const bool bent = other != kNone && dot(patches_.normal[e.patch], patches_.normal[elements_[other].patch]) < kAlike;
  sample(e, bent ? 0.5 : 1);
  if (bent) sample(elements_[other], 0.5);
  points_.sample_begin.push_back(static_cast<std::uint32_t>(points_.sample_position.size()));
  return point;
}

std::vector<std::uint32_t> ElementMesh::leaves() const {
  std::vector<std::uint32_t> leaves, stack;
  leaves.reserve(leaf_count_);
  for (std::uint32_t p = 0; p < patches_.patch_count(); ++p) {
    stack.assign(1, p);
    while (!stack.empty()) {
      const std::uint32_t e = stack.back();
      stack.pop_back();
      if (elements_[e].is_leaf()) {
        leaves.push_back(e);
      } else {
        stack.push_back(elements_[e].first_half + 1);
        stack.push_back(elements_[e].first_half);
      }
    }
  }
  return leaves;
}

std::size_t ElementMesh::leaves_under(std::uint32_t e) const {
  const std::uint32_t first = elements_[e].first_half;
  return elements_[e].is_leaf() ? 1 : leaves_under(first) + leaves_under(first + 1);
}

PatchSet ElementMesh::leaf_patches() const {
  const std::vector<std::uint32_t> leaf = leaves();
  const std::size_t n = leaf.size();
  PatchSet out;
  out.origin = patches_.origin;
  out.channels = patches_.channels;
  out.vertices = vertices_;
  out.materials = patches_.materials;
  out.surfaces = patches_.surfaces;
  out.side_patch = patches_.side_patch;
  out.splits.resize(elements_.size());
  for (std::size_t e = 0; e < elements_.size(); ++e)
    out.splits[e] = {elements_[e].first_half, SplitNode::kNone, elements_[e].edge};
  out.corners.resize(n), out.side_material.resize(n), out.side_surface.resize(n);
  out.triangle.resize(n), out.side.resize(n), out.area.resize(n), out.normal.resize(n);
  out.level.resize(n);
  if (!patches_.joined.empty()) out.joined.resize(n);
  out.rho = out.M = Field(n, patches_.channels);
  for (std::size_t i = 0; i < n; ++i) {
    const Element& e = elements_[leaf[i]];
    const TriangleId t = patches_.triangle[e.patch];
    const Side side = patches_.side[e.patch];
    const bool front = side == kFront;
    out.splits[leaf[i]].patch = static_cast<std::uint32_t>(i);
    out.corners[i] = {VertexId{std::size_t{e.vertex[0]}}, VertexId{std::size_t{e.vertex[front ? 1 : 2]}},
                      VertexId{std::size_t{e.vertex[front ? 2 : 1]}}};
    out.side_material[i] = patches_.side_material[t];
    out.side_surface[i] = patches_.side_surface[t];
    if (!out.joined.empty()) out.joined[i] = patches_.joined[t];
    out.triangle[i] = TriangleId{i};
    out.side[i] = side;
    out.area[i] = std::ldexp(patches_.area[e.patch], -e.level);  // halves are halves
    out.normal[i] = patches_.normal[e.patch];
    out.level[i] = e.level;
    out.rho.set(i, patches_.rho[e.patch]);
    out.M.set(i, patches_.M[e.patch]);
  }
  std::vector<std::uint32_t> patch_of_leaf(n);
  for (std::size_t i = 0; i < n; ++i) patch_of_leaf[i] = elements_[leaf[i]].patch;
  find_leaves_behind(patches_, patch_of_leaf, out);
  return out;
}

VertexLightmap ElementMesh::leaf_lightmap() && {
  const std::vector<std::uint32_t> leaf = leaves();
  std::vector<std::uint32_t> number(elements_.size(), kNone);
  for (std::uint32_t i = 0; i < leaf.size(); ++i) number[leaf[i]] = i;
  VertexLightmap map = std::move(points_);
  map.corners.resize(leaf.size());
  map.neighbour.resize(leaf.size());
  for (std::uint32_t i = 0; i < leaf.size(); ++i) {
    const Element& e = elements_[leaf[i]];
    map.corners[i] = e.point;
    for (std::size_t k = 0; k < 3; ++k) {
      map.neighbour[i][k] = e.neighbour[k] == kNone ? kNone : number[e.neighbour[k]];
      map.patch_of_point[e.point[k]] = i;
    }
  }
  map.E = Field(map.position.size(), patches_.channels);
  return map;
}

}  // namespace clerestory
