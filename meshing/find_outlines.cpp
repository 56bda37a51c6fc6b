#include "meshing/find_outlines.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "solver/model/box_tree.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

// By judgement. Elements are halved where light varies, down to an eighth of the longest edge: they find the shadow of
// what stands further off by themselves.
constexpr double kNear = 0.125;           ///< of an element: an edge further off is no end of anything at that plane
constexpr double kSteep = 0.34;           ///< sine of the angle at which a surface leaves the plane
constexpr double kLevel = 0.1;            ///< sine of the angle up to which a surface leads along the plane
constexpr double kDeep = 4;               ///< of the gap: how far the surface reaches away, at least
constexpr double kWide = 0.5;             ///< of an element: a smaller outline is that of a foot
constexpr double kShortest = 0.03;        ///< of an element: shorter edges are detail
constexpr std::size_t kMostLooks = 4000;  ///< of an edge at faces near by, on the mean; where more crowd no outline is
constexpr double kLargePlane = 0.25;      ///< of the square of an element

/// An edge and the opaque faces that have it.
struct Edge {
  std::uint32_t a, b, first_face, face_end;
};

/// The part of an edge that comes near a face.
struct Approach {
  std::uint32_t edge, group;
  Outline line;
};

class OutlineFinder {
 public:
  OutlineFinder(const FaceComplex& complex, const std::vector<PlaneGroup>& groups, std::span<const Material> materials,
                double element)
      : complex_(complex), groups_(groups), materials_(materials), element_(element), group_of_(complex.faces.size()) {
    for (std::uint32_t g = 0; g < groups.size(); ++g) {
      double area = 0;
      for (const std::uint32_t f : groups[g].faces) {
        group_of_[f] = g;
        area += area_of(f);
      }
      if (!(area >= kLargePlane * element * element)) continue;
      for (const std::uint32_t f : groups[g].faces)
        if (material_of(f).receives()) large_.push_back(f);
    }
  }

  std::vector<Outline> find() {
    if (large_.empty()) return {};
    collect_edges();
    const auto box_of = [&](std::uint32_t k) { return box_of_face(large_[k]); };
    const BoxTree large(large_.size(), box_of);
    constexpr std::size_t kGrain = 1024;
    std::vector<std::vector<Approach>> found((edges_.size() + kGrain - 1) / kGrain);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t chunk = begin; chunk < end; ++chunk) {
        std::size_t looks = 0;
        for (std::size_t e = chunk * kGrain; e < std::min(edges_.size(), (chunk + 1) * kGrain); ++e) {
          Box box;
          box.add(vertex(edges_[e].a));
          box.add(vertex(edges_[e].b));
          box = box.grown(kNear * element_);
          large.visit_if([&](const Box& b) { return looks < kMostLooks * kGrain && b.touches(box); },
                         [&](std::uint32_t k) {
                           ++looks;
                           if (const auto line = approach(edges_[e], large_[k]))
                             found[chunk].push_back({static_cast<std::uint32_t>(e), group_of_[large_[k]], *line});
                         });
        }
      }
    });
    std::vector<Approach> approaches;
    for (const auto& some : found) approaches.insert(approaches.end(), some.begin(), some.end());
    if (approaches.empty()) return {};
    keep_wide(approaches);
    const BoxTree all(complex_.faces.size(), [&](std::uint32_t f) { return box_of_face(f); });
    std::erase_if(approaches, [&](const Approach& a) { return is_covered(all, a); });
    std::vector<Outline> outlines;
    for (const Approach& a : approaches) outlines.push_back(a.line);
    add_ends(all, approaches, outlines);
    return outlines;
  }

 private:
  const Vec3& vertex(std::uint32_t v) const { return complex_.vertices[v]; }
  const Material& material_of(std::uint32_t f) const { return materials_[complex_.faces[f].material]; }
  std::array<Vec3, 3> corners(std::uint32_t f) const {
    const auto& c = complex_.faces[f].corner;
    return {vertex(c[0]), vertex(c[1]), vertex(c[2])};
  }
  double area_of(std::uint32_t f) const {
    const auto [a, b, c] = corners(f);
    return length(cross(b - a, c - a)) / 2;
  }
  Box box_of_face(std::uint32_t f) const { return Box::around(corners(f)).grown(complex_.allowed.contact / 2); }

  void collect_edges() {
    struct Use {
      std::uint32_t a, b, face;
    };
    std::vector<Use> uses;
    for (std::uint32_t f = 0; f < complex_.faces.size(); ++f) {
      if (material_of(f).lets_rays_pass()) continue;
      const auto& c = complex_.faces[f].corner;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(c[k], c[(k + 1) % 3]);
        if (length(vertex(b) - vertex(a)) >= kShortest * element_) uses.push_back({a, b, f});
      }
    }
    std::sort(uses.begin(), uses.end(),
              [](const Use& x, const Use& y) { return std::tie(x.a, x.b, x.face) < std::tie(y.a, y.b, y.face); });
    for (const Use& u : uses) {
      const auto k = static_cast<std::uint32_t>(faces_.size());
      if (edges_.empty() || edges_.back().a != u.a || edges_.back().b != u.b) edges_.push_back({u.a, u.b, k, k});
      faces_.push_back(u.face);
      edges_.back().face_end = k + 1;
    }
  }

  double tolerance_at(const Edge& e) const {
    return std::min(complex_.allowed.contact, complex_.allowed.local_share * length(vertex(e.b) - vertex(e.a)));
  }

  /// What of the edge, projected, lies in the face, if the edge is an end of something at that plane.
  std::optional<Outline> approach(const Edge& e, std::uint32_t face) const {
    const PlaneGroup& group = groups_[group_of_[face]];
    const double most = kNear * element_, tolerance = tolerance_at(e);
    const Vec3 a = vertex(e.a), b = vertex(e.b);
    const double at_a = group.plane.distance(a), at_b = group.plane.distance(b);
    if (std::min(std::abs(at_a), std::abs(at_b)) > most && at_a * at_b > 0) return std::nullopt;
    if (std::abs(at_a) <= tolerance && std::abs(at_b) <= tolerance) return std::nullopt;
    // The part that is near enough, on the side where more of it is.
    const double side = at_a + at_b > 0 ? 1 : -1;
    double from = 0, to = 1;
    const auto keep_below = [&](double at_start, double at_end) {  // where a linear value is not positive
      if (at_start > 0 && at_end > 0)
        to = -1;
      else if (at_start > 0)
        from = std::max(from, at_start / (at_start - at_end));
      else if (at_end > 0)
        to = std::min(to, at_start / (at_start - at_end));
    };
    keep_below(side * at_a - most, side * at_b - most);
    keep_below(-side * at_a, -side * at_b);
    if (!(from < to)) return std::nullopt;
    const Vec3 start = a + (b - a) * from, end = a + (b - a) * to;
    const Vec3 up = group.plane.n * side;
    const double gap = side * group.plane.distance((start + end) / 2);
    if (!(gap > tolerance) || !ends_there(e, group_of_[face], (start + end) / 2, up, gap)) return std::nullopt;
    const Vec3 along = end - start, flat = along - up * dot(along, up);
    if (length(flat) < 0.5 * length(along)) return std::nullopt;
    const auto clipped = within(face, group.plane, start - up * dot(start - group.plane.origin, up),
                                end - up * dot(end - group.plane.origin, up), tolerance);
    if (!clipped) return std::nullopt;
    return Outline{group_of_[face], *clipped, tolerance, side > 0};
  }

  /// Whether all faces at the edge lead away from a plane or along it, one of them steeply and far.
  bool ends_there(const Edge& e, std::uint32_t group, const Vec3& middle, const Vec3& up, double gap) const {
    bool stands = false;
    for (std::uint32_t k = e.first_face; k < e.face_end; ++k) {
      const std::uint32_t f = faces_[k];
      if (group_of_[f] == group) return false;
      const Vec3 along = normalized(vertex(e.b) - vertex(e.a));
      const auto& c = complex_.faces[f].corner;
      const std::uint32_t apex = c[0] != e.a && c[0] != e.b ? c[0] : c[1] != e.a && c[1] != e.b ? c[1] : c[2];
      const Vec3 to_apex = vertex(apex) - vertex(e.a);
      const double rise = dot(normalized(to_apex - along * dot(to_apex, along)), up);
      if (rise < -kLevel) return false;
      stands = stands || (rise > kSteep && reaches(group_of_[f], f, middle, up, kDeep * gap));
    }
    return stands;
  }
  /// Whether a group reaches so far from p in a direction; mostly its face there does.
  bool reaches(std::uint32_t group, std::uint32_t face, const Vec3& p, const Vec3& direction, double far) const {
    const auto does = [&](std::uint32_t f) {
      const auto c = corners(f);
      return std::any_of(c.begin(), c.end(), [&](const Vec3& x) { return dot(x - p, direction) >= far; });
    };
    return does(face) || std::any_of(groups_[group].faces.begin(), groups_[group].faces.end(), does);
  }

  /// The part of a segment in a face's plane that lies in the face.
  std::optional<std::array<Vec3, 2>> within(std::uint32_t face, const Plane& plane, const Vec3& start, const Vec3& end,
                                            double tolerance) const {
    const auto p = corners(face);
    const Vec3 n = dot(cross(p[1] - p[0], p[2] - p[0]), plane.n) > 0 ? plane.n : -plane.n;
    double from = 0, to = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 inward = normalized(cross(n, p[(k + 1) % 3] - p[k]));
      const double at_start = dot(start - p[k], inward), at_end = dot(end - p[k], inward);
      if (std::abs(at_start) <= tolerance && std::abs(at_end) <= tolerance) continue;  // along this edge
      if (at_start < 0 && at_end < 0) return std::nullopt;
      if (at_start < 0) from = std::max(from, at_start / (at_start - at_end));
      if (at_end < 0) to = std::min(to, at_start / (at_start - at_end));
    }
    if (!((to - from) * length(end - start) > tolerance)) return std::nullopt;
    return std::array{start + (end - start) * from, start + (end - start) * to};
  }

  /// Drops what hangs together in outlines that are small.
  void keep_wide(std::vector<Approach>& approaches) const {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> nodes;  // group, vertex
    for (const Approach& a : approaches)
      for (const std::uint32_t v : {edges_[a.edge].a, edges_[a.edge].b}) nodes.push_back({a.group, v});
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const auto node = [&](const Approach& a, std::uint32_t v) {
      return static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), std::pair{a.group, v}) -
                                      nodes.begin());
    };
    DisjointSets pieces(nodes.size());
    for (const Approach& a : approaches) pieces.join(node(a, edges_[a.edge].a), node(a, edges_[a.edge].b));
    std::vector<Box> extent(nodes.size());
    const auto piece = [&](const Approach& a) { return pieces.find(node(a, edges_[a.edge].a)); };
    for (const Approach& a : approaches)
      for (const Vec3& p : a.line.end) extent[piece(a)].add(p);
    std::erase_if(approaches, [&](const Approach& a) {
      const Box& box = extent[piece(a)];
      return length(box.upper - box.lower) < kWide * element_;
    });
  }

  /// Whether something lies between edge and plane, on both sides of the edge: then the plane is none of its business.
  template <class Tree>
  bool is_covered(const Tree& all, const Approach& a) const {
    const Plane& plane = groups_[a.group].plane;
    const Edge& e = edges_[a.edge];
    const Vec3 up = a.line.above ? plane.n : -plane.n, foot = (a.line.end[0] + a.line.end[1]) / 2;
    const Vec3 along = vertex(e.b) - vertex(e.a), flat = along - up * dot(along, up);
    const double t = dot(foot - vertex(e.a), flat) / dot(flat, flat);
    const double gap = dot(vertex(e.a) + along * t - foot, up), tolerance = a.line.tolerance;
    const Vec3 aside = normalized(cross(up, flat)) * std::max(4 * tolerance, std::min(gap / 2, 1e-3 * element_));
    for (const double s : {-1.0, 1.0}) {
      const Vec3 low = foot + aside * s + up * std::min(2 * tolerance, gap / 4),
                 high = foot + aside * s + up * (gap + 2 * tolerance);
      bool blocked = false;
      all.visit_if([&](const Box& box) { return !blocked && box.touches_segment(low, high); },
                   [&](std::uint32_t f) {
                     blocked = blocked ||
                               (group_of_[f] != a.group && !material_of(f).lets_rays_pass() && meets(f, low, high));
                   });
      if (!blocked) return false;
    }
    return true;
  }
  bool meets(std::uint32_t face, const Vec3& from, const Vec3& to) const {
    const auto [a, b, c] = corners(face);
    const Vec3 n = cross(b - a, c - a), d = to - from;
    const double at_from = dot(from - a, n), at_to = dot(to - a, n);
    if (at_from * at_to > 0 || at_from == at_to) return false;
    const Vec3 x = from + d * (at_from / (at_from - at_to));
    return dot(cross(b - a, x - a), n) >= 0 && dot(cross(c - b, x - b), n) >= 0 && dot(cross(a - c, x - c), n) >= 0;
  }

  /// From ends of the edges to the plane, in what surface such an end lies on.
  template <class Tree>
  void add_ends(const Tree& all, const std::vector<Approach>& approaches, std::vector<Outline>& outlines) const {
    std::vector<Outline> ends;
    std::uint32_t last_edge = 0xffffffff, last_group = 0xffffffff;
    for (const Approach& a : approaches) {
      if (a.edge == last_edge && a.group == last_group) continue;  // another face of the plane
      last_edge = a.edge, last_group = a.group;
      const Plane& near = groups_[a.group].plane;
      const Edge& e = edges_[a.edge];
      for (const auto& [v, other] : {std::pair{e.a, e.b}, std::pair{e.b, e.a}}) {
        const Vec3 end = vertex(v);
        const double off = near.distance(end), tolerance = tolerance_at(e);
        if (std::abs(off) <= tolerance || std::abs(off) > kNear * element_) continue;
        const Vec3 foot = end - near.n * off;
        all.visit_if([&](const Box& box) { return box.touches_segment(end, foot); },
                     [&](std::uint32_t f) {
                       const std::uint32_t g = group_of_[f];
                       const Plane& plane = groups_[g].plane;
                       if (g == a.group || !material_of(f).receives() || std::abs(plane.distance(end)) > tolerance ||
                           std::abs(plane.distance(foot)) > tolerance)
                         return;
                       const auto line = within(f, plane, end, foot, tolerance);
                       if (!line) return;
                       const double towards = plane.distance(vertex(other));
                       if (towards > -tolerance) ends.push_back({g, *line, tolerance, true});
                       if (towards < tolerance) ends.push_back({g, *line, tolerance, false});
                     });
      }
    }
    const auto key = [](const Outline& o) {
      const auto& [p, q] = o.end;
      return std::tuple{o.group, o.above, p.x, p.y, p.z, q.x, q.y, q.z};
    };
    std::sort(ends.begin(), ends.end(), [&](const Outline& o, const Outline& p) { return key(o) < key(p); });
    const auto last = std::unique(ends.begin(), ends.end(), [&](auto& o, auto& p) { return key(o) == key(p); });
    outlines.insert(outlines.end(), ends.begin(), last);
  }

  const FaceComplex& complex_;
  const std::vector<PlaneGroup>& groups_;
  std::span<const Material> materials_;
  double element_;
  std::vector<std::uint32_t> group_of_;
  std::vector<std::uint32_t> large_;  ///< faces of planes that are worth a line
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> faces_;  ///< by edge
};

}  // namespace

std::vector<Outline> find_outlines(const FaceComplex& complex, const std::vector<PlaneGroup>& groups,
                                   std::span<const Material> materials, double element) {
  return OutlineFinder(complex, groups, materials, element).find();
}

}  // namespace clerestory
