#include "meshing/planar_regions.h"

#include <algorithm>
#include <numeric>

#include "meshing/cells.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

/// A line as one group sees it.
struct Use {
  std::uint32_t a, b, group;
  bool parts;  ///< the group shows different sheets on its two sides, or nothing on one
  std::uint8_t outline = kNoOutline;
};

struct GroupResult {
  std::vector<Use> uses;
  std::vector<Point2> crossings;  ///< where CGAL found lines crossing after all; ids from kCrossing on
};
constexpr std::uint32_t kCrossing = 0x80000000;

GroupResult see(const FaceComplex& complex, const PlaneGroup& group, std::uint32_t g,
                std::span<const Material> materials, std::span<const Line> lines,
                std::span<const OutlineLine> outlines) {
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
    for (const bool above : {false, true})
      if (std::binary_search(outlines.begin(), outlines.end(), OutlineLine{{g, a, b}, above}))
        result.uses.back().outline |= above ? kOutlineAbove : kOutlineBelow;
  }
  return result;
}

std::span<const OutlineLine> outlines_of(const Drawing& drawing, std::uint32_t group) {
  const auto found = std::ranges::equal_range(drawing.outlines, group, {}, [](auto& o) { return o.line.group; });
  return {found.begin(), found.end()};
}

/// Distinct lines with the groups that use them.
struct Graph {
  struct Edge {
    std::uint32_t a, b;
    std::uint32_t first_use, use_count;  ///< in `uses`
    bool crosses_a_region;
  };
  std::vector<Use> uses;
  std::vector<Edge> edges;
  std::span<const Use> uses_of(const Edge& e) const { return std::span(uses).subspan(e.first_use, e.use_count); }
  bool have_same_groups(const Edge& e, const Edge& f) const {
    const auto x = uses_of(e), y = uses_of(f);
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](auto& u, auto& v) { return u.group == v.group && u.outline == v.outline; });
  }
};

Graph needed_lines(std::vector<Use> all) {
  std::sort(all.begin(), all.end(), [](const Use& x, const Use& y) {
    return std::array{x.a, x.b, x.group} < std::array{y.a, y.b, y.group};
  });
  Graph graph;
  std::size_t kept = 0;  // uses of needed lines, one a group, move to the front
  for (std::size_t k = 0; k < all.size();) {
    Graph::Edge edge{all[k].a, all[k].b, static_cast<std::uint32_t>(kept), 0, false};
    bool needed = false;
    for (; k < all.size() && all[k].a == edge.a && all[k].b == edge.b; ++k) {
      needed |= all[k].parts || all[k].outline != kNoOutline;
      edge.crosses_a_region |= !all[k].parts;
      if (edge.use_count == 0 || all[kept - 1].group != all[k].group) {
        all[kept++] = all[k];
        ++edge.use_count;
      }
    }
    if (needed || edge.use_count > 1)
      graph.edges.push_back(edge);
    else
      kept = edge.first_use;
  }
  all.resize(kept);
  graph.uses = std::move(all);
  return graph;
}

double distance_to_line(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  return length(cross(p - a, d)) / length(d);
}

/// Joins edges that follow each other in a straight line and are used by the same groups.
void straighten(const FaceComplex& complex, Graph& graph) {
  // Edges at each vertex.
  std::vector<std::uint32_t> begin_at(complex.vertices.size() + 1, 0), at(2 * graph.edges.size());
  for (const Graph::Edge& e : graph.edges) {
    ++begin_at[e.a];
    ++begin_at[e.b];
  }
  std::partial_sum(begin_at.begin(), begin_at.end(), begin_at.begin());
  for (std::uint32_t e = static_cast<std::uint32_t>(graph.edges.size()); e-- > 0;) {
    at[--begin_at[graph.edges[e].a]] = e;
    at[--begin_at[graph.edges[e].b]] = e;
  }
  const auto other_end = [&](std::uint32_t e, std::uint32_t v) {
    return graph.edges[e].a == v ? graph.edges[e].b : graph.edges[e].a;
  };
  /// The edge that goes on straight after e at v, or none.
  constexpr std::uint32_t kStop = 0xffffffff;
  const auto next = [&](std::uint32_t e, std::uint32_t v) -> std::uint32_t {
    const std::uint32_t begin = begin_at[v];
    if (begin_at[v + 1] - begin != 2) return kStop;
    const std::uint32_t n = at[begin] == e ? at[begin + 1] : at[begin];
    if (!graph.have_same_groups(graph.edges[n], graph.edges[e])) return kStop;
    const Vec3 a = complex.vertices[other_end(e, v)], b = complex.vertices[v], c = complex.vertices[other_end(n, v)];
    if (dot(b - a, c - b) <= 0) return kStop;
    const double tolerance =
        std::min(complex.allowed.contact, complex.allowed.local_share * std::min(length(b - a), length(c - b)));
    return distance_to_line(b, a, c) <= tolerance ? n : kStop;
  };

  std::vector<bool> done(graph.edges.size());
  std::vector<Graph::Edge> joined;
  joined.reserve(graph.edges.size());
  std::vector<std::uint32_t> passed;
  const auto walk = [&](std::uint32_t e, std::uint32_t from) {
    std::uint32_t start = from, v = other_end(e, from);
    passed.clear();
    Graph::Edge edge = graph.edges[e];
    const auto finish = [&](std::uint32_t end) {
      joined.push_back(
          {std::min(start, end), std::max(start, end), edge.first_use, edge.use_count, edge.crosses_a_region});
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
    constexpr std::size_t kGrain = 64;
    std::vector<std::vector<GroupResult>> seen((groups.size() + kGrain - 1) / kGrain);
    uses.clear();
    uses.reserve(drawing.lines.size());
    bool crossed = false;
    // In blocks, so that what each group sees is not held for all of them at once.
    constexpr std::size_t kBlock = 1 << 10;
    for (std::size_t first = 0; first < seen.size(); first += kBlock) {
      const std::size_t last = std::min(seen.size(), first + kBlock);
      parallel_for(last - first, 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t chunk = first + begin; chunk < first + end; ++chunk)
          for (std::size_t g = chunk * kGrain; g < std::min(groups.size(), (chunk + 1) * kGrain); ++g)
            seen[chunk].push_back(see(complex, groups[g], static_cast<std::uint32_t>(g), materials,
                                      std::span(drawing.lines).subspan(begin_of[g], begin_of[g + 1] - begin_of[g]),
                                      outlines_of(drawing, static_cast<std::uint32_t>(g))));
      });
      for (std::size_t chunk = first; chunk < last; ++chunk) {
        for (std::size_t k = 0; k < seen[chunk].size(); ++k) {
          const GroupResult& result = seen[chunk][k];
          const auto base = static_cast<std::uint32_t>(complex.vertices.size());
          for (const Point2& p : result.crossings)
            complex.add_vertex(groups[chunk * kGrain + k].plane.lift(p), complex.allowed.contact);
          crossed |= !result.crossings.empty();
          for (Use u : result.uses) {
            if (u.a >= kCrossing) u.a = base + (u.a - kCrossing);
            if (u.b >= kCrossing) u.b = base + (u.b - kCrossing);
            if (u.a > u.b) std::swap(u.a, u.b);
            uses.push_back(u);
          }
        }
        seen[chunk] = {};
      }
    }
    if (!crossed) break;
    drawing.lines.clear();
    for (const Use& u : uses) drawing.lines.push_back({u.group, u.a, u.b});
    std::sort(drawing.lines.begin(), drawing.lines.end());
    split_at_vertices(complex, drawing);
  }

  drawing.lines = {};
  Graph graph = needed_lines(std::move(uses));
  straighten(complex, graph);
  std::vector<PlanarDomain> domains(groups.size());
  for (std::uint32_t g = 0; g < groups.size(); ++g) domains[g].group = g;
  std::vector<bool> used(complex.vertices.size());
  for (const Graph::Edge& e : graph.edges) {
    for (const Use& u : graph.uses_of(e)) {
      PlanarDomain& domain = domains[u.group];
      domain.lines.push_back({e.a, e.b});
      if (u.outline != kNoOutline) ++report.imprinted_outlines;
      if (u.outline == kNoOutline && domain.outline.empty()) continue;
      domain.outline.resize(domain.lines.size());
      domain.outline.back() = u.outline;
    }
    used[e.a] = used[e.b] = true;
    if (e.crosses_a_region && e.use_count > 1) ++report.imprinted_contacts;
  }
  for (const auto& [g, v] : drawing.points)
    if (used[v]) domains[g].points.push_back(v);
  for (PlanarDomain& d : domains)
    if (!d.outline.empty()) d.outline.resize(d.lines.size());
  std::erase_if(domains, [](const PlanarDomain& d) { return d.lines.empty(); });
  return domains;
}

}  // namespace clerestory
