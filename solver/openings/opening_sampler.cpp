#include "solver/openings/opening_sampler.h"

#include <algorithm>
#include <numbers>
#include <utility>

#include "solver/openings/openings.h"
#include "solver/sampling/polygon_view.h"

namespace clerestory {
namespace {

LightBounds bounds_of(const LightArea& opening) {
  LightBounds b{opening.centre, opening.centre, opening.normal, 0, std::numbers::pi * opening.area * opening.brightness,
                opening.reach};
  for (const auto& triangle : opening.triangles)
    for (const Vec3& c : triangle) {
      b.lower = {std::min(b.lower.x, c.x), std::min(b.lower.y, c.y), std::min(b.lower.z, c.z)};
      b.upper = {std::max(b.upper.x, c.x), std::max(b.upper.y, c.y), std::max(b.upper.z, c.z)};
    }
  return b;
}

}  // namespace

OpeningSampler::OpeningSampler(std::vector<LightArea> openings, double extent) : openings_(std::move(openings)) {
  std::vector<LightBounds> bounds;
  for (const LightArea& opening : openings_) {
    bounds.push_back(bounds_of(opening));
    spheres_.emplace_back(opening);
  }
  tree_ = LightTree(bounds, Falloff::cosine, extent);
}

OpeningSampler::Sample OpeningSampler::sample(const Vec3& p, const Vec3& n, double pick, double u, double v) const {
  const LightTree::Choice choice = tree_.choose({tree_, p, n}, pick);
  if (!(choice.probability > 0)) return {};
  const LightArea& opening = openings_[choice.light];
  if (!(dot(p - opening.centre, opening.normal) > 0)) return {};
  const PolygonView polygon(p, n, opening.triangles, opening.corners);
  if (!(polygon.solid_angle() > 0)) return {};
  const auto [direction, per_share] = polygon.look(u, v);
  return {direction, per_share / choice.probability, choice.probability / polygon.solid_angle(), choice.light};
}

double OpeningSampler::preference(const Vec3& p, const Vec3& n, const Vec3& d, std::uint32_t but) const {
  const LightTree::Receiver at(tree_, p, n);
  double sum = 0;
  for (std::uint32_t k = 0; k < openings_.size(); ++k) {
    if (k == but || !spheres_[k].is_passed(p, d) || way_out(openings_[k], p, d) < 0) continue;
    const LightArea& opening = openings_[k];
    const double solid_angle = PolygonView(p, n, opening.triangles, opening.corners).solid_angle();
    if (solid_angle > 0) sum += tree_.probability(k, at) / solid_angle;
  }
  return sum;
}

}  // namespace clerestory
