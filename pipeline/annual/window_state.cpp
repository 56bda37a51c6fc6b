#include "pipeline/annual/window_state.h"

#include <algorithm>
#include <utility>

#include "meshing/make_lightmap.h"
#include "solver/evaluate/blinds.h"
#include "solver/illumination/place_lights.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "solver/paths/find_slit_gains.h"

namespace clerestory {
namespace {

/// Radiosity of the transport's elements under the sky that it was found with.
Field radiosity(const KeptTransport& kept, const Lights& lights) {
  Layer sky;
  sky.sky = std::make_shared<const SkyRadiance>(lights);
  return solve_for(kept, {&sky, 1}).B;
}

}  // namespace

WindowState::WindowState(const Prepared& scene, KeptTransport kept, const StateOptions& how, const Monitor& monitor)
    : problem_{elements_, scene.rays, scene.lights} {
  B_ = radiosity(kept, scene.lights);
  reflected_ =
      reflect_daylight(kept, scene.patches, scene.rays, how.coarse, how.nodes.direction, how.solve.seed, monitor);
  elements_ = std::move(kept.elements);
  kept = {};
  light_ = std::make_unique<Illumination>(gather_illumination_by_slits(problem_, B_, {}, how.solve.seed, monitor));
  scene_ = std::make_unique<YearScene>(
      year_scene(*light_, how.fine, reflected_, how.year, how.hours, how.plan_reach, how.sun_rays, how.solve.seed));
}

WindowState::WindowState(std::unique_ptr<Prepared> scene, double share_taken, KeptTransport kept,
                         const StateOptions& how, const Monitor& monitor)
    : WindowState(*scene, std::move(kept), how, monitor) {
  own_ = std::move(scene);
  share_taken_ = static_cast<float>(share_taken);
}

void WindowState::year_at(std::span<const PlacesOfPoint> points, const GatherPattern& pattern, std::span<float> total,
                          std::span<float> direct) const {
  RowSums sums(elements_.patch_count());
  clerestory::year_at(*scene_, points, pattern, sums, total, direct);
}

void WindowState::sun_at(std::span<const PlacesOfPoint> points, std::size_t first, std::size_t count,
                         std::span<float> direct) const {
  std::fill(direct.begin(), direct.end(), 0.0f);
  const auto begin = std::ranges::lower_bound(scene_->hour_of_sun, first);
  const auto end = std::lower_bound(begin, scene_->hour_of_sun.end(), first + count);
  const auto from = static_cast<std::size_t>(begin - scene_->hour_of_sun.begin());
  const auto suns = static_cast<std::size_t>(end - begin);
  std::vector<ReceivingPoint> places;
  for (const PlacesOfPoint& point : points) places.insert(places.end(), point.at.begin(), point.at.end());
  std::vector<float> factor(places.size() * suns);
  sun_on_points(problem_.rays, places, std::span(scene_->suns).subspan(from, suns), {}, factor);
  std::size_t place = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::size_t k = 0; k < points[p].at.size(); ++k, ++place)
      for (std::size_t s = 0; s < suns; ++s) {
        const std::size_t h = scene_->hour_of_sun[from + s];
        direct[p * count + h - first] +=
            static_cast<float>(kWhiteEfficacy * points[p].weight[k]) * scene_->year.sun[h] * factor[place * suns + s];
      }
}

std::vector<std::string> blind_groups(const std::vector<Material>& materials) {
  std::vector<std::string> groups;
  for (const Material& m : materials)
    if (m.blinds && std::ranges::find(groups, m.blinds->group) == groups.end()) groups.push_back(m.blinds->group);
  if (groups.size() > kMostWindowGroups)
    throw InputError("materials: blinds are in " + std::to_string(groups.size()) + " groups, and no more than " +
                     std::to_string(kMostWindowGroups) + " can be operated; join windows that close together.");
  return groups;
}

void add_closed_states(const Scene& scene, const PreparedToSolve& open, const StateOptions& how, const Monitor& monitor,
                       std::vector<std::unique_ptr<WindowState>>& states) {
  for (const std::string& group : blind_groups(scene.materials)) {
    PatchSet patches = open.scene.patches;
    double taken = 1;
    for (Material& m : patches.materials) {
      if (!m.blinds || m.blinds->group != group) continue;
      if (const double open_share = luminous_mean(m.transmittance); open_share > 0)
        taken = std::min(taken, 1 - luminous_mean(m.blinds->transmittance) / open_share);
      m.transmittance = m.blinds->transmittance;
    }
    if (!(taken > 0)) taken = 1;  // blinds that take nothing: closing them does not help
    RayScene rays(patches);
    auto closed = std::make_unique<Prepared>(Prepared{std::move(patches), open.scene.repairs, std::move(rays), {}, {}});
    closed->lights = place_lights(scene.lights, closed->patches, closed->rays);
    KeptTransport kept;
    AroundSolve around = how.around;
    around.keep = &kept;
    solve(closed->problem(), make_lightmap(closed->patches), open.scene.repairs.max_element, how.solve, monitor,
          around);
    states.push_back(std::make_unique<WindowState>(std::move(closed), taken, std::move(kept), how, monitor));
  }
}

}  // namespace clerestory
