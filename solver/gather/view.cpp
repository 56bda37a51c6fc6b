#include "solver/gather/view.h"

#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/two_estimators.h"
#include "solver/visibility/echoes.h"

namespace clerestory {

void View::look(std::span<const Vec3> directions, std::span<const double> density, std::uint32_t owner,
                std::span<Spectrum> values, FoundByRays* found) const {
  std::array<Ray, 16> rays;
  std::array<Hit, 16> hits;
  if (found) found->clear();
  std::array<Echo, 16> echoes;
  for (std::size_t k = 0; k < directions.size(); ++k) rays[k] = {p_, directions[k]};
  const Problem& problem = light_.problem;
  const bool has_echoes = problem.rays.has_echoes();
  problem.rays.first_hits(problem.patches, std::span(rays).first(directions.size()), hits,
                          std::span(echoes).first(has_echoes ? directions.size() : 0));
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Hit& hit = hits[k];
    values[k] = Spectrum(0.0);
    if (owner_of(directions[k], hit.first, hit.reflected ? PatchId{} : hit.patch) != owner) continue;
    if (hit.escaped()) {
      const Vec3& direction = hit.direction(rays[k]);
      values[k] = light_.sky(direction) * std::numbers::pi * hit.transmittance;
      if (found) found->add(k, RowEntry::of_sky(pack_direction(direction), std::numbers::pi * hit.transmittance));
    } else if (hit.patch.valid()) {
      double share = owner < kBrightAreas ? slit_gain(owner, directions[k], hit.first) : 1;
      // A slit's gain is what the place there has over the mean of its element. In mirrors, and so behind one that
      // hangs on a wall, where a patch sees itself most of all, the mean stays.
      Spectrum back = share == 1 && !hit.reflected ? light_.glow_at(hit.patch, hit.position(rays[k]), hit.distance)
                                                   : light_.sampler.glow()[hit.patch];
      back *= share;
      if (owner == kNobody) {
        share = share_of_bundle(hit, rays[k], density[k]);
        back *= share;
      }
      values[k] = back * hit.transmittance;
      if (found) found->add(k, RowEntry::of_patch(hit.patch, share * hit.transmittance));
    }
    if (has_echoes && !echoes[k].is_none())
      values[k] += turned_back(echoes[k], rays[k], owner == kNobody ? density[k] : 0, k, found);
  }
}

double View::share_of_bundle(const Hit& hit, const Ray& ray, double density) const {
  if (!hit.reflected)
    return bright_rays_ > 0
               ? balance_heuristic(density, bright_rays_ * light_.sampler.density(hit, at_, ray.direction, true))
               : 1;
  if (in_mirrors_.empty() || hit.plane == kNoPlane || !light_.sampler.is_bright(hit.patch)) return 1;
  const auto m = std::ranges::find(plan_.mirrors, hit.plane);
  if (m == plan_.mirrors.end()) return 1;
  const double distance = length(hit.leg.origin - p_) + hit.distance;
  const double cosine = -dot(light_.problem.patches.normal[hit.patch], hit.leg.direction);
  const LightTree::Receiver& behind = in_mirrors_[static_cast<std::size_t>(m - plan_.mirrors.begin())];
  return balance_heuristic(density,
                           plan_.rays_in_mirror * light_.sampler.density(hit.patch, behind, distance, cosine, true));
}

Spectrum View::turned_back(const Echo& echo, const Ray& ray, double density, std::size_t k, FoundByRays* found) const {
  RandomStream random(key_of(ray, kEchoes));
  const Problem& problem = light_.problem;
  Spectrum sum(0.0);
  follow_echo(problem.rays, problem.patches, echo, random, [&](const Hit& hit) {
    const Spectrum weight = hit.transmittance;
    if (hit.escaped()) {
      const Vec3& direction = hit.direction(ray);
      sum += light_.sky(direction) * std::numbers::pi * weight;
      if (found) found->add(k, RowEntry::of_sky(pack_direction(direction), std::numbers::pi * weight));
    } else if (hit.patch.valid()) {
      const double share = density > 0 ? share_of_bundle(hit, ray, density) : 1;
      sum += light_.sampler.glow()[hit.patch] * (share * weight);
      if (found) found->add(k, RowEntry::of_patch(hit.patch, share * weight));
    }
  });
  return sum;
}

double View::slit_gain(std::uint32_t number, const Vec3& direction, double distance) const {
  if (light_.slit_gains.gain.empty()) return 1;
  const LightArea& slit = light_.problem.lights.openings[number];
  return light_.slit_gains.of(number, slit, distance - way_out(slit, p_, direction));
}

std::uint32_t View::owner_of(const Vec3& direction, double distance, PatchId patch) const {
  const std::uint32_t opening = first_way_out(light_.problem.lights.openings, plan_.openings, p_, direction, distance);
  if (opening != kNoOpening || !patch.valid() || plan_.bright_areas.empty()) return opening;
  const std::uint32_t bright_area = light_.bright_areas.of(patch);
  return std::ranges::find(plan_.bright_areas, bright_area) == plan_.bright_areas.end() ? kNobody
                                                                                        : kBrightAreas + bright_area;
}

std::uint32_t View::owner_of(const Vec3& direction) const {
  if (plan_.openings.empty() && plan_.bright_areas.empty()) return kNobody;
  const Hit hit = light_.problem.rays.first_hit(light_.problem.patches, {p_, direction});
  return owner_of(direction, hit.first, hit.reflected ? PatchId{} : hit.patch);
}

void AreaView::look(std::span<const std::array<float, 2>> points, std::span<Spectrum> values,
                    std::span<PolygonView::Sight> sights, FoundByRays* found) const {
  std::array<Vec3, 16> directions;
  std::array<double, 16> density{};  // counts for rays that belong to nobody only
  for (std::size_t k = 0; k < points.size(); ++k) {
    sights[k] = polygon.look(points[k][0], points[k][1]);
    directions[k] = sights[k].direction;
  }
  view.look(std::span(directions).first(points.size()), density, owner, values, found);
}

int bright_rays(const Illumination& light, const GatherPattern& pattern, const GatherPlan& plan) {
  return plan.looks_for_bright_patches && light.sampler.has_bright_patches() ? pattern.quality().bright_rays : 0;
}

}  // namespace clerestory
