#include "meshing/fine_parts.h"

#include <algorithm>

#include "solver/model/box_tree.h"
#include "solver/model/disjoint_sets.h"

namespace clerestory {
namespace {

std::uint32_t group_of(DisjointSets& groups, std::size_t face) { return static_cast<std::uint32_t>(groups.find(face)); }

bool only_reflects(const Material& m) { return m.receives() && !m.scatters_through() && m.sides == 2 && !m.emits(); }

/// Joins faces over their edges, and says which vertices are ends of rims.
std::vector<bool> join_over_edges(const FaceComplex& complex, DisjointSets& groups) {
  struct Edge {
    std::uint32_t surface, material, low, high, face;
    bool falls;  ///< the face goes from high to low
    auto operator<=>(const Edge&) const = default;
    bool is_same(const Edge& e) const {
      return surface == e.surface && material == e.material && low == e.low && high == e.high;
    }
  };
  std::vector<Edge> edges;
  edges.reserve(3 * complex.faces.size());
  for (std::uint32_t f = 0; f < complex.faces.size(); ++f)
    for (std::size_t k = 0; k < 3; ++k) {
      const Face& face = complex.faces[f];
      const std::uint32_t a = face.corner[k], b = face.corner[(k + 1) % 3];
      edges.push_back({face.surface.value, face.material.value, std::min(a, b), std::max(a, b), f, a > b});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<bool> on_rim(complex.vertices.size());
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k + 1;
    while (end < edges.size() && edges[end].is_same(edges[k])) ++end;
    if (end == k + 2 && edges[k].falls != edges[k + 1].falls)
      groups.join(edges[k].face, edges[k + 1].face);
    else
      on_rim[edges[k].low] = on_rim[edges[k].high] = true;
    k = end;
  }
  return on_rim;
}

bool is_narrow(const FaceComplex& complex, const Face& face, double narrow) {
  const Vec3 &a = complex.vertices[face.corner[0]], &b = complex.vertices[face.corner[1]],
             &c = complex.vertices[face.corner[2]];
  return length(cross(b - a, c - a)) < narrow * std::max({length(b - a), length(c - b), length(a - c)});
}

/// Holds the edges that narrow facets of other groups come near: where fine parts lie in each other, as a handle's
/// bar in its bends, each would cut the other into splinters if it changed.
void hold_where_groups_meet(const FaceComplex& complex, DisjointSets& groups,
                            std::span<const std::uint32_t> narrow_faces, double near, std::vector<bool>& held) {
  const auto box_of = [&](std::uint32_t i) {
    Box box;
    for (const std::uint32_t v : complex.faces[narrow_faces[i]].corner) box.add(complex.vertices[v]);
    return box;
  };
  const BoxTree tree(narrow_faces.size(), box_of);
  using Range = std::array<std::uint32_t, 2>;  // of groups
  const std::vector<Range> range = tree.by_node(
      [&](std::uint32_t i) {
        const std::uint32_t g = group_of(groups, narrow_faces[i]);
        return Range{g, g};
      },
      [](const Range& a, const Range& b) {
        return Range{std::min(a[0], b[0]), std::max(a[1], b[1])};
      });
  for (const std::uint32_t f : narrow_faces) {
    const std::uint32_t g = group_of(groups, f);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = complex.faces[f].corner[k], w = complex.faces[f].corner[(k + 1) % 3];
      bool met = held[v] && held[w];
      tree.visit_if(
          [&](const Box& box) {
            return !met && box.grown(near).touches_segment(complex.vertices[v], complex.vertices[w]);
          },
          [&](std::uint32_t i) { met = met || group_of(groups, narrow_faces[i]) != g; },
          [&](std::size_t node) {
            return range[node] != Range{g, g};
          });
      if (met) held[v] = held[w] = true;
    }
  }
}

}  // namespace

std::vector<FinePart> fine_parts(const FaceComplex& complex, std::span<const Material> materials, double narrow) {
  const std::size_t n = complex.faces.size();
  DisjointSets groups(n);
  std::vector<bool> held = join_over_edges(complex, groups), is_fine(n);
  constexpr std::uint32_t kNone = Face::kNone;
  std::vector<std::uint32_t> owner(complex.vertices.size(), kNone), part_of(n, kNone), narrow_faces;
  for (std::uint32_t f = 0; f < n; ++f) {
    const Face& face = complex.faces[f];
    const std::uint32_t g = group_of(groups, f);
    if (is_narrow(complex, face, narrow)) {
      narrow_faces.push_back(f);
      if (only_reflects(materials[face.material.value])) is_fine[g] = true;
    }
    for (const std::uint32_t v : face.corner) {
      if (owner[v] == kNone) owner[v] = g;
      if (owner[v] != g) held[v] = true;
    }
  }

  hold_where_groups_meet(complex, groups, narrow_faces, narrow, held);

  std::vector<FinePart> parts;
  for (std::uint32_t f = 0; f < n; ++f) {
    const std::uint32_t g = group_of(groups, f);
    if (!is_fine[g]) continue;
    if (part_of[g] == kNone) {
      part_of[g] = static_cast<std::uint32_t>(parts.size());
      parts.emplace_back();
    }
    FinePart& part = parts[part_of[g]];
    part.faces.push_back(f);
    for (const std::uint32_t v : complex.faces[f].corner)
      if (held[v]) part.held_vertices.push_back(v);
  }
  for (FinePart& part : parts) {
    auto& vertices = part.held_vertices;
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  }
  return parts;
}

}  // namespace clerestory
