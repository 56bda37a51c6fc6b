#include "solver/hierarchy/shadow_edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "solver/illumination/sharp_light.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr int kInner = 3;                // points of an edge looked at between its corners
constexpr double kWayToCentroid = 2e-3;  // as for points of the lightmap: off what stands on the element's edge
constexpr double kNarrow = 0.02;         // of an edge: the least width of a penumbra on it ...
constexpr double kNarrowest = 5e-3;      // ... but never more than so much [m]
constexpr double kWide = 0.5;            // of an edge: beyond, halving shows a penumbra as well
constexpr double kLongest = 0.5;    // of elements that are cut: no wider than kNarrowest, no thinner than 1 : 100 [m]
constexpr double kStraight = 0.02;  // of its length: how far the middle of an edge may lie off the straight line ...
constexpr double kStraightest = 4e-3;                         // ... but no farther than this [m]
constexpr double kSharpness = 0.01;                           // of the penumbra: how well its ends are known
constexpr double kLeastAngle = 0.6 * std::numbers::pi / 180;  // of parts, or half of the element's own
constexpr int kMostRounds = 8;

void add_leaves_under(const ElementMesh& mesh, std::uint32_t e, std::vector<std::uint32_t>& out) {
  if (mesh[e].is_leaf()) {
    out.push_back(e);
  } else {
    add_leaves_under(mesh, mesh[e].first, out);
    add_leaves_under(mesh, mesh[e].first + 1, out);
  }
}

/// A leaf as a light sees it.
class Facet {
 public:
  Facet(const ElementMesh& mesh, std::uint32_t leaf)
      : x_(mesh.corner_positions(leaf)), n_(mesh.patches().normal[mesh[leaf].patch]) {}

  Vec3 centre() const { return (x_[0] + x_[1] + x_[2]) / 3; }
  const Vec3& normal() const { return n_; }
  double length_of(std::size_t k) const { return length(x_[(k + 1) % 3] - x_[k]); }
  /// A point a little inside of edge k.
  Vec3 on_edge(std::size_t k, double t) const { return inside(x_[k] * (1 - t) + x_[(k + 1) % 3] * t); }
  Vec3 inside(const Vec3& p) const { return p + (centre() - p) * kWayToCentroid; }

 private:
  std::array<Vec3, 3> x_;
  Vec3 n_;
};

/// Where the light's centre comes or goes along the edges of a leaf: bit k of `lit`: corner k sees it; of the points
/// between corners bits 3 + kInner * edge ...
struct Outline {
  std::uint16_t lit = 0;

  bool at(std::size_t edge, int i) const {
    if (i == 0) return lit >> edge & 1;
    if (i == kInner + 1) return lit >> ((edge + 1) % 3) & 1;
    return lit >> (3 + kInner * static_cast<int>(edge) + i - 1) & 1;
  }
  bool mixed() const { return lit != 0 && lit != (1u << (3 + 3 * kInner)) - 1; }
  int flips(std::size_t edge) const {
    int count = 0;
    for (int i = 0; i <= kInner; ++i) count += at(edge, i) != at(edge, i + 1);
    return count;
  }
};

Outline outline(const SharpLight& light, const Facet& facet) {
  std::array<Vec3, 3 + 3 * kInner> points;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) points[count++] = facet.on_edge(k, 0);
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 1; i <= kInner; ++i) points[count++] = facet.on_edge(k, i / (kInner + 1.0));
  return {light.see_centre(points, facet.normal())};
}

/// The share of the way from a to b at which what `holds` at b begins to: it does not at a.
template <class Holds>
double bisect(double a, double b, double precision, const Holds& holds) {
  while (std::abs(b - a) > precision) {
    const double middle = (a + b) / 2;
    (holds(middle) ? b : a) = middle;
  }
  return (a + b) / 2;
}

enum End : std::size_t { kDark, kLit };  ///< of a penumbra: beyond it nothing of the light is seen, or all

bool is_beyond(End end, LightSeen seen) { return seen == (end == kDark ? LightSeen::none : LightSeen::all); }

/// One edge of a leaf as a light sees it; places are shares of its length.
class EdgeInLight {
 public:
  EdgeInLight(const SharpLight& light, const Facet& facet, std::size_t edge)
      : light_(light), facet_(facet), edge_(edge), narrow_(std::min(kNarrow, kNarrowest / facet.length_of(edge))) {}

  /// Where the light's centre comes up or goes down; it does once, between points i and i + 1 of the outline.
  double centre(const Outline& outline) const {
    int i = 0;
    while (outline.at(edge_, i) == outline.at(edge_, i + 1)) ++i;
    const double from = i / (kInner + 1.0), to = (i + 1) / (kInner + 1.0);
    const bool lit = outline.at(edge_, i + 1);
    return bisect(from, to, kSharpness * narrow_,
                  [&](double t) { return light_.sees_centre(facet_.on_edge(edge_, t), facet_.normal()) == lit; });
  }

  /// The end of the penumbra that lies from `within`, a place in it, in direction `way`, +1 or -1; none where the edge
  /// ends before. Found between the first place beyond, in ever wider steps, and the last before.
  std::optional<double> end(End end, double within, double way) const {
    const auto beyond = [&](double t) { return is_beyond(end, seen(t)); };
    double near = within;
    for (double step = narrow_ / 16;; step *= 2) {
      const double far = std::clamp(within + way * step, 0.0, 1.0);
      if (beyond(far)) return bisect(near, far, kSharpness * std::max(narrow_, std::abs(far - within)), beyond);
      if (far == 0 || far == 1) return {};
      near = far;
    }
  }

  LightSeen seen(double t) const { return light_.seen(facet_.on_edge(edge_, t), facet_.normal()); }
  /// The least width of a penumbra here.
  double narrow() const { return narrow_; }

 private:
  const SharpLight& light_;
  const Facet& facet_;
  std::size_t edge_;
  double narrow_;
};

/// The end of the penumbra on an edge of a leaf, where it has one; at least half the narrowest width from the centre.
std::optional<double> place_of(End end, const SharpLight& light, const Facet& facet, std::size_t edge,
                               const Outline& outline) {
  const EdgeInLight here(light, facet, edge);
  const int flips = outline.flips(edge);
  if (flips == 1) {
    const double way = outline.at(edge, 0) == (end == kDark) ? 1 : -1;
    const double centre = here.centre(outline);
    const std::optional<double> found = here.end(end, centre, way);
    if (!found) return {};
    return way > 0 ? std::max(*found, centre + here.narrow() / 2) : std::min(*found, centre - here.narrow() / 2);
  }
  if (flips > 1) return {};
  // The centre is on the same side all along, but a corner may lie within the penumbra.
  const LightSeen start = here.seen(0), stop = here.seen(1);
  if (start == LightSeen::part && is_beyond(end, stop)) return here.end(end, 0, 1);
  if (stop == LightSeen::part && is_beyond(end, start)) return here.end(end, 1, -1);
  return {};
}

/// How the light's shadow runs through a leaf: in by one edge and out by another, straight or bent; in some other way;
/// with a penumbra so wide that it is no edge.
enum class Shape { none, straight, bent, crooked, wide };

Shape shape(const SharpLight& light, const Facet& facet, const Outline& outline) {
  std::array<Vec3, 2> on_edge;
  std::size_t edges = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int flips = outline.flips(k);
    if (flips == 0) continue;
    if (flips > 1 || edges == 2) return Shape::crooked;
    const EdgeInLight here(light, facet, k);
    const double centre = here.centre(outline), to_lit = outline.at(k, 0) ? -1 : 1;
    const double dark = here.end(kDark, centre, -to_lit).value_or(to_lit > 0 ? 0 : 1);
    const double lit = here.end(kLit, centre, to_lit).value_or(to_lit > 0 ? 1 : 0);
    if (std::abs(lit - dark) > kWide) return Shape::wide;
    on_edge[edges++] = facet.on_edge(k, centre);
  }
  if (edges != 2) return Shape::none;
  const Vec3 along = on_edge[1] - on_edge[0], middle = facet.inside((on_edge[0] + on_edge[1]) / 2);
  const double off = std::min(kStraight * length(along), kStraightest);
  const Vec3 across = cross(facet.normal(), along);
  const Vec3 step = across * (off / std::max(length(across), 1e-300));
  const bool straight =
      light.sees_centre(middle + step, facet.normal()) != light.sees_centre(middle - step, facet.normal());
  return straight ? Shape::straight : Shape::bent;
}

class PointSet {
 public:
  bool operator[](std::uint32_t point) const { return point < is_in_.size() && is_in_[point]; }
  void set(std::uint32_t point) {
    if (point >= is_in_.size()) is_in_.resize(point + 1, false);
    is_in_[point] = true;
  }

 private:
  std::vector<bool> is_in_;
};

double least_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const auto at = [](const Vec3& x, const Vec3& y, const Vec3& z) {
    return std::atan2(length(cross(y - x, z - x)), dot(y - x, z - x));
  };
  return std::min({at(a, b, c), at(b, c, a), at(c, a, b)});
}

/// Whether a cut at the share t of edge k leaves parts of the leaf that are not too thin.
bool leaves_angles(const ElementMesh& mesh, std::uint32_t leaf, std::size_t k, double t) {
  const auto x = mesh.corner_positions(leaf);
  const Vec3 &start = x[k], &end = x[(k + 1) % 3], &apex = x[(k + 2) % 3];
  const Vec3 middle = start * (1 - t) + end * t;
  return std::min(least_angle(start, middle, apex), least_angle(middle, end, apex)) >
         std::min(kLeastAngle, 0.5 * least_angle(start, end, apex));
}

/// The same of the leaf across that edge, if there is one.
bool leaves_angles_across(const ElementMesh& mesh, std::uint32_t leaf, std::size_t k, double t) {
  const std::uint32_t other = mesh.neighbours(leaf)[k];
  if (other == VertexLightmap::kNone) return true;
  const auto back = mesh.neighbours(other);
  const auto edge = static_cast<std::size_t>(std::find(back.begin(), back.end(), leaf) - back.begin());
  return leaves_angles(mesh, other, edge, 1 - t);
}

/// The edges of one light's shadows.
class Cutter {
 public:
  Cutter(ElementMesh& mesh, const SharpLight& light, const ShadowEdgeOptions& options)
      : mesh_(mesh), light_(light), options_(options) {}

  /// Halves what is not straight; leaves that are stay in straight_.
  void look_at(std::vector<std::uint32_t> candidates, ShadowEdges& done, const Monitor& monitor) {
    for (int round = 0; !candidates.empty() && !monitor.should_stop(); ++round) {
      std::vector<Shape> shapes(candidates.size(), Shape::none);
      parallel_for(candidates.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !monitor.should_stop(); ++i) {
          const Facet facet(mesh_, candidates[i]);
          const Outline seen = outline(light_, facet);
          if (seen.mixed()) shapes[i] = shape(light_, facet, seen);
        }
      });
      if (monitor.should_stop()) return;
      std::vector<std::uint32_t> marked;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double longest = mesh_.longest_edge(candidates[i]);
        const bool two_ends = shapes[i] == Shape::straight || shapes[i] == Shape::bent;
        const bool is_fit =
            two_ends ? shapes[i] == Shape::straight && longest <= kLongest : shapes[i] != Shape::crooked;
        const bool may_halve = longest >= 2 * options_.shortest_edge && round < kMostRounds &&
                               mesh_.leaf_count() + 4 * marked.size() < options_.most_elements;
        if (!is_fit && may_halve)
          marked.push_back(candidates[i]);
        else
          (two_ends ? straight_ : others_).push_back(candidates[i]);
      }
      done.halved += marked.size();
      mesh_.split(marked);
      // Those halved, and those that conformity halved with them: their parts are looked at anew.
      candidates.clear();
      for (const std::uint32_t e : marked) add_leaves_under(mesh_, e, candidates);
      for (auto* kept : {&straight_, &others_})
        std::erase_if(*kept, [&](std::uint32_t e) {
          if (!mesh_[e].is_leaf()) add_leaves_under(mesh_, e, candidates);
          return !mesh_[e].is_leaf();
        });
    }
  }

  /// Along one end of the penumbra after the other; in between, the mesh conforms.
  void cut(ShadowEdges& done) {
    done.cut += straight_.size();
    take_what_touches();
    for (const End end : {kDark, kLit}) {
      known_.clear();
      for (const std::uint32_t e : straight_) cut_leaves_under(e, end);
    }
    for (const std::uint32_t e : straight_) mark_leaves_under(e);
  }

 private:
  /// Beside a corner within the penumbra lie leaves that only one end of it crosses.
  void take_what_touches() {
    for (const std::uint32_t e : straight_) {
      const Facet facet(mesh_, e);
      const auto points = mesh_.points_of(e);
      for (std::size_t k = 0; k < 3; ++k)
        if (light_.seen(facet.on_edge(k, 0), facet.normal()) == LightSeen::part) within_.set(points[k]);
    }
    for (const std::uint32_t e : others_) {
      const auto points = mesh_.points_of(e);
      if (std::ranges::any_of(points, [&](std::uint32_t p) { return within_[p]; })) straight_.push_back(e);
    }
  }

  void cut_leaves_under(std::uint32_t e, End end) {
    if (mesh_[e].is_leaf() && (mesh_.leaf_count() >= options_.most_elements || !cut_leaf(e, end))) return;
    cut_leaves_under(mesh_[e].first, end);
    cut_leaves_under(mesh_[e].first + 1, end);
  }

  /// At the first of its edges that the end of the penumbra crosses; false where there is none. An edge with a corner
  /// at that end is not crossed by it once more.
  bool cut_leaf(std::uint32_t leaf, End end) {
    const Facet facet(mesh_, leaf);
    std::optional<Outline> seen;
    const auto points = mesh_.points_of(leaf);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = points[k], b = points[(k + 1) % 3];
      if (at_end_[end][a] || at_end_[end][b]) continue;
      auto [known, is_new] = known_.try_emplace(std::pair{std::min(a, b), std::max(a, b)});
      if (is_new) {
        if (!seen) seen = outline(light_, facet);
        if (const std::optional<double> t = place_of(end, light_, facet, k, *seen)) known->second = a < b ? *t : 1 - *t;
      }
      if (!known->second) continue;
      const double t = a < b ? *known->second : 1 - *known->second;
      const double near = std::min(kNarrow, kNarrowest / facet.length_of(k)) / 2;
      if (t < near || t > 1 - near) {
        at_end_[end].set(t < near ? a : b);
        continue;
      }
      if (!leaves_angles(mesh_, leaf, k, t) || !leaves_angles_across(mesh_, leaf, k, t)) continue;
      mesh_.cut(leaf, k, t);
      const std::uint32_t first = mesh_[leaf].first;
      at_end_[end].set(mesh_.points_of(first)[1]);
      return true;
    }
    return false;
  }

  void mark_leaves_under(std::uint32_t e) {
    if (!mesh_[e].is_leaf()) {
      mark_leaves_under(mesh_[e].first);
      mark_leaves_under(mesh_[e].first + 1);
      return;
    }
    int dark = 0, lit = 0;
    for (const std::uint32_t p : mesh_.points_of(e)) {
      if (!at_end_[kDark][p] && !at_end_[kLit][p] && !within_[p]) return;
      dark += at_end_[kDark][p], lit += at_end_[kLit][p];
    }
    if (dark < 3 && lit < 3) mesh_.mark_penumbra(e);
  }

  ElementMesh& mesh_;
  const SharpLight& light_;
  const ShadowEdgeOptions& options_;
  std::vector<std::uint32_t> straight_, others_;
  PointSet within_;                                                                 ///< the penumbra
  std::array<PointSet, 2> at_end_;                                                  ///< of it
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<double>> known_;  ///< by ends of an edge, lower first
};

}  // namespace

ShadowEdges cut_shadow_edges(ElementMesh& mesh, const Problem& problem, const Field& E,
                             const ShadowEdgeOptions& options, const Monitor& monitor) {
  ShadowEdges done;
  const std::vector<std::uint32_t> leaves = mesh.leaves();  // as they were
  std::vector<char> worth(leaves.size());
  for (const SharpLight& light : sharp_lights(problem)) {
    parallel_for(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Facet facet(mesh, leaves[i]);
        worth[i] = light.open_irradiance(facet.centre(), facet.normal()) > options.contrast * luminous_mean(E[i]);
      }
    });
    std::vector<std::uint32_t> candidates;
    for (std::size_t i = 0; i < leaves.size(); ++i)
      if (worth[i]) add_leaves_under(mesh, leaves[i], candidates);
    Cutter cutter(mesh, light, options);
    cutter.look_at(std::move(candidates), done, monitor);
    if (monitor.should_stop()) break;
    cutter.cut(done);
  }
  return done;
}

}  // namespace clerestory
