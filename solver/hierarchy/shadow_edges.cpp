#include "solver/hierarchy/shadow_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "solver/hierarchy/shadow_on_leaf.h"
#include "solver/illumination/sharp_light.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kContrast = 0.35;  // of an element's irradiance: lights that give less draw no edge on it
constexpr double kLongest = 0.5;    // of elements that are cut: their parts would be thin [m]
constexpr double kLeastAngle = 0.6 * std::numbers::pi / 180;  // of parts, or half of the element's own
constexpr int kMostRounds = 12;                               // of halving
/// Leaves are halved for a crooked edge down to this share of the shortest edge elsewhere: between two edges of a
/// leg's shadow.
constexpr double kCrooked = 0.25;
/// Of an edge from its corner at the end of a penumbra: what is found there is that end once more.
constexpr double kSameEnd = 0.1;
/// One upon the other, of one element and along one end: some shadows run into each other without end.
constexpr int kMostCuts = 8;
/// Pairs of a light and an element that are asked whether one matters to the other: seconds of a core. Beyond, the
/// lights of most power are.
constexpr double kMostPairs = 1e8;

void add_leaves_under(const ElementMesh& mesh, std::uint32_t e, std::vector<std::uint32_t>& out) {
  if (mesh[e].is_leaf()) {
    out.push_back(e);
  } else {
    add_leaves_under(mesh, mesh[e].first, out);
    add_leaves_under(mesh, mesh[e].first + 1, out);
  }
}

/// By number of the light among sharp_lights(), suns first. A sun of one of several times has its share of their mean,
/// and at its time as many times more.
double least_contrast(const Lights& lights, std::size_t number) {
  const bool is_of_a_time = number < lights.suns.size() && lights.suns[number].time;
  return is_of_a_time ? kContrast / static_cast<double>(lights.times) : kContrast;
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

  /// Halves leaves in which the edge is not straight, as far as may be.
  void look_at(std::vector<std::uint32_t> candidates, ShadowEdges& done, const Monitor& monitor) {
    for (int round = 0; !candidates.empty() && !monitor.should_stop(); ++round) {
      std::vector<std::optional<ShadowRun>> runs(candidates.size());  // where there is an edge
      parallel_for(candidates.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end && !monitor.should_stop(); ++i) {
          const LeafInLight leaf_in_light(mesh_, candidates[i]);
          const ShadowOutline seen = shadow_outline(light_, leaf_in_light);
          if (seen.mixed()) runs[i] = shadow_run(light_, leaf_in_light, seen);
        }
      });
      if (monitor.should_stop()) return;
      std::vector<std::uint32_t> marked;
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        const double longest = mesh_.longest_edge(candidates[i]);
        const bool is_fit =
            !runs[i] || *runs[i] == ShadowRun::wide || (*runs[i] == ShadowRun::straight && longest <= kLongest);
        const double shortest = kCrooked * options_.shortest_edge.of(mesh_.patches(), mesh_[candidates[i]].patch);
        const bool may_halve = longest >= 2 * shortest && round < kMostRounds &&
                               mesh_.leaf_count() + 4 * marked.size() < options_.most_elements;
        if (!is_fit && may_halve)
          marked.push_back(candidates[i]);
        else
          leaves_with(runs[i]).push_back(candidates[i]);
      }
      done.halved += marked.size();
      mesh_.split(marked);
      // Those halved, and those that conformity halved with them: their parts are looked at anew.
      candidates.clear();
      for (const std::uint32_t e : marked) add_leaves_under(mesh_, e, candidates);
      for (auto* kept : {&edged_, &crooked_, &others_})
        std::erase_if(*kept, [&](std::uint32_t e) {
          if (!mesh_[e].is_leaf()) add_leaves_under(mesh_, e, candidates);
          return !mesh_[e].is_leaf();
        });
    }
  }

  /// Along one end of the penumbra after the other; in between, the mesh conforms.
  void cut(ShadowEdges& done, const Monitor& monitor) {
    take_what_touches();
    for (const PenumbraEnd end : {PenumbraEnd::dark, PenumbraEnd::lit}) {
      known_.clear();
      for (const auto* leaves : {&edged_, &crooked_})
        for (const std::uint32_t e : *leaves)
          if (!monitor.should_stop()) cut_leaves_under(e, end, 0);
    }
    for (const auto* leaves : {&edged_, &crooked_})
      for (const std::uint32_t e : *leaves) done.cut += !mesh_[e].is_leaf();
    // In crooked ones the penumbrae of two edges may overlap: light does not fall evenly from corners within them.
    for (const std::uint32_t e : edged_) mark_leaves_under(e, false);
    for (const std::uint32_t e : crooked_) mark_leaves_under(e, true);
  }

 private:
  std::vector<std::uint32_t>& leaves_with(const std::optional<ShadowRun>& run) {
    if (!run) return others_;
    return *run == ShadowRun::straight || *run == ShadowRun::bent ? edged_ : crooked_;
  }

  /// Beside a corner within the penumbra lie leaves that only one end of it crosses.
  void take_what_touches() {
    for (const auto* leaves : {&edged_, &crooked_})
      for (const std::uint32_t e : *leaves) {
        const LeafInLight leaf_in_light(mesh_, e);
        const auto points = mesh_.points_of(e);
        for (std::size_t k = 0; k < 3; ++k)
          if (light_.seen(leaf_in_light.on_edge(k, 0), leaf_in_light.normal()) == LightSeen::part)
            within_.set(points[k]);
      }
    for (const std::uint32_t e : others_) {
      const auto points = mesh_.points_of(e);
      if (std::ranges::any_of(points, [&](std::uint32_t p) { return within_[p]; })) edged_.push_back(e);
    }
  }

  PointSet& at(PenumbraEnd end) { return at_end_[static_cast<std::size_t>(end)]; }

  /// cuts: that made this element of the one that an edge goes through.
  void cut_leaves_under(std::uint32_t e, PenumbraEnd end, int cuts) {
    if (mesh_[e].is_leaf() && (cuts >= kMostCuts || mesh_.leaf_count() >= options_.most_elements || !cut_leaf(e, end)))
      return;
    cut_leaves_under(mesh_[e].first, end, cuts + 1);
    cut_leaves_under(mesh_[e].first + 1, end, cuts + 1);
  }

  /// At the first of its edges that the end of the penumbra crosses; false where there is none. Near a corner that is
  /// at that end already it does not cross once more; farther from it another edge does.
  bool cut_leaf(std::uint32_t leaf, PenumbraEnd end) {
    const LeafInLight leaf_in_light(mesh_, leaf);
    std::optional<ShadowOutline> seen;
    const auto points = mesh_.points_of(leaf);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = points[k], b = points[(k + 1) % 3];
      if (at(end)[a] && at(end)[b]) continue;
      auto [known, is_new] = known_.try_emplace(std::pair{std::min(a, b), std::max(a, b)});
      if (is_new) {
        if (!seen) seen = shadow_outline(light_, leaf_in_light);
        if (const std::optional<double> t = penumbra_end_on(end, light_, leaf_in_light, k, *seen))
          known->second = a < b ? *t : 1 - *t;
      }
      if (!known->second) continue;
      const double t = a < b ? *known->second : 1 - *known->second;
      if ((at(end)[a] && t < kSameEnd) || (at(end)[b] && t > 1 - kSameEnd)) continue;
      const double near = narrowest_penumbra(leaf_in_light.length_of(k)) / 2;
      if (t < near || t > 1 - near) {
        at(end).set(t < near ? a : b);
        continue;
      }
      if (!leaves_angles(mesh_, leaf, k, t) || !leaves_angles_across(mesh_, leaf, k, t)) continue;
      mesh_.cut(leaf, k, t);
      const std::uint32_t first = mesh_[leaf].first;
      at(end).set(mesh_.points_of(first)[1]);
      return true;
    }
    return false;
  }

  /// from_end_to_end: those alone that reach from the dark end of a penumbra to the lit one.
  void mark_leaves_under(std::uint32_t e, bool from_end_to_end) {
    if (!mesh_[e].is_leaf()) {
      mark_leaves_under(mesh_[e].first, from_end_to_end);
      mark_leaves_under(mesh_[e].first + 1, from_end_to_end);
      return;
    }
    int dark = 0, lit = 0;
    for (const std::uint32_t p : mesh_.points_of(e)) {
      if (!at(PenumbraEnd::dark)[p] && !at(PenumbraEnd::lit)[p] && !within_[p]) return;
      dark += at(PenumbraEnd::dark)[p], lit += at(PenumbraEnd::lit)[p];
    }
    if (from_end_to_end && (dark == 0 || lit == 0)) return;
    if (dark < 3 && lit < 3) mesh_.mark_penumbra(e);
  }

  ElementMesh& mesh_;
  const SharpLight& light_;
  const ShadowEdgeOptions& options_;
  std::vector<std::uint32_t> edged_, crooked_, others_;  ///< with a straight edge, or bent; with another; with none
  PointSet within_;                                      ///< the penumbra
  std::array<PointSet, 2> at_end_;                       ///< of it
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::optional<double>> known_;  ///< by ends of an edge, lower first
};

}  // namespace

ShadowEdges cut_shadow_edges(ElementMesh& mesh, const Problem& problem, const Field& E,
                             const ShadowEdgeOptions& options, const Monitor& monitor) {
  ShadowEdges done;
  const std::vector<std::uint32_t> leaves = mesh.leaves();  // as they were
  std::vector<char> worth(leaves.size());
  const auto most_lights = static_cast<std::size_t>(kMostPairs / static_cast<double>(leaves.size() + 1)) + 1;
  const std::vector<SharpLight> lights = sharp_lights(problem, most_lights);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const SharpLight& light = lights[k];
    const double contrast = least_contrast(problem.lights, k);
    parallel_for(leaves.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end && !monitor.should_stop(); ++i) {
        const LeafInLight leaf_in_light(mesh, leaves[i]);
        worth[i] =
            light.open_irradiance(leaf_in_light.centre(), leaf_in_light.normal()) > contrast * luminous_mean(E[i]) &&
            light.may_reach(leaf_in_light.corners());
      }
    });
    std::vector<std::uint32_t> candidates;
    for (std::size_t i = 0; i < leaves.size(); ++i)
      if (worth[i]) add_leaves_under(mesh, leaves[i], candidates);
    Cutter cutter(mesh, light, options);
    cutter.look_at(std::move(candidates), done, monitor);
    if (monitor.should_stop()) break;
    cutter.cut(done, monitor);
  }
  return done;
}

}  // namespace clerestory
