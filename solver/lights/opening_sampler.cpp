#include "solver/lights/opening_sampler.h"

#include <algorithm>
#include <numbers>

#include "solver/lights/openings.h"
#include "solver/polygon_view.h"

namespace clerestory {
namespace {

LightBounds bounds_of(const LightArea& opening) {
  LightBounds b{opening.centre, opening.centre, opening.normal, 0,
                std::numbers::pi * opening.area * opening.brightness};
  for (const auto& triangle : opening.triangles)
    for (const Vec3& c : triangle) {
      b.lower = {std::min(b.lower.x, c.x), std::min(b.lower.y, c.y), std::min(b.lower.z, c.z)};
      b.upper = {std::max(b.upper.x, c.x), std::max(b.upper.y, c.y), std::max(b.upper.z, c.z)};
    }
  return b;
}

}  // namespace

OpeningSampler::OpeningSampler(const Problem& problem) : problem_(problem) {
  std::vector<LightBounds> bounds;
  for (const LightArea& opening : problem.lights.openings) bounds.push_back(bounds_of(opening));
  tree_ = LightTree(bounds, Falloff::cosine, problem.rays.diameter());
}

OpeningSampler::Sample OpeningSampler::sample(const Vec3& p, const Vec3& n, double pick, double u, double v) const {
  const LightTree::Choice choice = tree_.choose(p, n, pick);
  if (!(choice.probability > 0)) return {};
  const LightArea& opening = problem_.lights.openings[choice.light];
  const PolygonView polygon(p, n, opening.triangles, opening.corners);
  if (!(polygon.solid_angle() > 0)) return {};
  const auto [direction, per_share] = polygon.look(u, v);
  return {direction, per_share / choice.probability, choice.probability / polygon.solid_angle(),
          preference(p, n, direction, choice.light)};
}

double OpeningSampler::preference(const Vec3& p, const Vec3& n, const Vec3& d) const {
  return preference(p, n, d, kNoOpening);
}

double OpeningSampler::preference(const Vec3& p, const Vec3& n, const Vec3& d, std::uint32_t but) const {
  double sum = 0;
  for (std::uint32_t k = 0; k < problem_.lights.openings.size(); ++k) {
    const LightArea& opening = problem_.lights.openings[k];
    if (k == but || way_out(opening, p, d) < 0) continue;
    const double solid_angle = PolygonView(p, n, opening.triangles, opening.corners).solid_angle();
    if (solid_angle > 0) sum += tree_.probability(k, p, n) / solid_angle;
  }
  return sum;
}

}  // namespace clerestory
