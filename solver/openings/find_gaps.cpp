#include "solver/openings/find_gaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <ranges>
#include <utility>

#include "solver/geometry/polygon.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

// By judgement: bounds on work in models that are not buildings, and tolerances above the rounding of model files.
constexpr double kSamePlane = 1e-4;         ///< sine of the angle between normals
constexpr double kStraight = 1e-4;          ///< sine of the angle between edges that continue each other
constexpr std::size_t kMostEdges = 20'000;  ///< rims that are tried, the longest
constexpr std::size_t kMostPlanes = 3000;   ///< surfaces that are looked for in each other's planes, those of most rim
constexpr std::size_t kMostSteps = 1000;    ///< around one loop
constexpr std::size_t kMostAtVertex = 32;   ///< free edges at one vertex that are walked along
constexpr std::size_t kMostOfPlane = 5000;  ///< rims of a plane, else it is not searched for strips
constexpr double kLeastLifts = 10;          ///< width of a strip: rays know what is narrower too badly
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// An edge of a plane surface beyond which its plane goes on as air; the surface lies to the left of a -> b.
struct Rim {
  std::uint32_t a, b;
};

/// Triangles of one plane that hang together.
struct Sheet {
  Vec3 normal;
  double offset;
  std::vector<Rim> rims;
  double rim_length = 0;
};

struct EdgeUse {
  std::uint32_t low, high, triangle, apex;
  friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
};

std::vector<EdgeUse> opaque_edges(const PatchSet& patches) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * patches.triangle_count());
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    if (patches.front_material(TriangleId{t}).lets_rays_pass()) continue;
    const auto& c = patches.corners[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = c[k].value, b = c[(k + 1) % 3].value;
      uses.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), c[(k + 2) % 3].value});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

Vec3 normal_of(const PatchSet& patches, std::size_t t) {
  const auto& c = patches.corners[t];
  const Vec3 a = patches.vertices[c[0]];
  return normalized(cross(patches.vertices[c[1]] - a, patches.vertices[c[2]] - a));
}

/// Whether triangle `other` continues the plane of the first one beyond their common edge.
bool continues(const PatchSet& patches, const EdgeUse& one, const EdgeUse& other) {
  const Vec3 n = normal_of(patches, one.triangle), m = normal_of(patches, other.triangle);
  if (length(cross(n, m)) > kSamePlane) return false;
  const Vec3 a = patches.vertices[VertexId{std::size_t{one.low}}],
             along = patches.vertices[VertexId{std::size_t{one.high}}] - a;
  const Vec3 away = cross(along, n);
  return dot(away, patches.vertices[VertexId{std::size_t{one.apex}}] - a) *
             dot(away, patches.vertices[VertexId{std::size_t{other.apex}}] - a) <
         0;
}

/// An edge that one triangle has alone.
struct FreeEdge {
  std::uint32_t a, b, sheet;  ///< sheet: a number that its surface has to itself
};

std::vector<Sheet> find_sheets(const PatchSet& patches, std::vector<FreeEdge>& free) {
  const std::vector<EdgeUse> uses = opaque_edges(patches);
  DisjointSets joined(patches.triangle_count());
  std::vector<EdgeUse> rims;
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first;
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) ++last;
    for (std::size_t i = first; i < last; ++i) {
      bool ends = true;
      for (std::size_t j = first; j < last; ++j)
        if (j != i && continues(patches, uses[i], uses[j])) {
          joined.join(uses[i].triangle, uses[j].triangle);
          ends = false;
        }
      if (ends) rims.push_back(uses[i]);
    }
    if (last == first + 1) free.push_back({uses[first].low, uses[first].high, uses[first].triangle});
    first = last;
  }
  for (FreeEdge& edge : free) edge.sheet = static_cast<std::uint32_t>(joined.find(edge.sheet));
  std::vector<std::uint32_t> sheet_of(patches.triangle_count(), 0xffffffff);
  std::vector<Sheet> sheets;
  for (const EdgeUse& rim : rims) {
    const std::size_t t = joined.find(rim.triangle);
    if (sheet_of[t] == 0xffffffff) {
      sheet_of[t] = static_cast<std::uint32_t>(sheets.size());
      const Vec3 n = normal_of(patches, t);
      sheets.push_back({n, dot(n, patches.vertices[patches.corners[t][0]]), {}});
    }
    Sheet& sheet = sheets[sheet_of[t]];
    if (!(length(sheet.normal) > 0.5)) continue;  // of a triangle without area
    const Vec3 a = patches.vertices[VertexId{std::size_t{rim.low}}],
               b = patches.vertices[VertexId{std::size_t{rim.high}}];
    const bool left = dot(cross(b - a, patches.vertices[VertexId{std::size_t{rim.apex}}] - a), sheet.normal) > 0;
    sheet.rims.push_back(left ? Rim{rim.low, rim.high} : Rim{rim.high, rim.low});
    sheet.rim_length += length(b - a);
  }
  std::erase_if(sheets, [](const Sheet& s) { return s.rims.empty(); });
  std::stable_sort(sheets.begin(), sheets.end(),
                   [](const Sheet& a, const Sheet& b) { return a.rim_length > b.rim_length; });
  return sheets;
}

/// Rims that follow each other; closed when the last leads to the first.
struct Chain {
  std::vector<std::uint32_t> vertex;
  bool closed = false;
};

/// Chains end where more than one rim goes on.
std::vector<Chain> chains_of(const Sheet& sheet) {
  std::vector<Rim> by_start = sheet.rims;
  std::sort(by_start.begin(), by_start.end(),
            [](const Rim& x, const Rim& y) { return x.a < y.a || (x.a == y.a && x.b < y.b); });
  const auto starting_at = [&](std::uint32_t v) {
    return std::ranges::equal_range(by_start, v, {}, [](const Rim& r) { return r.a; });
  };
  std::vector<std::uint32_t> ends;
  for (const Rim& r : by_start) ends.push_back(r.b);
  std::sort(ends.begin(), ends.end());
  const auto goes_on = [&](std::uint32_t v) {
    return starting_at(v).size() == 1 && std::ranges::equal_range(ends, v).size() == 1;
  };
  std::vector<bool> used(by_start.size(), false);
  std::vector<Chain> chains;
  const auto follow = [&](std::size_t first) {
    Chain chain;
    chain.vertex.push_back(by_start[first].a);
    for (std::size_t r = first;;) {
      used[r] = true;
      const std::uint32_t v = by_start[r].b;
      if (v == chain.vertex.front()) {
        chain.closed = goes_on(v);
        if (!chain.closed) chain.vertex.push_back(v);
        break;
      }
      chain.vertex.push_back(v);
      if (!goes_on(v)) break;
      r = static_cast<std::size_t>(starting_at(v).begin() - by_start.begin());
      if (used[r]) break;
    }
    chains.push_back(std::move(chain));
  };
  for (std::size_t r = 0; r < by_start.size(); ++r)
    if (!used[r] && !goes_on(by_start[r].a)) follow(r);
  for (std::size_t r = 0; r < by_start.size(); ++r)
    if (!used[r]) follow(r);
  return chains;
}

std::vector<Vec3> without_straight_corners(const PatchSet& patches, const Chain& chain) {
  const std::size_t n = chain.vertex.size();
  const auto at = [&](std::size_t k) { return patches.vertices[VertexId{std::size_t{chain.vertex[k % n]}}]; };
  std::vector<Vec3> corners;
  for (std::size_t k = 0; k < n; ++k) {
    const bool end = !chain.closed && (k == 0 || k + 1 == n);
    const Vec3 before = normalized(at(k) - at(k + n - 1)), after = normalized(at(k + 1) - at(k));
    if (end || length(cross(before, after)) > kStraight || dot(before, after) < 0) corners.push_back(at(k));
  }
  return corners;
}

/// Plane loops of free edges of several surfaces: where a whole wall is missing.
class LoopFinder {
 public:
  LoopFinder(const PatchSet& patches, std::vector<FreeEdge> edges) : patches_(patches), edges_(std::move(edges)) {
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      for (const std::uint32_t v : {edges_[e].a, edges_[e].b}) at_vertex_.emplace_back(v, e);
    std::sort(at_vertex_.begin(), at_vertex_.end());
  }

  std::vector<Gap> find() {
    std::vector<Gap> gaps;
    for (std::size_t first = 0; first < at_vertex_.size() && steps_left_ > 0;) {
      const std::uint32_t v = at_vertex_[first].first;
      std::size_t last = first;
      while (last < at_vertex_.size() && at_vertex_[last].first == v) ++last;
      const std::size_t some = std::min(last, first + kMostAtVertex);
      for (std::size_t i = first; i < some; ++i)
        for (std::size_t j = first; j < i; ++j) walk(v, at_vertex_[i].second, at_vertex_[j].second, gaps);
      first = last;
    }
    return gaps;
  }

 private:
  Vec3 place(std::uint32_t v) const { return patches_.vertices[VertexId{std::size_t{v}}]; }
  std::uint32_t other_end(std::uint32_t e, std::uint32_t v) const {
    return edges_[e].a == v ? edges_[e].b : edges_[e].a;
  }
  Vec3 along(std::uint32_t e, std::uint32_t from) const { return normalized(place(other_end(e, from)) - place(from)); }

  /// Goes from v along `out` in the plane of both edges, until it comes back along `back`.
  void walk(std::uint32_t v, std::uint32_t back, std::uint32_t out, std::vector<Gap>& gaps) {
    if (edges_[back].sheet == edges_[out].sheet) return;
    const Vec3 normal = cross(along(out, v), along(back, v));
    if (length(normal) < 0.01) return;
    const Vec3 n = normalized(normal);
    Chain chain{{v}, true};
    std::uint32_t at = other_end(out, v);
    for (std::uint32_t edge = out; at != v; --steps_left_) {
      if (steps_left_ == 0 || chain.vertex.size() > kMostSteps) return;  // a circle that v is not part of
      // A loop is met at each of its corners: the smallest may start it.
      if (at < v && is_corner(at)) return;
      chain.vertex.push_back(at);
      const auto next = std::ranges::find_if(around(at), [&](const auto& use) {
        return use.second != edge && std::abs(dot(along(use.second, at), n)) < kSamePlane;
      });
      if (next == around(at).end()) return;
      edge = next->second;
      at = other_end(edge, at);
      if (at == v && edge != back) return;
    }
    std::vector<Vec3> corners = without_straight_corners(patches_, chain);
    if (corners.size() >= 3) gaps.push_back({std::move(corners), true});
  }
  std::ranges::subrange<std::vector<std::pair<std::uint32_t, std::uint32_t>>::const_iterator> around(
      std::uint32_t v) const {
    return std::ranges::equal_range(at_vertex_, v, {}, [](const auto& use) { return use.first; });
  }
  bool is_corner(std::uint32_t v) const {
    const auto uses = around(v);
    return uses.size() == 2 && edges_[uses[0].second].sheet != edges_[uses[1].second].sheet &&
           length(cross(along(uses[0].second, v), along(uses[1].second, v))) > 0.01;
  }

  const PatchSet& patches_;
  std::vector<FreeEdge> edges_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at_vertex_;  ///< vertex, edge; sorted
  std::size_t steps_left_ = 2'000'000;
};

struct Segment {
  Vec3 a, b;
};

/// Straight rims of a plane; air is to the right of a -> b.
struct PlaneRims {
  const Sheet* sheet;
  std::vector<Segment> edges;
  std::vector<std::uint32_t> same_plane;  ///< numbers of others in the same plane
};

class StripFinder {
 public:
  StripFinder(const RayScene& rays, const std::vector<PlaneRims>& planes) : rays_(rays), planes_(planes) {}

  /// Strips along one edge, up to four.
  std::vector<Gap> along(std::size_t plane, const Segment& edge) const {
    std::vector<Gap> gaps;
    const Vec3 out = cross(normalized(edge.b - edge.a), planes_[plane].sheet->normal);
    divide(plane, edge, out, 2, gaps);
    return gaps;
  }

 private:
  void divide(std::size_t plane, const Segment& edge, const Vec3& out, int divisions, std::vector<Gap>& gaps) const {
    const auto at = [&](double s) { return edge.a + (edge.b - edge.a) * s; };
    constexpr double kInset = 0.01;
    const double w0 = free_way(plane, at(kInset), out), w1 = free_way(plane, at(1 - kInset), out),
                 middle = free_way(plane, at(0.5), out);
    const double most = std::max({w0, w1, middle}), least = kLeastLifts * rays_.lift();
    if (!(most > least)) return;
    if (std::isfinite(most) && std::min({w0, w1, middle}) > rays_.lift() &&
        std::abs(middle - (w0 + w1) / 2) < std::max(1e-3 * most, rays_.lift())) {
      const double slope = (w1 - w0) / (1 - 2 * kInset);
      const double at_a = std::max(0.0, w0 - kInset * slope), at_b = std::max(0.0, w1 + kInset * slope);
      gaps.push_back({{edge.a, edge.b, edge.b + out * at_b, edge.a + out * at_a}, false});
    } else if (divisions > 0) {
      divide(plane, {edge.a, at(0.5)}, out, divisions - 1, gaps);
      divide(plane, {at(0.5), edge.b}, out, divisions - 1, gaps);
    }
  }

  /// How far air reaches from x along d within the plane; infinite where nothing ends it [m].
  double free_way(std::size_t plane, const Vec3& x, const Vec3& d) const {
    const double lift = rays_.lift();
    double nearest = rays_.first_surface({x + d * lift, d}) + lift;
    const Vec3 n = planes_[plane].sheet->normal;
    const auto look_at = [&](const PlaneRims& other) {
      for (const Segment& e : other.edges) {
        const Vec3 along = e.b - e.a;
        const double across = dot(cross(d, along), n);
        if (std::abs(across) < 1e-9 * length(along)) continue;
        const double t = dot(cross(e.a - x, along), n) / across, s = dot(cross(e.a - x, d), n) / across;
        if (t > lift && t < nearest && s > -1e-9 && s < 1 + 1e-9) nearest = t;
      }
    };
    look_at(planes_[plane]);
    for (const std::uint32_t other : planes_[plane].same_plane) look_at(planes_[other]);
    return nearest;
  }

  const RayScene& rays_;
  const std::vector<PlaneRims>& planes_;
};

void find_same_planes(std::vector<PlaneRims>& planes, double tolerance) {
  const std::size_t count = std::min(planes.size(), kMostPlanes);
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = 0; j < i; ++j) {
      const Sheet &a = *planes[i].sheet, &b = *planes[j].sheet;
      const double same = dot(a.normal, b.normal);
      if (std::abs(same) < 1 - 1e-8 || std::abs(a.offset - (same > 0 ? b.offset : -b.offset)) > tolerance) continue;
      planes[i].same_plane.push_back(j), planes[j].same_plane.push_back(i);
    }
}

}  // namespace

std::vector<Gap> find_gaps(const PatchSet& patches, const RayScene& rays) {
  std::vector<FreeEdge> free;
  const std::vector<Sheet> sheets = find_sheets(patches, free);
  std::vector<Gap> gaps = LoopFinder(patches, std::move(free)).find();
  std::vector<PlaneRims> planes;
  struct Try {
    std::size_t plane;
    Segment edge;
  };
  std::vector<Try> tries;
  for (const Sheet& sheet : sheets) {
    PlaneRims plane{&sheet, {}, {}};
    for (const Chain& chain : chains_of(sheet)) {
      std::vector<Vec3> corners = without_straight_corners(patches, chain);
      const bool is_hole = chain.closed && corners.size() >= 3 && dot(vector_area(corners), sheet.normal) < 0;
      for (std::size_t k = 0; k + (chain.closed ? 0 : 1) < corners.size(); ++k) {
        const Segment edge{corners[k], corners[(k + 1) % corners.size()]};
        plane.edges.push_back(edge);
        if (!is_hole && sheet.rims.size() <= kMostOfPlane) tries.push_back({planes.size(), edge});
      }
      if (is_hole) gaps.push_back({std::move(corners), true});
    }
    planes.push_back(std::move(plane));
  }
  find_same_planes(planes, 1e-6 * rays.diameter());
  std::stable_sort(tries.begin(), tries.end(), [](const Try& a, const Try& b) {
    return length(a.edge.b - a.edge.a) > length(b.edge.b - b.edge.a);
  });
  tries.resize(std::min(tries.size(), kMostEdges));
  std::vector<std::vector<Gap>> strips(tries.size());
  const StripFinder finder(rays, planes);
  parallel_for(tries.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) strips[k] = finder.along(tries[k].plane, tries[k].edge);
  });
  for (auto& found : strips) std::ranges::move(found, std::back_inserter(gaps));
  return gaps;
}

}  // namespace clerestory
