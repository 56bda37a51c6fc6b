#include "solver/gather/gather_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "solver/gather/view.h"
#include "solver/model/assert.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/two_estimators.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

std::size_t share_of(const RayShares& shares, const RayBudget& budget, int stratum) {
  return std::size_t{1} << (shares.empty() ? budget.least() : shares[static_cast<std::size_t>(stratum)]);
}

/// Adds what rays met to a row, each ray with its weight.
void add_to_row(FoundByRays& found, std::span<const double> weight, LightRow& row) {
  for (std::size_t e = 0; e < found.entry.size(); ++e) {
    found.entry[e].scale(Spectrum(weight[found.ray[e]]));
    if (!found.entry[e].is_empty()) row.push_back(found.entry[e]);
  }
}

struct Sum {
  Spectrum E{0.0};
  double variance = 0;  ///< variance by the differences of neighbouring rays
};

/// Irradiance along the bundle's rays that belong to nobody else.
Sum from_bundle(const View& view, const Frame& frame, const Strata& strata, const RayShares& shares,
                unsigned long long& rays, LightRow* row) {
  std::array<Vec3, 16> directions;
  FoundByRays found;
  std::array<double, 16> density, share_of_ray;
  std::array<Spectrum, 16> values;
  std::size_t queued = 0;
  Sum sum;
  const auto flush = [&] {
    view.look(std::span(directions).first(queued), density, kNobody, std::span(values).first(queued),
              row ? &found : nullptr);
    if (row) add_to_row(found, share_of_ray, *row);
    for (std::size_t k = 0; k < queued; ++k) sum.E += values[k] * share_of_ray[k];
    for (std::size_t k = 0; k + 1 < queued; k += 2) {
      const double difference =
          luminous_mean(values[k]) * share_of_ray[k] - luminous_mean(values[k + 1]) * share_of_ray[k + 1];
      sum.variance += difference * difference;
    }
    rays += queued;
    queued = 0;
  };
  const RayBudget& budget = strata.budget();
  for (int cell = 0; cell < budget.strata(); ++cell) {
    const std::size_t count = share_of(shares, budget, cell);
    const double share = 1.0 / static_cast<double>(count * static_cast<std::size_t>(budget.strata()));
    for (const auto& d : strata.directions(cell).first(count)) {
      directions[queued] = frame.to_world(d[0], d[1], d[2]);
      density[queued] = cosine_density(d) / share;
      share_of_ray[queued++] = share;
      if (queued == 16) flush();
    }
  }
  if (queued) flush();
  return sum;
}

/// What a row of an area's rays is scaled by, so that it gives all of E where its rays alone give `found`: nothing is
/// left to chance in it either where the view is even. By a factor at most: a plan's mean may come from elsewhere.
Spectrum gain_of_area(const Spectrum& E, const Spectrum& found) {
  constexpr double kMost = 4;
  Spectrum gain(1.0);
  for (int c = 0; c < kMaxChannels; ++c)
    if (found[c] > 0) gain[c] = std::clamp(E[c] / found[c], 1 / kMost, kMost);
  return gain;
}

/// Irradiance from an area: what differs from the mean of the plan by a ray a cell, the mean itself in closed form.
Sum from_area(const AreaView& view, const AreaPlan& plan, const AreaCells& cells, const LightArea& area, const Vec3& p,
              const Vec3& n, unsigned long long& rays, LightRow* row) {
  Sum sum{plan.mean * form_factor(area, p, n), 0};
  std::array<std::array<float, 2>, 16> points;
  std::array<Spectrum, 16> values;
  std::array<PolygonView::Sight, 16> sights;
  FoundByRays found;
  std::array<double, 16> weight;
  Spectrum by_rays(0.0);
  const std::size_t begin = row ? row->size() : 0;
  for (std::size_t first = 0; first < plan.size(); first += 16) {
    const std::size_t count = std::min<std::size_t>(16, plan.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const AreaCell cell = plan[first + k];
      points[k] = cells.points(cell.grid)[cell.number];
    }
    view.look(std::span(points).first(count), std::span(values).first(count), sights, row ? &found : nullptr);
    double last = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto& [direction, per_share] = sights[k];
      weight[k] = std::max(0.0, dot(direction, n)) / kPi * per_share * plan[first + k].share();
      const Spectrum E = (values[k] - plan.mean) * weight[k];
      sum.E += E;
      if (k % 2 == 1) sum.variance += (luminous_mean(E) - last) * (luminous_mean(E) - last);
      last = luminous_mean(E);
      by_rays += values[k] * weight[k];
    }
    if (row) add_to_row(found, weight, *row);
  }
  // Where less is seen of an area than the plan knew, its rays may take away a little more than the mean brought; they
  // alone give what is left, and nothing where they find nothing.
  for (int c = 0; c < kMaxChannels; ++c)
    if (sum.E[c] < 0 || by_rays[c] == 0) sum.E[c] = by_rays[c];
  if (row) {
    const Spectrum gain = gain_of_area(sum.E, by_rays);
    for (RowEntry& e : std::span(*row).subspan(begin)) e.scale(gain);
  }
  rays += plan.size();
  return sum;
}

Spectrum bright_patches(const Illumination& light, const Vec3& p, const Frame& frame, const GatherPattern& pattern,
                        const RayShares& shares, const View& view, LightRow* row) {
  const int count = pattern.quality().bright_rays;
  const RayBudget& budget = pattern.quality().bundle;
  const RayScene& rays = light.problem.rays;
  struct Load {
    Spectrum irradiance;
    PatchId patch;
    double weight;
  };
  Spectrum sum(0.0);
  auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Spectrum& passes) {
    sum += load.irradiance * passes;
    if (row) row->push_back(RowEntry::of_patch(load.patch, load.weight / count * passes));
  });
  for (int k = 0; k < count; ++k) {
    const auto& u = pattern.bright_choices()[static_cast<std::size_t>(k)];
    const LightSample s = light.sampler.sample(view.at(), u[0], u[1], u[2], true);
    if (!(s.density > 0)) continue;
    const Vec3 d = normalized(s.end - p);
    if (view.owner_of(d, length(s.end - p), s.patch) != kNobody) continue;  // rays of its owner find it
    const std::size_t share = share_of(shares, budget, shares.empty() ? 0 : pattern.stratum_of(frame, d));
    const double bundle = static_cast<double>(share) * budget.strata() * dot(frame.n, d) / kPi;
    const double share_of_both = balance_heuristic(count * s.density, bundle);
    const Spectrum irradiance = light.glow_at(s.patch, s.end, length(s.end - p)) * s.weight;
    shadows.send(p, s.end, {irradiance * share_of_both, s.patch, s.weight * share_of_both});
  }
  shadows.trace();
  return sum / count;
}

/// What mirrors and panes show of bright patches: by shadow rays to their images.
Spectrum bright_patches_in_mirrors(const Illumination& light, const Vec3& p, const Frame& frame,
                                   const GatherPattern& pattern, const GatherPlan& plan, const RayShares& shares,
                                   const View& view, LightRow* row) {
  const RayScene& rays = light.problem.rays;
  const RayBudget& budget = pattern.quality().bundle;
  Spectrum sum(0.0);
  for (std::size_t m = 0; m < plan.mirrors.size(); ++m) {
    const MirrorPlane& mirror = rays.mirrors()[plan.mirrors[m]];
    const MirrorWay way = MirrorWay{}.over(plan.mirrors[m]);
    for (int k = 0; k < plan.rays_in_mirror; ++k) {
      const auto& u = pattern.bright_choices()[static_cast<std::size_t>(k)];
      const LightSample s = light.sampler.sample(view.in_mirrors()[m], u[0], u[1], u[2], true);
      if (!(s.density > 0)) continue;
      const Vec3 image = mirror.image_of(s.end), d = normalized(image - p);
      const Spectrum passes = rays.transmittance_by_mirrors(p, image, way);
      if (passes.is_black() || view.owner_of(d) != kNobody) continue;
      const std::size_t share = share_of(shares, budget, shares.empty() ? 0 : pattern.stratum_of(frame, d));
      const double bundle = static_cast<double>(share) * budget.strata() * dot(frame.n, d) / kPi;
      const Spectrum weight =
          passes * (balance_heuristic(plan.rays_in_mirror * s.density, bundle) / plan.rays_in_mirror);
      sum += s.irradiance * weight;
      if (row) row->push_back(RowEntry::of_patch(s.patch, s.weight * weight));
    }
  }
  return sum;
}

/// What the areas of the plan give.
Sum from_areas(const View& view, const GatherPlan& plan, const Illumination& light, const GatherPattern& pattern,
               const Vec3& p, const Vec3& n, unsigned long long& rays, LightRow* row) {
  Sum sum;
  const auto look_at = [&](const LightArea& area, std::uint32_t owner, const AreaPlan& area_plan) {
    // A plan may come from the other side of the area's plane: from there no ray belongs to it.
    if (!(dot(p - area.centre, area.normal) > 0)) return;
    const PolygonView polygon(p, n, area.triangles, area.corners);
    if (!(polygon.solid_angle() > 0)) return;
    const Sum found = from_area({view, polygon, owner}, area_plan, pattern.area_cells(), area, p, n, rays, row);
    sum.E += found.E;
    sum.variance += found.variance;
  };
  for (std::size_t k = 0; k < plan.openings.size(); ++k)
    look_at(light.problem.lights.openings[plan.openings[k]], plan.openings[k], plan.opening_plans[k]);
  for (std::size_t k = 0; k < plan.bright_areas.size(); ++k)
    look_at(light.bright_areas.shape[plan.bright_areas[k]], kBrightAreas + plan.bright_areas[k],
            plan.bright_area_plans[k]);
  return sum;
}

/// All that is left to chance: the bundle with those shares, and bright patches that it shares their light with.
Sum from_all_around(const View& view, const Frame& frame, const GatherPlan& plan, const RayShares& shares,
                    const Illumination& light, const GatherPattern& pattern, const Vec3& p, unsigned long long& rays,
                    LightRow* row) {
  Sum sum = from_bundle(view, frame, pattern.bundle(), shares, rays, row);
  if (const int to_bright_patches = bright_rays(light, pattern, plan); to_bright_patches > 0) {
    sum.E += bright_patches(light, p, frame, pattern, shares, view, row);
    rays += static_cast<unsigned>(to_bright_patches);
  }
  if (!plan.mirrors.empty()) {
    sum.E += bright_patches_in_mirrors(light, p, frame, pattern, plan, shares, view, row);
    rays += 2 * static_cast<unsigned long long>(plan.rays_in_mirror) * plan.mirrors.size();
  }
  return sum;
}

}  // namespace

GatheredLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           const GatherPlan& plan, unsigned long long& rays, LightRow* row) {
  if (row) row->clear();
  const Frame frame(n);
  const View view(light, p, frame, bright_rays(light, pattern, plan), plan);
  LightRow of_lights;
  GatheredLight at;
  if (!light.problem.lights.empty())
    at.delta_light =
        light.sampler.delta_light(p, n, delta_effort(pattern), pattern.sun_key(), row ? &of_lights : nullptr);
  const Sum areas = from_areas(view, plan, light, pattern, p, n, rays, row);
  const std::size_t of_areas = row ? row->size() : 0;
  const auto look_around = [&](const RayShares& shares) {
    if (row) row->resize(of_areas);
    const Sum around = from_all_around(view, frame, plan, shares, light, pattern, p, rays, row);
    // Where it is all but dark, what differs from a plan's mean may leave less than nothing.
    const Spectrum E = areas.E + around.E;
    at.E = at.delta_light + Spectrum(std::max(0.0, E[0]), std::max(0.0, E[1]), std::max(0.0, E[2]));
    at.std_error = std::sqrt(areas.variance + around.variance);
    return std::sqrt(around.variance);
  };
  const double left_to_chance = look_around(plan.bundle);
  const RayBudget& bundle = pattern.quality().bundle;
  const bool has_more_rays = plan.bundle.empty() && bundle.deepest() > bundle.least();
  if (has_more_rays && left_to_chance > pattern.quality().noise * luminous_mean(at.E)) {
    const RayShares sharper = plan_bundle(light, p, n, pattern, plan, rays);
    if (!sharper.empty()) look_around(sharper);
  }
  if (row) row->insert(row->end(), of_lights.begin(), of_lights.end());
  CLERESTORY_ASSERT(all_finite(at.E), ==, true);
  return at;
}

GatheredLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           unsigned long long& rays, LightRow* row) {
  return gather_point(light, p, n, pattern,
                      wants_plan(light, pattern) ? plan_gather(light, p, n, pattern, rays) : GatherPlan{}, rays, row);
}

void add_layers(const GatheredLight& at, const LightRow& row, const RowLight& layers, double weight,
                std::span<double> all, std::span<double> delta_light) {
  thread_local std::vector<double> lanes;
  const auto first = std::ranges::find_if(row, [](const RowEntry& e) { return e.is_of_light(); });  // the last of a row
  const auto others = static_cast<std::size_t>(first - row.begin());
  lanes.assign(layers.lanes(), 0.0);
  layers.add(std::span(row).first(others), lanes.data());
  divide_among_layers(at.E - at.delta_light, layers.channels(), lanes);
  for (std::size_t l = 0; l < lanes.size(); ++l) all[l] += weight * lanes[l];
  lanes.assign(layers.lanes(), 0.0);
  layers.add(std::span(row).subspan(others), lanes.data());
  for (std::size_t l = 0; l < lanes.size(); ++l) all[l] += weight * lanes[l], delta_light[l] += weight * lanes[l];
}

}  // namespace clerestory
