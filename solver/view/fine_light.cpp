#include "solver/view/fine_light.h"

#include <array>
#include <cmath>
#include <vector>

#include "solver/illumination/caustic_light.h"
#include "solver/illumination/image_beams.h"
#include "solver/illumination/one_light.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kMostCandidates = 64;
constexpr std::size_t kMostRays = 8;
constexpr int kRaysOfPoint = 16;  // of a result: to the sun, and to openings at most

}  // namespace

/// A point of a light, and what it would give if nothing were between.
struct FineLight::Candidate {
  Spectrum sent{0.0};
  double brightness = 0;  ///< luminous mean of it
  ShadowSegment segment{};
  const MirrorWay* way = nullptr;
};

FineLight::FineLight(const Problem& problem, const VertexLightmap* points) : problem_(problem), gloss_(problem_) {
  if (points && !problem_.lights.caustics.legs.empty()) caustics_.emplace(problem_, *points);
  if (luminaires() + suns() > kMostCandidates) choice_ = choice_of_lights(problem_);
}

FineLight::Candidate FineLight::candidate(std::uint32_t light, const Vec3& p, const SeenPlace& at, double u,
                                          double v) const {
  Candidate c;
  Vec3 to_light;
  Spectrum E;
  if (light < luminaires()) {
    const PlacedLuminaire& luminaire = problem_.lights.luminaires[light];
    const Vec3 q = light_point(luminaire, p, u, v);
    E = open_irradiance(luminaire, q, p, at.n);
    if (E.is_black()) return c;
    to_light = normalized(q - p);
    c.segment = shadow_segment(luminaire, q, p);
    c.way = &luminaire.way;
  } else {
    const PlacedSun& sun = problem_.lights.suns[light - luminaires()];
    to_light = direction_to_sun(sun, u, v);
    E = sun.normal_irradiance * std::max(0.0, dot(at.n, to_light));
    if (E.is_black() || (sun.is_image() && !may_reach(problem_.rays, sun, {&p, 1}))) return c;
    c.segment = {p, p + to_light * (4 * problem_.rays.diameter()), false};
    c.way = &sun.way;
  }
  c.sent = at.diffuse * E;
  if (at.lobe) c.sent += at.lobe->evaluate(at.n, to_light, at.to_eye) * E;
  c.brightness = luminous_mean(c.sent);
  return c;
}

Spectrum FineLight::sent_on(const SeenPlace& at, const Draw& draw) const {
  const RayScene& rays = problem_.rays;
  const Vec3 p = rays.off_surface(at.p - problem_.patches.origin, at.facet);
  std::array<Candidate, kMostCandidates> candidates;
  std::size_t count = 0;
  double sum = 0;
  const auto consider = [&](std::uint32_t light, const std::array<double, 4>& u, double weight) {
    Candidate& c = candidates[count] = candidate(light, p, at, u[0], u[1]);
    c.sent *= weight, c.brightness *= weight;
    if (!(c.brightness > 0)) return;
    sum += c.brightness;
    ++count;
  };
  const auto numbers = [&](std::uint32_t k) { return sobol4(draw.number, stream_key(draw.key, kLightsSeen, k)); };
  if (choice_.empty()) {
    for (std::uint32_t light = 0; light < luminaires() + suns(); ++light) consider(light, numbers(light), 1);
  } else {
    for (std::uint32_t k = 0; k < kMostCandidates; ++k) {
      const auto u = numbers(k);
      const LightTree::Choice choice = choice_.choose(p, at.n, (k + u[2]) / kMostCandidates);
      if (choice.probability > 0) consider(choice.light, u, 1 / (kMostCandidates * choice.probability));
    }
  }
  Spectrum sent(0.0);
  auto shadows =
      shadow_rays<Spectrum>(rays, [&](const Spectrum& of_light, const Spectrum& passes) { sent += of_light * passes; });
  const auto look = [&](const Candidate& c, double weight) {
    if (c.segment.is_free)
      sent += c.sent * weight;
    else if (!c.way->empty())
      sent += c.sent * weight * rays.transmittance_by_mirrors(c.segment.from, c.segment.to, *c.way);
    else
      shadows.send(c.segment.from, c.segment.to, c.sent * weight);
  };
  if (count <= kMostRays) {
    for (std::size_t k = 0; k < count; ++k) look(candidates[k], 1);
  } else {
    // As many steps of equal length along the candidates, laid out by their brightness, as there are rays.
    const double step = sum / kMostRays;
    double next = step * numbers(kMostCandidates)[0], end = 0;
    for (std::size_t k = 0; k < count; ++k) {
      end += candidates[k].brightness;
      int steps = 0;
      for (; next < end; next += step) ++steps;
      if (steps > 0) look(candidates[k], steps * step / candidates[k].brightness);
    }
  }
  shadows.trace();
  return sent;
}

Spectrum FineLight::caustics(const SeenPlace& at) const {
  if (!caustics_) return Spectrum(0.0);
  return caustics_->sent_on(at.p - problem_.patches.origin, at.facet, at.to_eye, at.diffuse, at.lobe);
}

Field FineLight::caustics_at(std::span<const SensorPoint> points) const {
  if (!caustics_) return {};
  return caustic_irradiance(problem_, points.size(),
                            [&](std::size_t i) {
                              const auto& [place, n] = points[i];
                              return ReceivingPoint{problem_.rays.off_surface(place - problem_.patches.origin, n), n};
                            })
      .E;
}

Spectrum FineLight::by_gloss(const Vec3& p, const Vec3& n, int pairs, std::uint64_t key) const {
  return gloss_.irradiance(problem_.rays.off_surface(p - problem_.patches.origin, n), n, pairs, key).sum();
}

StraightLight FineLight::at_point(const Vec3& place, const Vec3& n) const {
  const RayScene& rays = problem_.rays;
  const Vec3 p = rays.off_surface(place - problem_.patches.origin, n);
  StraightLight found;
  SeenPlace at;
  at.n = n;
  const auto look = [&](std::uint32_t light, int count, const auto& point) {
    Spectrum E(0.0), open(0.0);
    int seen = 0;
    auto shadows = shadow_rays<Spectrum>(rays, [&](const Spectrum& of_ray, const Spectrum& passes) {
      E += of_ray * passes;
      ++seen;
    });
    for (int k = 0; k < count; ++k) {
      const OpeningPlace from = point(k);
      Candidate c = candidate(light, p, at, from.u, from.v);
      c.sent *= from.weight;
      if (c.sent.is_black()) continue;
      open += c.sent;
      if (c.segment.is_free) {
        E += c.sent;
        ++seen;
      } else if (!c.way->empty()) {
        const Spectrum passes = rays.transmittance_by_mirrors(c.segment.from, c.segment.to, *c.way);
        E += c.sent * passes;
        seen += passes.is_black() ? 0 : 1;
      } else {
        shadows.send(c.segment.from, c.segment.to, c.sent);
      }
    }
    shadows.trace();
    // Twice the largest standard error of a share that some of the rays find.
    const double off = seen > 0 && seen < count ? 1 / std::sqrt(count) : 0;
    found.E += E;
    for (int k = 0; k < kMaxChannels; ++k) {
      found.low[k] += std::max(0.0, E[k] - off * open[k]);
      found.high[k] += std::min(std::max(open[k], E[k]), E[k] + off * open[k]);
    }
  };
  for (std::uint32_t light = 0; light < luminaires(); ++light) {
    const PlacedLuminaire& luminaire = problem_.lights.luminaires[light];
    const int count = std::min(kRaysOfPoint, opening_rays(luminaire, p));
    look(light, count, [&](int k) {
      return count == 1 ? OpeningPlace{0.5, 0.5, 1} : opening_place(luminaire, k, count);
    });
  }
  for (std::uint32_t light = luminaires(); light < luminaires() + suns(); ++light)
    look(light, kRaysOfPoint, [](int k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), kLightsOfPoints);
      return OpeningPlace{u[0], u[1], 1.0 / kRaysOfPoint};
    });
  return found;
}

}  // namespace clerestory
