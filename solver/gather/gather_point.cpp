#include "solver/gather/gather_point.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <span>

#include "solver/model/assert.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/two_estimators.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;
// By judgement: they decide who finds which light, and bias nothing.
constexpr std::size_t kMuchBright = 3;  ///< of 16 rays around
constexpr double kLittle = 0.1;         ///< of it
constexpr double kFoundAnyway = 1.5;    ///< of what these met: no more light that is hard to meet
constexpr double kNarrow = 4;  ///< times the bundle's density of directions: what shadow rays find, and it hardly
constexpr double kWorthAShare = 0.001;  ///< of all light at a point, else it is left to chance
constexpr double kWorthLooking = 0.1;   ///< share of bright patches' light outside of the bright areas looked at
constexpr double kLeastOfBest = 0.2;    ///< of the light of the best bright area, else it has no rays of its own
constexpr std::size_t kMostOpenings = 8, kMostBrightAreas = 4;  ///< that a point looks at by rays of their own
/// Owners of rays: openings and, from kBrightAreas on, bright areas, by number.
constexpr std::uint32_t kBrightAreas = 0x80000000, kNobody = kNoOpening;

/// What comes back along rays from one point.
class View {
 public:
  View(const Illumination& light, const Vec3& p, const Frame& frame, int bright_rays, const GatherPlan& plan)
      : light_(light),
        p_(p),
        frame_(frame),
        bright_rays_(bright_rays),
        plan_(plan),
        at_(light.sampler.receiver(p, frame.n)) {}

  /// Up to 16 rays of one kind: pi times the radiance along each that belongs to `owner`, one of the plan's
  /// openings or bright areas, or kNobody; 0 along the others. density[k]: rays of that kind per solid angle.
  /// found: empty, or set to what each met, weighted so that it makes these values.
  void look(std::span<const Vec3> directions, std::span<const double> density, std::uint32_t owner,
            std::span<Spectrum> values, std::span<RowEntry> found = {}) const {
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    for (std::size_t k = 0; k < directions.size(); ++k) rays[k] = {p_, directions[k]};
    const Problem& problem = light_.problem;
    problem.rays.first_hits(problem.patches, std::span(rays).first(directions.size()), hits);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Hit& hit = hits[k];
      values[k] = Spectrum(0.0);
      if (!found.empty()) found[k] = {};
      if (owner_of(directions[k], hit.first, hit.reflected ? PatchId{} : hit.patch) != owner) continue;
      if (hit.escaped()) {
        const Vec3& direction = hit.direction(rays[k]);
        values[k] = light_.sky(direction) * kPi * hit.transmittance;
        if (!found.empty()) found[k] = RowEntry::of_sky(pack_direction(direction), kPi * hit.transmittance);
      } else if (hit.patch.valid()) {
        Spectrum back = light_.sampler.glow()[hit.patch];
        double share = owner < kBrightAreas ? slit_gain(owner, directions[k], hit.first) : 1;
        back *= share;
        if (owner == kNobody && bright_rays_ > 0) {
          share = balance_heuristic(density[k], bright_rays_ * light_.sampler.density(hit, at_, directions[k], true));
          back *= share;
        }
        values[k] = back * hit.transmittance;
        if (!found.empty()) found[k] = RowEntry::of_patch(hit.patch, share * hit.transmittance);
      }
    }
  }

  const LightTree::Receiver& at() const { return at_; }

  double slit_gain(std::uint32_t number, const Vec3& direction, double distance) const {
    if (light_.slit_gains.gain.empty()) return 1;
    const LightArea& slit = light_.problem.lights.openings[number];
    return light_.slit_gains.of(number, slit, distance - way_out(slit, p_, direction));
  }

  /// Of a ray that meets `patch`, if any, and the first surface at `distance`.
  std::uint32_t owner_of(const Vec3& direction, double distance, PatchId patch) const {
    const std::uint32_t opening =
        first_way_out(light_.problem.lights.openings, plan_.openings, p_, direction, distance);
    if (opening != kNoOpening || !patch.valid() || plan_.bright_areas.empty()) return opening;
    const std::uint32_t bright_area = light_.bright_areas.of(patch);
    return std::ranges::find(plan_.bright_areas, bright_area) == plan_.bright_areas.end() ? kNobody
                                                                                          : kBrightAreas + bright_area;
  }

 private:
  const Illumination& light_;
  Vec3 p_;
  const Frame& frame_;
  int bright_rays_;
  const GatherPlan& plan_;
  LightTree::Receiver at_;
};

int bright_rays(const Illumination& light, const GatherPattern& pattern, const GatherPlan& plan) {
  return plan.looks_for_bright_patches && light.sampler.has_bright_patches() ? pattern.quality().bright_rays : 0;
}

/// Whether a few rays to bright patches bring light that the bundle would find by chance only: those outside of a room
/// are none of its lamps, and a sunlit ground is as wide as what a bundle looks for anyway.
///
/// met  their light by rays around, see wide_bright_light().
bool misses_bright_patches(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           double others, double met, unsigned long long& rays) {
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
    const double cosine = dot(n, normalized(s.end - p)) / kPi;
    shadows.send(p, s.end, {luminous_mean(s.irradiance), s.density > kNarrow * cosine});
    ++rays;
  }
  shadows.trace();
  if (wide + narrow < kFoundAnyway * met && narrow < kLittle * met) return false;
  if (!(narrow > 0)) return light.sky.dark();  // all the light there is comes from somewhere
  return narrow > kWorthAShare * (others + wide + narrow);
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

/// What a few rays around meet: how much of the view is what.
std::array<Hit, 16> look_around(const Illumination& light, const Vec3& p, const Frame& frame,
                                const GatherPattern& pattern, unsigned long long& rays) {
  std::array<Ray, 16> around;
  std::array<Hit, 16> met;
  const int step = pattern.bundle().budget().strata() / 16;
  for (int k = 0; k < 16; ++k) {
    const auto& d = pattern.bundle().pilot(k * step);
    around[static_cast<std::size_t>(k)] = {p, frame.to_world(d[0], d[1], d[2])};
  }
  light.problem.rays.first_hits(light.problem.patches, around, met);
  rays += 16;
  return met;
}

/// Irradiance of bright patches outside of bright areas that rays around met, luminous mean, as if each had brought the
/// median: one may have met a lamp by chance. 0 where too few met any.
double wide_bright_light(const Illumination& light, std::span<const Hit> met) {
  std::vector<double> bright;
  for (const Hit& hit : met) {
    if (hit.reflected || !hit.patch.valid() || !light.sampler.is_bright(hit.patch)) continue;
    if (light.bright_areas.of(hit.patch) != BrightAreas::kNone) continue;
    bright.push_back(luminous_mean(light.sampler.glow()[hit.patch] * hit.transmittance));
  }
  if (bright.size() < kMuchBright) return 0;
  const auto middle = bright.begin() + static_cast<std::ptrdiff_t>((bright.size() - 1) / 2);
  std::nth_element(bright.begin(), middle, bright.end());
  return *middle * static_cast<double>(bright.size()) / static_cast<double>(met.size());
}

std::size_t share_of(const RayShares& shares, const RayBudget& budget, int stratum) {
  return std::size_t{1} << (shares.empty() ? budget.least() : shares[static_cast<std::size_t>(stratum)]);
}

/// Of cosine-distributed directions, per solid angle, in the frame of the normal.
double cosine_density(const std::array<float, 3>& d) { return std::max(1e-6, static_cast<double>(d[2])) / kPi; }

/// Adds what rays met to a row, each ray with its weight.
void add_to_row(std::span<RowEntry> found, std::span<const double> weight, LightRow& row) {
  for (std::size_t k = 0; k < found.size(); ++k) {
    found[k].scale(Spectrum(weight[k]));
    if (!found[k].is_empty()) row.push_back(found[k]);
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
  std::array<RowEntry, 16> found;
  std::array<double, 16> density, share_of_ray;
  std::array<Spectrum, 16> values;
  std::size_t queued = 0;
  Sum sum;
  const auto flush = [&] {
    const auto met = std::span(found).first(row ? queued : 0);
    view.look(std::span(directions).first(queued), density, kNobody, std::span(values).first(queued), met);
    if (row) add_to_row(met, share_of_ray, *row);
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

/// Where to look at an area, how, and who else may own a ray.
struct AreaView {
  const View& view;
  const PolygonView& polygon;
  std::uint32_t owner;

  /// Up to 16 points.
  void look(std::span<const std::array<float, 2>> points, std::span<Spectrum> values,
            std::span<PolygonView::Sight> sights, std::span<RowEntry> found = {}) const {
    std::array<Vec3, 16> directions;
    std::array<double, 16> density{};  // counts for rays that belong to nobody only
    for (std::size_t k = 0; k < points.size(); ++k) {
      sights[k] = polygon.look(points[k][0], points[k][1]);
      directions[k] = sights[k].direction;
    }
    view.look(std::span(directions).first(points.size()), density, owner, values, found);
  }
};

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
  std::array<RowEntry, 16> found;
  std::array<double, 16> weight;
  Spectrum by_rays(0.0);
  const std::size_t begin = row ? row->size() : 0;
  for (std::size_t first = 0; first < plan.size(); first += 16) {
    const std::size_t count = std::min<std::size_t>(16, plan.size() - first);
    for (std::size_t k = 0; k < count; ++k) {
      const AreaCell cell = plan[first + k];
      points[k] = cells.points(cell.grid)[cell.number];
    }
    const auto met = std::span(found).first(row ? count : 0);
    view.look(std::span(points).first(count), std::span(values).first(count), sights, met);
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
    if (row) add_to_row(met, weight, *row);
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
                        const GatherPlan& plan, const View& view, LightRow* row) {
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
    const std::size_t share = share_of(plan.bundle, budget, plan.bundle.empty() ? 0 : pattern.stratum_of(frame, d));
    const double bundle = static_cast<double>(share) * budget.strata() * dot(frame.n, d) / kPi;
    const double share_of_both = balance_heuristic(count * s.density, bundle);
    shadows.send(p, s.end, {s.irradiance * share_of_both, s.patch, s.weight * share_of_both});
  }
  shadows.trace();
  return sum / count;
}

}  // namespace

bool wants_plan(const Illumination& light, const GatherPattern& pattern) {
  const RayBudget& bundle = pattern.quality().bundle;
  if (!light.bright_areas.shape.empty()) return true;
  if (!light.problem.lights.openings.empty()) return true;
  return !light.sky.dark() && bundle.deepest() > bundle.least();
}

GatherPlan plan_gather(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                       unsigned long long& rays) {
  const Frame frame(n);
  GatherPlan plan;
  GatherPlan owners;  // so far: what an area shares with earlier ones is theirs
  // Light at the point, as far as it is known: what is small beside it need not be known well.
  double known = light.bright_areas.ambient;
  if (!light.problem.lights.empty())
    plan.delta_light =
        luminous_mean(light.sampler.delta_light(p, n, {.sun_rays = 4, .opening_rays = 4}, pattern.sun_key()));
  known += plan.delta_light;
  const std::array<Hit, 16> around = look_around(light, p, frame, pattern, rays);
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
  std::vector<std::uint32_t> over;
  if (!sees_much_sky(around)) over = areas_over(openings, p, n, kMostOpenings, 0);
  for (const std::uint32_t k : over) {
    owners.openings.push_back(k);
    if (!look_at(openings[k], k, plan.openings, plan.opening_plans)) owners.openings.pop_back();
  }
  for (const std::uint32_t k : areas_over(light.bright_areas.shape, p, n, kMostBrightAreas, kLeastOfBest)) {
    owners.bright_areas.push_back(k);
    look_at(light.bright_areas.shape[k], kBrightAreas + k, plan.bright_areas, plan.bright_area_plans);
  }
  double left = light.bright_areas.all_flux;
  for (const std::uint32_t k : plan.bright_areas) left -= light.bright_areas.flux[k];
  plan.looks_for_bright_patches =
      (light.bright_areas.shape.empty() || left > kWorthLooking * light.bright_areas.all_flux) &&
      misses_bright_patches(light, p, n, pattern, known, wide_bright_light(light, around), rays);
  const Strata& bundle = pattern.bundle();
  const bool adapts = bundle.budget().deepest() > bundle.budget().least() && !light.sky.dark();
  const SkyInView sky = adapts ? sky_in_view(light, p, frame, pattern, plan.openings, rays) : SkyInView::none;
  if (sky == SkyInView::edge) {
    const View view(light, p, frame, bright_rays(light, pattern, plan), plan);
    plan.bundle = shares_by(pilot_values(view, frame, bundle, rays), bundle.budget());
  } else if (sky == SkyInView::all) {  // changes slowly all over: half of the surplus, evenly
    const int rays_each = (bundle.budget().rays + bundle.budget().most_rays) / 2 / bundle.budget().strata();
    plan.bundle.assign(static_cast<std::size_t>(bundle.budget().strata()),
                       static_cast<std::uint8_t>(std::bit_width(static_cast<unsigned>(rays_each)) - 1));
  }
  return plan;
}

GatheredLight gather_point(const Illumination& light, const Vec3& p, const Vec3& n, const GatherPattern& pattern,
                           const GatherPlan& plan, unsigned long long& rays, LightRow* row) {
  if (row) row->clear();
  const int to_bright_patches = bright_rays(light, pattern, plan);
  const Frame frame(n);
  const View view(light, p, frame, to_bright_patches, plan);
  Sum sum = from_bundle(view, frame, pattern.bundle(), plan.bundle, rays, row);
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

  GatheredLight at{sum.E, Spectrum(0.0), std::sqrt(sum.variance)};
  if (to_bright_patches > 0) {
    at.E += bright_patches(light, p, frame, pattern, plan, view, row);
    rays += static_cast<unsigned>(to_bright_patches);
  }
  // Where it is all but dark, what differs from a plan's mean may leave less than nothing.
  at.E = {std::max(0.0, at.E[0]), std::max(0.0, at.E[1]), std::max(0.0, at.E[2])};
  if (!light.problem.lights.empty()) {
    at.delta_light = light.sampler.delta_light(p, n, {.sun_rays = pattern.quality().sun_rays}, pattern.sun_key(), row);
    at.E += at.delta_light;
  }
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
