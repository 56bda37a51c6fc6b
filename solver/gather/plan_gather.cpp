#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>

#include "solver/gather/gather_point.h"
#include "solver/gather/view.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

// By judgement: they decide who finds which light, and bias nothing.
constexpr double kNarrow = 4;  ///< times the bundle's density of directions: what shadow rays find, and it hardly
constexpr double kWorthAShare = 0.001;  ///< of all light at a point, else it is left to chance
constexpr double kWorthLooking = 0.1;   ///< share of bright patches' light outside of the bright areas looked at
constexpr double kLeastOfBest = 0.2;    ///< of the light of the best bright area, else it has no rays of its own
constexpr std::size_t kMostOpenings = 8, kMostBrightAreas = 4,
                      kMostMirrors = 4;  ///< that a point looks at by rays of their own

/// Whether a few rays to bright patches bring light that the bundle would find by chance only: those outside of a room
/// are none of its lamps, and a sunlit ground is as wide as what a bundle looks for anyway.
bool misses_bright_patches(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           double others, unsigned long long& rays) {
  if (!light.sampler.has_bright_patches()) return false;
  const LightTree::Receiver at = light.sampler.receiver(p, n);
  double wide = 0, narrow = 0;
  struct Load {
    double light;
    bool is_narrow;
  };
  auto shadows = shadow_rays<Load>(light.problem.rays, [&](const Load& load, const Spectrum& passes) {
    (load.is_narrow ? narrow : wide) += load.light * luminous_mean(passes) / GatherPattern::kBrightPilots;
  });
  for (const auto& u : pattern.bright_pilots()) {
    const LightSample s = light.sampler.sample(at, u[0], u[1], u[2], true);
    if (!(s.density > 0)) continue;
    const double cosine = dot(n, normalized(s.end - p)) / std::numbers::pi;
    shadows.send(p, s.end, {luminous_mean(s.irradiance), s.density > kNarrow * cosine});
    ++rays;
  }
  shadows.trace();
  if (!(narrow > 0)) return light.sky.dark();  // all the light there is comes from somewhere
  return narrow > kWorthAShare * (others + wide + narrow);
}

/// By day a pane shows little beside what comes through it.
bool is_worth_asking(const MirrorPlane& mirror, const Illumination& light) {
  return !mirror.is_glass || light.sky.dark();
}

/// The planes of mirrors and panes that show bright patches which a bundle would find by chance only.
std::vector<std::uint32_t> mirrors_worth_looking(const Illumination& light, const Vec3& p, const Vec3& n,
                                                 const GatherPattern& pattern, double others,
                                                 unsigned long long& rays) {
  const RayScene& scene = light.problem.rays;
  if (scene.mirrors().empty() || !light.sampler.has_bright_patches()) return {};
  constexpr std::size_t kPilots = 16;
  struct Found {
    double light;
    std::uint32_t plane;
  };
  std::vector<Found> found;
  for (std::uint32_t m = 0; m < scene.mirrors().size(); ++m) {
    const MirrorPlane& mirror = scene.mirrors()[m];
    if (!is_worth_asking(mirror, light) || !mirror.is_over(p, n)) continue;
    const LightTree::Receiver behind = View::seen_in(light, p, n, m);
    double narrow = 0;
    for (std::size_t k = 0; k < kPilots; ++k) {
      const auto& u = pattern.bright_pilots()[k * (GatherPattern::kBrightPilots / kPilots)];
      const LightSample s = light.sampler.sample(behind, u[0], u[1], u[2], true);
      if (!(s.density > 0)) continue;
      const Vec3 image = mirror.image_of(s.end);
      if (!(s.density > kNarrow * dot(n, normalized(image - p)) / std::numbers::pi)) continue;
      narrow += luminous_mean(s.irradiance * scene.transmittance_by_mirrors(p, image, MirrorWay{}.over(m))) / kPilots;
    }
    rays += kPilots;
    if (narrow > kWorthAShare * others) found.push_back({narrow, m});
  }
  std::ranges::stable_sort(found, std::greater<>(), &Found::light);
  std::vector<std::uint32_t> planes;
  for (const Found& f : std::span(found).first(std::min(found.size(), kMostMirrors))) planes.push_back(f.plane);
  return planes;
}

/// What a few rays find of sky that belongs to none of the openings: part of the view may be sky, or end at a bright
/// spot of it, and all of it may be.
enum class SkyInView { none, edge, all };
SkyInView sky_in_view(const Illumination& light, const Vec3& p, const Frame& frame, const GatherPattern& pattern,
                      std::span<const std::uint32_t> openings, unsigned long long& rays) {
  const int count = pattern.bundle().budget().strata();
  bool sky = false, other = false;
  double brightest = 0, sum = 0;
  std::array<Ray, 16> pilots;
  std::array<Hit, 16> hits;
  for (int first = 0; first < count; first += 64) {
    for (int k = 0; k < 16; ++k) {
      const auto& d = pattern.bundle().pilot(first + 4 * k);
      pilots[static_cast<std::size_t>(k)] = {p, frame.to_world(d[0], d[1], d[2])};
    }
    light.problem.rays.first_hits(light.problem.patches, pilots, hits);
    rays += 16;
    for (std::size_t k = 0; k < 16; ++k) {
      const bool is_sky = hits[k].escaped() && first_way_out(light.problem.lights.openings, openings, p,
                                                             pilots[k].direction, hits[k].first) == kNoOpening;
      (is_sky ? sky : other) = true;
      if (!is_sky) continue;
      const double L = luminous_mean(light.sky(hits[k].direction(pilots[k])));
      brightest = std::max(brightest, L), sum += L;
    }
    if (sky && other) return SkyInView::edge;
  }
  if (brightest > 1.5 * sum / (count / 4)) return SkyInView::edge;  // around the sun, or in an image
  return sky ? SkyInView::all : SkyInView::none;
}

/// The openings over p, but none where much of the sky is in view.
std::vector<std::uint32_t> openings_worth_looking(const Illumination& light, const Vec3& p, const Frame& frame,
                                                  const GatherPattern& pattern, unsigned long long& rays) {
  const std::vector<LightArea>& openings = light.problem.lights.openings;
  if (openings.empty()) return {};
  std::array<Ray, 16> pilots;
  std::array<Hit, 16> met;
  const int step = pattern.bundle().budget().strata() / 16;
  for (int k = 0; k < 16; ++k) {
    const auto& d = pattern.bundle().pilot(k * step);
    pilots[static_cast<std::size_t>(k)] = {p, frame.to_world(d[0], d[1], d[2])};
  }
  light.problem.rays.first_hits(light.problem.patches, pilots, met);
  rays += 16;
  if (sees_much_sky(met)) return {};
  return areas_in_view(
      light.problem.rays, openings, p, frame.n, [&](std::uint32_t) { return p; }, {kMostOpenings, kWorthAShare}, rays);
}

/// What pilot rays of the bundle find in each stratum; 0 where they belong to an opening or a bright area.
std::vector<Spectrum> pilot_values(const View& view, const Frame& frame, const Strata& strata,
                                   unsigned long long& rays) {
  const int count = strata.budget().strata();
  const double share = 1.0 / (count << strata.budget().least());
  std::vector<Spectrum> found(static_cast<std::size_t>(count));
  std::array<Vec3, 16> directions;
  std::array<double, 16> density;
  for (int first = 0; first < count; first += 16) {
    for (int k = 0; k < 16; ++k) {
      const auto& d = strata.pilot(first + k);
      directions[static_cast<std::size_t>(k)] = frame.to_world(d[0], d[1], d[2]);
      density[static_cast<std::size_t>(k)] = cosine_density(d) / share;
    }
    view.look(directions, density, kNobody, std::span(found).subspan(static_cast<std::size_t>(first), 16));
  }
  rays += static_cast<unsigned>(count);
  return found;
}

/// More rays where neighbours differ; the last column of the grid is a neighbour of the first.
RayShares shares_by(const std::vector<Spectrum>& found, const RayBudget& budget) {
  const int g = budget.grid;
  std::vector<double> pilot(found.size());
  std::ranges::transform(found, pilot.begin(), [](const Spectrum& x) { return luminous_mean(x); });
  double sum_of_differences = 0, sum = 0;
  std::vector<double> difference(pilot.size());
  for (int i = 0; i < g; ++i)
    for (int j = 0; j < g; ++j) {
      const auto cell = static_cast<std::size_t>(budget.stratum(i, j));
      double low = pilot[cell], high = low;
      for (int di = -1; di <= 1; ++di)
        for (int dj = -1; dj <= 1; ++dj) {
          if (i + di < 0 || i + di >= g) continue;
          const double near = pilot[static_cast<std::size_t>(budget.stratum(i + di, (j + dj + g) % g))];
          low = std::min(low, near), high = std::max(high, near);
        }
      difference[cell] = high - low;
      sum_of_differences += difference[cell];
      sum += pilot[cell];
    }
  if (!(sum_of_differences > 0)) return {};
  // An even view needs no surplus: all of it is spent once neighbours differ by a quarter of the mean on average.
  const double surplus = (budget.most_rays - budget.rays) * std::min(1.0, 4 * sum_of_differences / sum);
  const double least = std::ldexp(1, budget.least());
  RayShares shares(pilot.size());
  for (std::size_t c = 0; c < pilot.size(); ++c) {
    const double wanted = least + surplus * difference[c] / sum_of_differences;
    shares[c] = static_cast<std::uint8_t>(
        std::clamp(static_cast<int>(std::lround(std::log2(wanted))), budget.least(), budget.deepest()));
  }
  return shares;
}

}  // namespace

bool wants_plan(const Illumination& light, const GatherPattern& pattern) {
  const RayBudget& bundle = pattern.quality().bundle;
  if (!light.bright_areas.shape.empty()) return true;
  if (!light.problem.lights.openings.empty()) return true;
  const auto may_show = [&](const MirrorPlane& mirror) { return is_worth_asking(mirror, light); };
  if (light.sampler.has_bright_patches() && std::ranges::any_of(light.problem.rays.mirrors(), may_show)) return true;
  return !light.sky.dark() && bundle.deepest() > bundle.least();
}

RayShares plan_bundle(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                      const GatherPlan& plan, unsigned long long& rays) {
  const Frame frame(n);
  const View view(light, p, frame, bright_rays(light, pattern, plan), plan);
  return shares_by(pilot_values(view, frame, pattern.bundle(), rays), pattern.bundle().budget());
}

GatherPlan plan_gather(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                       unsigned long long& rays) {
  const Frame frame(n);
  GatherPlan plan;
  GatherPlan owners;  // so far: what an area shares with earlier ones is theirs
  // Light at the point, as far as it is known: what is small beside it need not be known well.
  double known = light.bright_areas.ambient;
  if (!light.problem.lights.empty())
    plan.delta_light = luminous_mean(
        light.sampler.delta_light(p, n, {.sun_rays = 4, .opening_rays = 4, .gloss_rays = 4}, pattern.sun_key()));
  known += plan.delta_light;
  const auto look_at = [&](const LightArea& area, std::uint32_t owner, std::vector<std::uint32_t>& numbers,
                           std::vector<AreaPlan>& plans) {
    const PolygonView polygon(p, n, area.triangles, area.corners);
    if (!(polygon.solid_angle() > 0)) return false;
    const View view(light, p, frame, 0, owners);
    const double F = std::max(1e-12, form_factor(area, p, n));
    AreaPlan found = plan_area(pattern.area_cells(), pattern.quality().area, known / F, [&](auto points, auto values) {
      std::array<PolygonView::Sight, 16> sights;
      for (std::size_t first = 0; first < points.size(); first += 16) {
        const std::size_t count = std::min<std::size_t>(16, points.size() - first);
        AreaView{view, polygon, owner}.look(points.subspan(first, count), values.subspan(first, count), sights);
      }
      rays += points.size();
    });
    if (found.mean.is_black()) return false;
    known += luminous_mean(found.mean) * F;
    numbers.push_back(owner & ~kBrightAreas);
    plans.push_back(std::move(found));
    return true;
  };
  const std::vector<LightArea>& openings = light.problem.lights.openings;
  for (const std::uint32_t k : openings_worth_looking(light, p, frame, pattern, rays)) {
    owners.openings.push_back(k);
    if (!look_at(openings[k], k, plan.openings, plan.opening_plans)) owners.openings.pop_back();
  }
  for (const std::uint32_t k : areas_in_view(
           light.problem.rays, light.bright_areas.shape, p, n, [&](std::uint32_t) { return p; },
           {kMostBrightAreas, kLeastOfBest}, rays)) {
    owners.bright_areas.push_back(k);
    look_at(light.bright_areas.shape[k], kBrightAreas + k, plan.bright_areas, plan.bright_area_plans);
  }
  double left = light.bright_areas.all_flux;
  for (const std::uint32_t k : plan.bright_areas) left -= light.bright_areas.flux[k];
  plan.looks_for_bright_patches =
      (light.bright_areas.shape.empty() || left > kWorthLooking * light.bright_areas.all_flux) &&
      misses_bright_patches(light, p, n, pattern, known, rays);
  plan.mirrors = mirrors_worth_looking(light, p, n, pattern, known, rays);
  plan.rays_in_mirror = pattern.quality().bright_rays;
  const Strata& bundle = pattern.bundle();
  const bool adapts = bundle.budget().deepest() > bundle.budget().least() && !light.sky.dark();
  const SkyInView sky = adapts ? sky_in_view(light, p, frame, pattern, plan.openings, rays) : SkyInView::none;
  if (sky == SkyInView::edge) {
    plan.bundle = plan_bundle(light, p, n, pattern, plan, rays);
  } else if (sky == SkyInView::all) {  // changes slowly all over: half of the surplus, evenly
    const int rays_each = (bundle.budget().rays + bundle.budget().most_rays) / 2 / bundle.budget().strata();
    plan.bundle.assign(static_cast<std::size_t>(bundle.budget().strata()),
                       static_cast<std::uint8_t>(std::bit_width(static_cast<unsigned>(rays_each)) - 1));
  }
  return plan;
}

}  // namespace clerestory
