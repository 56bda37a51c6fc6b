#include "solver/hierarchy/shadow_on_leaf.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

constexpr double kWide = 0.5;          // of an edge: beyond, halving shows a penumbra as well
constexpr double kStraight = 0.02;     // of its length: how far the middle of an edge may lie off the straight line ...
constexpr double kStraightest = 4e-3;  // ... but no farther than this [m]
constexpr double kSharpness = 0.01;    // of the penumbra: how well its ends are known

/// The share of the way from a to b at which what `holds` at b begins to: it does not at a.
template <class Holds>
double bisect(double a, double b, double precision, const Holds& holds) {
  while (std::abs(b - a) > precision) {
    const double middle = (a + b) / 2;
    (holds(middle) ? b : a) = middle;
  }
  return (a + b) / 2;
}

bool is_beyond(PenumbraEnd end, LightSeen seen) {
  return seen == (end == PenumbraEnd::dark ? LightSeen::none : LightSeen::all);
}

/// One edge of a leaf as a light sees it; places are shares of its length.
class EdgeInLight {
 public:
  EdgeInLight(const SharpLight& light, const LeafInLight& leaf_in_light, std::size_t edge)
      : light_(light), leaf_(leaf_in_light), edge_(edge), narrow_(narrowest_penumbra(leaf_in_light.length_of(edge))) {}

  /// Where the light's centre comes up or goes down; it does once, between points i and i + 1 of the outline.
  double centre(const ShadowOutline& outline) const {
    int i = 0;
    while (outline.at(edge_, i) == outline.at(edge_, i + 1)) ++i;
    const double from = i / (ShadowOutline::kInner + 1.0), to = (i + 1) / (ShadowOutline::kInner + 1.0);
    const bool lit = outline.at(edge_, i + 1);
    return bisect(from, to, kSharpness * narrow_,
                  [&](double t) { return light_.sees_centre(leaf_.on_edge(edge_, t), leaf_.normal()) == lit; });
  }

  /// The end of the penumbra that lies from `within`, a place in it, in direction `way`, +1 or -1; none where the edge
  /// ends before. Found between the first place beyond, in ever wider steps, and the last before.
  std::optional<double> end(PenumbraEnd end, double within, double way) const {
    const auto beyond = [&](double t) { return is_beyond(end, seen(t)); };
    double near = within;
    for (double step = narrow_ / 16;; step *= 2) {
      const double far = std::clamp(within + way * step, 0.0, 1.0);
      if (beyond(far)) return bisect(near, far, kSharpness * std::max(narrow_, std::abs(far - within)), beyond);
      if (far == 0 || far == 1) return {};
      near = far;
    }
  }

  LightSeen seen(double t) const { return light_.seen(leaf_.on_edge(edge_, t), leaf_.normal()); }
  /// The least width of a penumbra here.
  double narrow() const { return narrow_; }

 private:
  const SharpLight& light_;
  const LeafInLight& leaf_;
  std::size_t edge_;
  double narrow_;
};

}  // namespace

ShadowOutline shadow_outline(const SharpLight& light, const LeafInLight& leaf_in_light) {
  std::array<Vec3, 3 + 3 * ShadowOutline::kInner> points;
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) points[count++] = leaf_in_light.on_edge(k, 0);
  for (std::size_t k = 0; k < 3; ++k)
    for (int i = 1; i <= ShadowOutline::kInner; ++i)
      points[count++] = leaf_in_light.on_edge(k, i / (ShadowOutline::kInner + 1.0));
  return {light.see_centre(points, leaf_in_light.normal())};
}

ShadowRun shadow_run(const SharpLight& light, const LeafInLight& leaf_in_light, const ShadowOutline& outline) {
  std::array<Vec3, 2> on_edge;
  std::size_t edges = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int flips = outline.flips(k);
    if (flips == 0) continue;
    if (flips > 1 || edges == 2) return ShadowRun::crooked;
    const EdgeInLight here(light, leaf_in_light, k);
    const double centre = here.centre(outline), to_lit = outline.at(k, 0) ? -1 : 1;
    const double dark = here.end(PenumbraEnd::dark, centre, -to_lit).value_or(to_lit > 0 ? 0 : 1);
    const double lit = here.end(PenumbraEnd::lit, centre, to_lit).value_or(to_lit > 0 ? 1 : 0);
    if (std::abs(lit - dark) > kWide) return ShadowRun::wide;
    on_edge[edges++] = leaf_in_light.on_edge(k, centre);
  }
  if (edges != 2) return ShadowRun::none;
  const Vec3 along = on_edge[1] - on_edge[0], middle = leaf_in_light.inside((on_edge[0] + on_edge[1]) / 2);
  const double off = std::min(kStraight * length(along), kStraightest);
  const Vec3 across = cross(leaf_in_light.normal(), along);
  const Vec3 step = across * (off / std::max(length(across), 1e-300));
  const bool straight = light.sees_centre(middle + step, leaf_in_light.normal()) !=
                        light.sees_centre(middle - step, leaf_in_light.normal());
  return straight ? ShadowRun::straight : ShadowRun::bent;
}

std::optional<double> penumbra_end_on(PenumbraEnd end, const SharpLight& light, const LeafInLight& leaf_in_light,
                                      std::size_t edge, const ShadowOutline& outline) {
  const EdgeInLight here(light, leaf_in_light, edge);
  const int flips = outline.flips(edge);
  if (flips == 1) {
    const double way = outline.at(edge, 0) == (end == PenumbraEnd::dark) ? 1 : -1;
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

}  // namespace clerestory
