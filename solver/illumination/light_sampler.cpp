#include "solver/illumination/light_sampler.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numbers>

#include "solver/illumination/image_beams.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/assert.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

LightBounds bounds_of_patch(const PatchSet& patches, PatchId q, double flux) {
  const auto c = patches.corner_positions(q);
  return {{std::min({c[0].x, c[1].x, c[2].x}), std::min({c[0].y, c[1].y, c[2].y}), std::min({c[0].z, c[1].z, c[2].z})},
          {std::max({c[0].x, c[1].x, c[2].x}), std::max({c[0].y, c[1].y, c[2].y}), std::max({c[0].z, c[1].z, c[2].z})},
          patches.normal[q],
          0,
          flux};
}

/// Circular cross-section of the scene: what a sun lights at most [m2].
double cross_section(const RayScene& rays) { return std::numbers::pi / 4 * rays.diameter() * rays.diameter(); }

}  // namespace

double area_median(const PatchSet& patches, const Field& glow, const std::vector<bool>& counts) {
  // The bits of a positive float order like its value: three passes over histograms of 11, 11 and 10 of them need no
  // memory.
  const auto bits = [&](std::size_t i) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(std::max(luminous_mean(glow[i]), 0.0)));
  };
  const auto area_of = [&](std::size_t i) { return counts.empty() || counts[i] ? patches.area[i] : 0; };
  double half = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) half += area_of(i);
  half /= 2;
  std::uint32_t found = 0, known = 0;
  for (const int shift : {21, 10, 0}) {
    std::vector<double> area(2048, 0.0);
    for (std::size_t i = 0; i < patches.patch_count(); ++i)
      if (const std::uint32_t b = bits(i); (b & known) == found) area[(b >> shift) & 2047] += area_of(i);
    std::uint32_t bin = 0, last = 0;
    for (; bin < area.size() && half > 0; ++bin)
      if (area[bin] > 0) {
        last = bin;
        if (half <= area[bin]) break;
        half -= area[bin];
      }
    found |= last << shift;
    known |= 2047u << shift;
  }
  return std::bit_cast<float>(found);
}

LightSampler::LightSampler(const Problem& problem, const Field& glow)
    : problem_(problem), glow_(glow), gloss_(problem) {
  const PatchSet& patches = problem.patches;
  const Lights& lights = problem.lights;
  const double extent = problem.rays.diameter();

  std::vector<LightBounds> light_bounds;
  const double bright = kBrighter * area_median(patches, glow);
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double B = luminous_mean(glow[i]), flux = B * patches.area[i];
    const bool is_spot = !patches.spot.empty() && patches.spot[i];
    if (!(B > bright || is_spot) || !(flux > 0)) continue;
    if (bright_.empty()) number_of_patch_.assign(patches.patch_count(), LightTree::kNone);
    number_of_patch_[i] = static_cast<std::uint32_t>(bright_.size());
    bright_.push_back(static_cast<std::uint32_t>(i));
    light_bounds.push_back(bounds_of_patch(patches, PatchId{i}, flux));
    patches_power_ += flux;
  }
  patches_ = LightTree(light_bounds, Falloff::cosine, extent);

  light_bounds.clear();
  for (const PlacedLuminaire& luminaire : lights.luminaires) {
    light_bounds.push_back(bounds(luminaire));
    light_bounds.back().power *= luminaire.share;
    luminaires_power_ += luminaire.share * luminous_mean(power(luminaire));
  }
  if (luminaires_power_ > 0) luminaires_ = LightTree(light_bounds, Falloff::none, extent);
  for (const PlacedSun& sun : lights.suns)
    suns_power_ += sun.share * luminous_mean(sun.normal_irradiance) * cross_section(problem.rays);
}

LightSampler::Shares LightSampler::shares(const Vec3& p, const Vec3& n) const {
  if (luminaires_power_ == 0 && suns_power_ == 0) return {1, 0, 0};
  Shares s;
  if (patches_.reaches(p, n)) s.patches = patches_power_;
  if (luminaires_power_ > 0 && luminaires_.reaches(p, n)) s.luminaires = luminaires_power_;
  for (const Sun& sun : problem_.lights.suns)
    if (dot(n, sun.direction) > -0.01) s.suns = suns_power_;  // the disc is half a degree wide
  const double sum = s.patches + s.luminaires + s.suns;
  if (!(sum > 0)) return {};
  // Half of the choice is even: power says little about a luminaire indoors beside a sun that does not get in.
  const int groups = (s.patches > 0) + (s.luminaires > 0) + (s.suns > 0);
  for (double* share : {&s.patches, &s.luminaires, &s.suns})
    if (*share > 0) *share = (*share / sum + 1.0 / groups) / 2;
  return s;
}

LightSample LightSampler::sample(const LightTree::Receiver& at, double pick, double u, double v,
                                 bool bright_patches_only) const {
  if (bright_patches_only) return on_patch(at, pick, u, v, 1);
  const Vec3 &p = at.p, &n = at.n;
  const Shares s = shares(p, n);
  const double luminaires_end = s.patches + s.luminaires;
  if (pick < s.patches) return on_patch(at, pick / s.patches, u, v, s.patches);
  if (s.luminaires > 0 && (pick < luminaires_end || !(s.suns > 0)))
    return on_luminaire(p, n, (pick - s.patches) / s.luminaires, u, v, s.luminaires);
  if (s.suns > 0) return on_sun(p, n, (pick - luminaires_end) / s.suns, u, v, s.suns);
  return s.patches > 0 ? on_patch(at, pick, u, v, s.patches) : LightSample{};
}

LightSample LightSampler::on_patch(const LightTree::Receiver& at, double pick, double u, double v, double share) const {
  const LightTree::Choice choice = patches_.choose(at, pick);
  if (!(choice.probability > 0)) return {};
  const double probability = share * choice.probability;
  const PatchId q{bright_[choice.light]};
  const Vec3 normal = problem_.patches.normal[q];
  const Vec3 point = point_on_triangle(problem_.patches.corner_positions(q), u, v);
  const double kernel = point_kernel(at.p, at.n, point, normal);
  if (kernel == 0) return {};
  const Vec3 d = point - at.p;
  const double r2 = dot(d, d), cos_q = -dot(normal, d) / std::sqrt(r2), area = problem_.patches.area[q];
  CLERESTORY_ASSERT(cos_q, >, 0);
  const double weight = kernel * area / probability;
  return {
      problem_.rays.off_surface(point, normal), glow_[q] * weight, probability * r2 / (cos_q * area), q, {}, weight};
}

LightSample LightSampler::on_luminaire(const Vec3& p, const Vec3& n, double pick, double u, double v,
                                       double share) const {
  const LightTree::Choice choice = luminaires_.choose({luminaires_, p, n}, pick);
  if (!(choice.probability > 0)) return {};
  const PlacedLuminaire& luminaire = problem_.lights.luminaires[choice.light];
  const Vec3 q = light_point(luminaire, p, u, v);
  const double probability = share * choice.probability;
  const Vec3 end = shadow_segment(luminaire, q, p).to;
  const Spectrum irradiance = open_irradiance(luminaire, q, p, n) / probability;
  return {end, irradiance, 0, {}, luminaire.way, 0, choice.light, probability};
}

double LightSampler::probability_of(const PlacedSun& sun, double share) const {
  const double power = sun.share * luminous_mean(sun.normal_irradiance);
  return share * power * cross_section(problem_.rays) / suns_power_;
}

LightSample LightSampler::on_sun(const Vec3& p, const Vec3& n, double pick, double u, double v, double share) const {
  double left = pick * suns_power_ / cross_section(problem_.rays);
  const PlacedSun* sun = nullptr;
  double power = 0;
  for (const PlacedSun& candidate : problem_.lights.suns) {
    const double candidate_power = candidate.share * luminous_mean(candidate.normal_irradiance);
    if (!(candidate_power > 0)) continue;
    if (sun) left -= power;
    sun = &candidate, power = candidate_power;
    if (left < power) break;
  }
  const Vec3 d = direction_to_sun(*sun, u, v);
  const double cos_n = dot(n, d), probability = probability_of(*sun, share);
  if (!(cos_n > 0)) return {};
  const std::size_t number =
      problem_.lights.luminaires.size() + static_cast<std::size_t>(sun - problem_.lights.suns.data());
  const Vec3 end = p + d * (4 * problem_.rays.diameter());
  const Spectrum irradiance = sun->normal_irradiance * (cos_n / probability);
  return {end, irradiance, 0, {}, sun->way, 0, static_cast<std::uint32_t>(number), probability};
}

double LightSampler::probability(std::uint32_t light, const Vec3& p, const Vec3& n) const {
  const std::size_t luminaires = problem_.lights.luminaires.size();
  const Shares s = shares(p, n);
  if (light >= luminaires) return probability_of(problem_.lights.suns[light - luminaires], s.suns);
  return s.luminaires > 0 ? s.luminaires * luminaires_.probability(light, {luminaires_, p, n}) : 0;
}

double LightSampler::density(PatchId q, const LightTree::Receiver& at, double distance, double cos_q,
                             bool bright_patches_only) const {
  if (!(cos_q > 0)) return 0;
  const double share = bright_patches_only ? 1.0 : shares(at.p, at.n).patches;
  return share * patches_.probability(number_of_patch_[q], at) * distance * distance /
         (cos_q * problem_.patches.area[q]);
}

double LightSampler::density(const Hit& hit, const LightTree::Receiver& at, const Vec3& d,
                             bool bright_patches_only) const {
  if (!can_choose(hit)) return 0;
  return density(hit.patch, at, hit.distance, -dot(problem_.patches.normal[hit.patch], d), bright_patches_only);
}

Spectrum LightSampler::delta_light(const Vec3& p, const Vec3& n, const DeltaEffort& effort, std::uint64_t key,
                                   LightRow* row) const {
  const RayScene& rays = problem_.rays;
  struct Load {
    Spectrum irradiance;
    std::size_t number;
  };
  Spectrum E(0.0);
  const auto arrive = [&](const Spectrum& irradiance, std::size_t number) {
    E += irradiance;
    if (row && !irradiance.is_black()) row->push_back(RowEntry::of_light(number, irradiance));
  };
  auto shadows = shadow_rays<Load>(
      rays, [&](const Load& load, const Spectrum& passes) { arrive(load.irradiance * passes, load.number); });
  const auto look = [&](const ShadowSegment& way, const Spectrum& irradiance, std::size_t number,
                        const MirrorWay& over) {
    if (irradiance.is_black()) return;
    if (way.is_free)
      arrive(irradiance, number);
    else if (!over.empty())
      arrive(irradiance * rays.transmittance_by_mirrors(way.from, way.to, over), number);
    else
      shadows.send(way.from, way.to, {irradiance, number});
  };
  // In the tree's order luminaires that share a packet are neighbours.
  for (const std::uint32_t number : luminaires_.order()) {
    const PlacedLuminaire& luminaire = problem_.lights.luminaires[number];
    const int count = std::min(effort.opening_rays, opening_rays(luminaire, p));
    if (count == 1) {
      look(shadow_segment(luminaire, luminaire.position, p), open_irradiance(luminaire, p, n), number, luminaire.way);
      continue;
    }
    for (int k = 0; k < count; ++k) {
      const OpeningPlace at = opening_place(luminaire, k, count);
      const Vec3 q = light_point(luminaire, p, at.u, at.v);
      look(shadow_segment(luminaire, q, p), open_irradiance(luminaire, q, p, n) * at.weight, number, luminaire.way);
    }
  }
  shadows.trace();
  for (std::size_t number = 0; number < problem_.lights.suns.size(); ++number) {
    const PlacedSun& sun = problem_.lights.suns[number];
    if (!may_reach(rays, sun, {&p, 1})) continue;
    for (int k = 0; k < effort.sun_rays; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), key);
      const Vec3 d = direction_to_sun(sun, u[0], u[1]);
      look({p, p + d * (4 * rays.diameter()), false},
           sun.normal_irradiance * (std::max(dot(n, d), 0.0) / effort.sun_rays),
           problem_.lights.luminaires.size() + number, sun.way);
    }
    shadows.trace();
  }
  return E + gloss_.irradiance(p, n, effort.gloss_rays, key, row).sum();
}

}  // namespace clerestory
