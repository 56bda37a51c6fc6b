#include "meshing/planar_regions.h"

#include <algorithm>

#include "meshing/cells.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// A line as one group sees it.
struct Use {
  std::uint32_t a, b, group;
  bool parts;  ///< the group shows different sheets on its two sides, or nothing on one
};

struct GroupResult {
  std::vector<Use> uses;
  std::vector<Point2> crossings;  ///< where CGAL found lines crossing after all; ids from kCrossing on
};
constexpr std::uint32_t kCrossing = 0x80000000;

GroupResult see(const FaceComplex& complex, const PlaneGroup& group, std::uint32_t g,
                std::span<const Material> materials, std::span<const Line> lines) {
  GroupResult result;
  // A face alone with its own edges needs no triangulation to know them.
  if (group.faces.size() == 1 && lines.size() == 3) {
    for (const Line& l : lines) result.uses.push_back({l.a, l.b, g, true});
    return result;
  }
  std::vector<std::array<std::uint32_t, 2>> ends;
  for (const Line& l : lines) ends.push_back({l.a, l.b});
  Cdt cdt;
  draw(cdt, group.plane, complex.vertices, ends, {});
  const Covering covering(complex, group, materials);
  mark_sheets(cdt, covering);
  for (const auto v : cdt.finite_vertex_handles())
    if (v->info().id == kNoVertex) {
      v->info().id = kCrossing + static_cast<std::uint32_t>(result.crossings.size());
      result.crossings.push_back({v->point().x(), v->point().y()});
    }
  for (const auto& [f, i] : cdt.constrained_edges()) {
    const int here = f->info().mark, there = f->neighbor(i)->info().mark;
    if (here == kOutside && there == kOutside) continue;
    std::uint32_t a = f->vertex(cdt.cw(i))->info().id, b = f->vertex(cdt.ccw(i))->info().id;
    if (a > b) std::swap(a, b);
    result.uses.push_back({a, b, g, here != there});
  }
  return result;
}

/// Distinct lines with the groups that use them.
struct Graph {
  struct Edge {
    std::uint32_t a, b;
    std::vector<std::uint32_t> groups;
    bool crosses_a_region;
  };
  std::vector<Edge> edges;
};

Graph needed_lines(std::vector<Use>& uses) {
  std::sort(uses.begin(), uses.end(), [](const Use& x, const Use& y) {
    return std::array{x.a, x.b, x.group} < std::array{y.a, y.b, y.group};
  });
  Graph graph;
  for (std::size_t k = 0; k < uses.size();) {
    Graph::Edge edge{uses[k].a, uses[k].b, {}, false};
    bool parts = false;
    std::size_t end = k;
    for (; end < uses.size() && uses[end].a == edge.a && uses[end].b == edge.b; ++end) {
      if (edge.groups.empty() || edge.groups.back() != uses[end].group) edge.groups.push_back(uses[end].group);
      parts |= uses[end].parts;
      edge.crosses_a_region |= !uses[end].parts;
    }
    if (parts || edge.groups.size() > 1) graph.edges.push_back(std::move(edge));
    k = end;
  }
  return graph;
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  return length(cross(p - a, d)) / length(d);
}

/// Joins edges that follow each other in a straight line and are used by the same groups.
void straighten(const FaceComplex& complex, Graph& graph) {
  std::vector<std::array<std::uint32_t, 2>> at;  // vertex, edge
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    at.push_back({graph.edges[e].a, e});
    at.push_back({graph.edges[e].b, e});
  }
  std::sort(at.begin(), at.end());
  const auto range = [&](std::uint32_t v) {
    return std::pair(std::lower_bound(at.begin(), at.end(), std::array{v, 0u}),
                     std::lower_bound(at.begin(), at.end(), std::array{v + 1, 0u}));
  };
  const auto other_end = [&](std::uint32_t e, std::uint32_t v) {
    return graph.edges[e].a == v ? graph.edges[e].b : graph.edges[e].a;
  };
  /// The edge that goes on straight after e at v, or none.
  constexpr std::uint32_t kStop = 0xffffffff;
  const auto next = [&](std::uint32_t e, std::uint32_t v) -> std::uint32_t {
    const auto [begin, end] = range(v);
    if (end - begin != 2) return kStop;
    const std::uint32_t n = (*begin)[1] == e ? (*(begin + 1))[1] : (*begin)[1];
    if (graph.edges[n].groups != graph.edges[e].groups) return kStop;
    const Vec3 a = complex.vertices[other_end(e, v)], b = complex.vertices[v], c = complex.vertices[other_end(n, v)];
    if (dot(b - a, c - b) <= 0) return kStop;
    const double tolerance =
        std::min(complex.allowed.contact, complex.allowed.local_share * std::min(length(b - a), length(c - b)));
    return distance_to_line(b, a, c) <= tolerance ? n : kStop;
  };

  std::vector<bool> done(graph.edges.size());
  std::vector<Graph::Edge> joined;
  const auto walk = [&](std::uint32_t e, std::uint32_t from) {
    std::uint32_t start = from, v = other_end(e, from);
    std::vector<std::uint32_t> passed;
    Graph::Edge edge = graph.edges[e];
    const auto finish = [&](std::uint32_t end) {
      joined.push_back({std::min(start, end), std::max(start, end), edge.groups, edge.crosses_a_region});
      start = end;
      passed.clear();
    };
    done[e] = true;
    for (std::uint32_t n = next(e, v); n != kStop && !done[n]; n = next(n, v)) {
      const std::uint32_t w = other_end(n, v);
      passed.push_back(v);
      // The whole of what is passed must stay on the line.
      const bool straight = w != start && std::all_of(passed.begin(), passed.end(), [&](std::uint32_t p) {
                              return distance_to_line(complex.vertices[p], complex.vertices[start],
                                                      complex.vertices[w]) <= complex.allowed.contact;
                            });
      if (!straight) finish(v);
      edge.crosses_a_region |= graph.edges[n].crosses_a_region;
      done[n] = true;
      v = w;
    }
    finish(v);
  };
  // From where lines end or meet; what is left are loops without a corner.
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e) {
    if (done[e]) continue;
    if (next(e, graph.edges[e].a) == kStop)
      walk(e, graph.edges[e].a);
    else if (next(e, graph.edges[e].b) == kStop)
      walk(e, graph.edges[e].b);
  }
  for (std::uint32_t e = 0; e < graph.edges.size(); ++e)
    if (!done[e]) walk(e, graph.edges[e].a);
  graph.edges = std::move(joined);
}

}  // namespace

std::vector<PlanarDomain> join_planar_regions(FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                              std::span<const Material> materials, Drawing drawing,
                                              MeshReport& report) {
  std::vector<Use> uses;
  // A second look is needed only where CGAL's exact arithmetic found a crossing that the tolerances had missed.
  for (int look = 0; look < 3; ++look) {
    std::vector<std::size_t> begin_of(groups.size() + 1, drawing.lines.size());
    for (std::size_t k = drawing.lines.size(); k-- > 0;) begin_of[drawing.lines[k].group] = k;
    for (std::size_t g = groups.size(); g-- > 0;) begin_of[g] = std::min(begin_of[g], begin_of[g + 1]);
    std::vector<GroupResult> seen(groups.size());
    parallel_for(groups.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t g = begin; g < end; ++g)
        seen[g] = see(complex, groups[g], static_cast<std::uint32_t>(g), materials,
                      std::span(drawing.lines).subspan(begin_of[g], begin_of[g + 1] - begin_of[g]));
    });
    uses.clear();
    bool crossed = false;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto base = static_cast<std::uint32_t>(complex.vertices.size());
      for (const Point2& p : seen[g].crossings) complex.add_vertex(groups[g].plane.lift(p), complex.allowed.contact);
      crossed |= !seen[g].crossings.empty();
      for (Use u : seen[g].uses) {
        if (u.a >= kCrossing) u.a = base + (u.a - kCrossing);
        if (u.b >= kCrossing) u.b = base + (u.b - kCrossing);
        if (u.a > u.b) std::swap(u.a, u.b);
        uses.push_back(u);
      }
    }
    if (!crossed) break;
    drawing.lines.clear();
    for (const Use& u : uses) drawing.lines.push_back({u.group, u.a, u.b});
    std::sort(drawing.lines.begin(), drawing.lines.end());
    split_at_vertices(complex, drawing);
  }

  Graph graph = needed_lines(uses);
  straighten(complex, graph);
  std::vector<PlanarDomain> domains(groups.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g) domains[g].group = g;
  std::vector<bool> used(complex.vertices.size());
  for (const Graph::Edge& e : graph.edges) {
    for (const std::uint32_t g : e.groups) domains[g].lines.push_back({e.a, e.b});
    used[e.a] = used[e.b] = true;
    if (e.crosses_a_region && e.groups.size() > 1) ++report.imprinted_contacts;
  }
  for (const auto& [g, v] : drawing.points)
    if (used[v]) domains[g].points.push_back(v);
  std::erase_if(domains, [](const PlanarDomain& d) { return d.lines.empty(); });
  return domains;
}

}  // namespace clerestory
