#include "solver/illumination/direct.h"

#include <algorithm>
#include <numbers>

#include "solver/lights/beam.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/luminaire_view.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/assert.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

/// A way from a point of a patch to a light, not yet known to be free.
struct ShadowTry {
  ShadowSegment way;
  Spectrum irradiance;       ///< when nothing blocks
  std::uint32_t number = 0;  ///< of the light, see Layer::lights
  std::uint32_t mirror = kNoMirror;
};

constexpr double kRaysOfAll = 1 << 14;  ///< for all the flux of a luminaire: of patches near it that are partly hidden

/// Mean irradiance of patch i from shadow rays.
class PatchSampler {
 public:
  /// row: null, or where to add what is found, by light.
  PatchSampler(const Problem& problem, std::size_t patch, const DirectOptions& options, LightRow* row)
      : problem_(problem),
        patch_(patch),
        corners_(problem.patches.corner_positions(PatchId{patch})),
        normal_(problem.patches.normal[patch]),
        key_(stream_key(options.seed, kShadowPointsOfPatch, patch)),
        options_(options),
        row_(row) {}

  const Vec3& normal() const { return normal_; }
  Vec3 centre() const { return (corners_[0] + corners_[1] + corners_[2]) / 3; }
  /// Whether any of the luminaire may be in front of any of the patch.
  bool faces(const PlacedLuminaire& luminaire) const {
    if (is_mounted_in(luminaire, corners_[0], normal_)) return false;
    return std::any_of(corners_.begin(), corners_.end(),
                       [&](const Vec3& c) { return dot(normal_, luminaire.position - c) > -reach(luminaire); });
  }

  /// What the luminaire can give here without blockers, roughly; 0 only where it cannot give anything [W/m2].
  double estimate(const PlacedLuminaire& luminaire) const {
    if (!faces(luminaire)) return 0;
    const Vec3 middle = centre();
    double sum = 0, size2 = 0;
    for (const Vec3& p : {corners_[0], corners_[1], corners_[2], middle}) {
      sum += luminous_mean(open_irradiance(luminaire, p, normal_));
      size2 = std::max(size2, dot(p - middle, p - middle));
    }
    // A beam may miss the four points; and a luminaire in the middle of the patch is not as bright as it seems from
    // there.
    const Vec3 d = luminaire.position - middle;
    const double all_round = luminous_mean(power(luminaire)) / (4 * std::numbers::pi * (dot(d, d) + size2));
    return std::min(sum / 4, 10 * all_round) + 0.05 * all_round;
  }

  bool is_behind(const PlacedLuminaire& luminaire, const Beam& beam) const {
    return clerestory::is_behind(luminaire, beam, corners_);
  }
  /// Whether the patch has to be looked at from the luminaire: points spread over it would not do.
  bool is_near(const PlacedLuminaire& luminaire, const Beam& beam) const {
    return wants_view(luminaire, beam, corners_);
  }

  /// What the luminaire gives, by the solid angle of the patch: exact where nothing blocks.
  Spectrum by_view(std::uint32_t number, const PlacedLuminaire& luminaire, const Beam& beam) const {
    LuminaireView view(luminaire, beam, corners_, normal_);
    const Spectrum per_flux = power(luminaire) / (beam.flux * problem_.patches.area[patch_]);
    const Vec3 middle = centre();
    const auto try_of = [&](double flux, const Vec3& q, const std::array<double, 4>& u) -> ShadowTry {
      const Vec3 from = problem_.rays.off_surface(view.lit_point(u[0], u[1]), normal_);
      return {shadow_segment(luminaire, q, from), per_flux * flux, number, luminaire.mirror};
    };
    if (opening_rays(luminaire, middle) == 1) {
      const double flux = view.look_from(luminaire.position);
      if (!(flux > 0)) return Spectrum(0.0);
      // What is partly hidden of so much light deserves more rays.
      const int edge_rays = options_.edge_rays <= options_.shadow_rays
                                ? options_.edge_rays
                                : std::max(options_.edge_rays, static_cast<int>(kRaysOfAll * flux / beam.flux));
      return mean_of_tries([&](std::uint32_t, std::uint64_t,
                               const std::array<double, 4>& u) { return try_of(flux, luminaire.position, u); },
                           options_.shadow_rays, edge_rays);
    }
    // All patches near by look from the same points of the opening, so that their sum is exact for each.
    const std::uint64_t places = stream_key(options_.seed, kPointsOfLuminaire, number);
    return mean_of_tries(
        [&](std::uint32_t k, std::uint64_t, const std::array<double, 4>& u) -> ShadowTry {
          const auto place = sobol4(k, places);
          const Vec3 q = light_point(luminaire, middle, place[0], place[1]);
          const double flux = view.look_from(q, true);
          return flux > 0 ? try_of(flux, q, u) : ShadowTry{};
        },
        options_.edge_rays, options_.edge_rays);
  }

  /// The mean over points of the patch where light(point, u, v, pick) gives the way and the irradiance; pick() is a
  /// number to choose by. wide: the light comes from all over an opening, which sixteen rays know to a few per cent
  /// only.
  template <class Light>
  Spectrum mean(const Light& light, bool wide = false) const {
    return mean_of_tries(
        [&](std::uint32_t k, std::uint64_t key, const std::array<double, 4>& u) {
          const Vec3 from = problem_.rays.off_surface(point_on_triangle(corners_, u[0], u[1]), normal_);
          return light(from, u[2], u[3], [&] { return sobol4(k, key + 1)[0]; });
        },
        std::min(options_.edge_rays, options_.shadow_rays * (wide ? 4 : 1)), options_.edge_rays);
  }

 private:
  /// rays  where a pilot sees no edge; edge_rays: where it does.
  template <class TryOf>
  Spectrum mean_of_tries(const TryOf& try_of, int rays, int edge_rays) const {
    if (edge_rays <= rays) return kept(look(key_, rays, try_of).sum / rays, rays);
    // The pilot only decides. Its values, kept where it saw no edge, would lose the light of spots that it mostly
    // misses; rays that continue its sequence would find too much there, as they fall where its own did not.
    const Tally pilot = look(mix_bits(key_), options_.shadow_rays, try_of);
    const bool on_an_edge = pilot.visible > 0 && pilot.visible < pilot.facing;
    const int count = on_an_edge ? edge_rays : rays;
    return kept(look(key_, count, try_of).sum / count, count);
  }

  struct Tally {
    Spectrum sum{0.0};
    int facing = 0, visible = 0;
  };

  /// What the last look() found, for the row: sums over its rays, by light.
  struct OfLight {
    std::uint32_t number;
    Spectrum sum;
  };
  void note(std::uint32_t number, const Spectrum& irradiance) const {
    const auto known = std::ranges::find(found_, number, &OfLight::number);
    if (known == found_.end())
      found_.push_back({number, irradiance});
    else
      known->sum += irradiance;
  }
  Spectrum kept(const Spectrum& E, int rays) const {
    if (row_)
      for (const OfLight& light : found_) row_->push_back(RowEntry::of_light(light.number, light.sum / rays));
    return E;
  }

  struct Load {
    Spectrum irradiance;
    std::uint32_t number;
  };

  template <class TryOf>
  Tally look(std::uint64_t key, int count, const TryOf& try_of) const {
    const RayScene& rays = problem_.rays;
    Tally tally;
    found_.clear();
    auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Vec3& from, const Vec3& to) {
      const Spectrum arrives = load.irradiance * rays.glass_transmittance(from, to);
      tally.sum += arrives;
      ++tally.visible;
      if (row_) note(load.number, arrives);
    });
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
      const ShadowTry to_light = try_of(k, key, sobol4(k, key));
      if (to_light.irradiance.is_black()) continue;
      ++tally.facing;
      const auto& [from, to, is_free] = to_light.way;
      if (to_light.mirror == kNoMirror && !is_free) {
        shadows.send(from, to, {to_light.irradiance, to_light.number});
        continue;
      }
      const Spectrum passes = is_free ? Spectrum(1.0) : rays.transmittance_by_mirror(from, to, to_light.mirror);
      tally.sum += to_light.irradiance * passes;
      tally.visible += !passes.is_black();
      if (row_ && !passes.is_black()) note(to_light.number, to_light.irradiance * passes);
    }
    shadows.trace();
    return tally;
  }

  const Problem& problem_;
  std::size_t patch_;
  std::array<Vec3, 3> corners_;
  Vec3 normal_;
  std::uint64_t key_;
  const DirectOptions& options_;
  LightRow* row_;
  mutable std::vector<OfLight> found_;
};

Spectrum from_luminaire(const Lights& lights, std::span<const Beam> beams, std::uint32_t number,
                        const PatchSampler& patch) {
  const PlacedLuminaire& luminaire = lights.luminaires[number];
  if (!patch.faces(luminaire) || patch.is_behind(luminaire, beams[number])) return Spectrum(0.0);
  if (patch.is_near(luminaire, beams[number])) return patch.by_view(number, luminaire, beams[number]);
  return patch.mean(
      [&](const Vec3& p, double u, double v, const auto&) -> ShadowTry {
        const Vec3 q = light_point(luminaire, p, u, v);
        return {shadow_segment(luminaire, q, p), open_irradiance(luminaire, q, p, patch.normal()), number,
                luminaire.mirror};
      },
      opening_rays(luminaire, patch.centre()) > 4);
}

/// The luminaires over one patch. Those that give much of its light are looked at one by one; the others, however many,
/// share the rays of one, each ray to a luminaire chosen in proportion to what it can give.
Spectrum from_luminaires(const Lights& lights, std::span<const Beam> beams, const PatchSampler& patch) {
  constexpr std::size_t kFew = 4;    // luminaires that need no choice
  constexpr double kMuch = 1.0 / 6;  // of what all can give
  Spectrum E(0.0);
  if (lights.luminaires.size() <= kFew) {
    for (std::uint32_t number = 0; number < lights.luminaires.size(); ++number)
      E += from_luminaire(lights, beams, number, patch);
    return E;
  }
  struct Over {
    std::uint32_t number;
    double gives;  ///< estimate without blockers, > 0 where the luminaire can give anything [W/m2]
    bool wide;     ///< from all over an opening
  };
  thread_local std::vector<Over> over;
  over.clear();
  double all = 0;
  for (std::uint32_t number = 0; number < lights.luminaires.size(); ++number) {
    const PlacedLuminaire& luminaire = lights.luminaires[number];
    if (patch.is_behind(luminaire, beams[number])) continue;
    if (patch.faces(luminaire) && patch.is_near(luminaire, beams[number])) {
      E += patch.by_view(number, luminaire, beams[number]);
      continue;
    }
    const double gives = patch.estimate(luminaire);
    if (gives > 0) over.push_back({number, gives, opening_rays(luminaire, patch.centre()) > 4});
    all += gives;
  }
  bool wide = false;
  double shared = 0;  // becomes the running sum over luminaires that share rays
  std::size_t kept = 0;
  for (const Over& luminaire : over) {
    if (luminaire.gives > kMuch * all) {
      E += from_luminaire(lights, beams, luminaire.number, patch);
    } else {
      shared += luminaire.gives;
      wide = wide || luminaire.wide;
      over[kept++] = {luminaire.number, shared, false};
    }
  }
  over.resize(kept);
  if (!(shared > 0)) return E;
  const auto chosen = [&](double pick) {
    const auto at = std::upper_bound(over.begin(), over.end(), pick * shared,
                                     [](double x, const Over& luminaire) { return x < luminaire.gives; });
    return static_cast<std::size_t>(std::min(at, over.end() - 1) - over.begin());
  };
  return E + patch.mean(
                 [&](const Vec3& p, double u, double v, const auto& pick) -> ShadowTry {
                   const std::size_t k = chosen(pick());
                   const double probability = (over[k].gives - (k > 0 ? over[k - 1].gives : 0)) / shared;
                   const PlacedLuminaire& luminaire = lights.luminaires[over[k].number];
                   const Vec3 q = light_point(luminaire, p, u, v);
                   return {shadow_segment(luminaire, q, p),
                           open_irradiance(luminaire, q, p, patch.normal()) / probability, over[k].number,
                           luminaire.mirror};
                 },
                 wide);
}

Spectrum from_sun(const PatchSampler& patch, const PlacedSun& sun, std::uint32_t number, double far_away) {
  if (dot(patch.normal(), sun.direction) < -0.01) return Spectrum(0.0);
  return patch.mean([&](const Vec3& p, double u, double v, const auto&) -> ShadowTry {
    const Vec3 d = direction_to_sun(sun, u, v);
    return {{p, p + d * far_away, false},
            sun.normal_irradiance * std::max(0.0, dot(patch.normal(), d)),
            number,
            sun.mirror};
  });
}

std::vector<Beam> beams_of(const Lights& lights) {
  std::vector<Beam> beams;
  for (const Luminaire& luminaire : lights.luminaires) beams.push_back(beam_of(luminaire));
  return beams;
}

Spectrum from_suns(const Lights& lights, const PatchSampler& patch, double far_away) {
  Spectrum E(0.0);
  const auto luminaires = static_cast<std::uint32_t>(lights.luminaires.size());
  for (std::uint32_t k = 0; k < lights.suns.size(); ++k) E += from_sun(patch, lights.suns[k], luminaires + k, far_away);
  return E;
}

constexpr std::size_t kMostOpenings = 4;  ///< over a patch
constexpr int kRaysOfOpening = 32;        ///< through each opening that matters

struct Through {
  Spectrum E{0.0};   ///< mean irradiance [W/m2]
  bool any = false;  ///< whether any ray left the scene
};

/// Light of the sky through some openings, from points all over the patch. looked_at: those that any of a few rays left
/// by, whatever the sky there; light through the others is left to bundles.
Spectrum through_openings(const Illumination& light, std::size_t patch, const DirectOptions& options,
                          std::vector<std::uint32_t>& looked_at, LightRow* row) {
  constexpr int kPilotRays = 8;
  const Problem& problem = light.problem;
  const std::vector<LightArea>& openings = problem.lights.openings;
  const Vec3 n = problem.patches.normal[patch];
  const auto corners = problem.patches.corner_positions(PatchId{patch});
  std::vector<std::uint32_t> over =
      areas_over(openings, (corners[0] + corners[1] + corners[2]) / 3, n, kMostOpenings, 0);
  for (const Vec3& corner : corners)  // all of a patch may see of it is from one corner
    for (const std::uint32_t k : areas_over(openings, corner, n, 1, 0)) over.push_back(k);
  std::sort(over.begin(), over.end());
  over.erase(std::unique(over.begin(), over.end()), over.end());

  const auto look = [&](std::uint32_t number, std::uint64_t key, int count, LightRow* keep) {
    Through found;
    for (int k = 0; k < count; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), key);
      const Vec3 p = problem.rays.off_surface(point_on_triangle(corners, u[0], u[1]), n);
      const PolygonView polygon(p, n, openings[number].triangles, openings[number].corners);
      if (!(polygon.solid_angle() > 0)) continue;
      const auto [d, solid_angle] = polygon.look(u[2], u[3]);
      const Hit hit = problem.rays.first_hit(problem.patches, {p, d});
      if (!hit.escaped() || first_way_out(openings, looked_at, p, d, hit.first) != number) continue;
      const std::uint32_t sky = pack_direction(hit.direction({p, d}));
      const Spectrum weight = hit.transmittance * (std::max(0.0, dot(d, n)) * solid_angle);
      found.E += light.sky(unpack_direction(sky)) * weight;
      found.any = true;
      if (keep) keep->push_back(RowEntry::of_sky(sky, weight / count));
    }
    found.E *= 1.0 / count;
    return found;
  };
  const std::uint64_t key = stream_key(options.seed, kOpeningRaysOfPatch, patch);
  std::vector<std::uint32_t> seen;
  for (const std::uint32_t k : over) {
    looked_at = {k};
    if (look(k, stream_key(key, k + 1), kPilotRays, nullptr).any) seen.push_back(k);
  }
  looked_at = seen;
  Spectrum E(0.0);
  for (const std::uint32_t k : looked_at) E += look(k, mix_bits(stream_key(key, k)), kRaysOfOpening, row).E;
  return E;
}

Spectrum from_sky(const Illumination& light, std::size_t patch, const DirectOptions& options,
                  std::span<const std::uint32_t> looked_at, LightRow* row) {
  const Problem& problem = light.problem;
  const Frame frame(problem.patches.normal[patch]);
  const auto corners = problem.patches.corner_positions(PatchId{patch});
  const std::uint64_t key = stream_key(options.seed, kSkyRaysOfPatch, patch);
  Spectrum sum(0.0);
  for (int k = 0; k < options.sky_rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Ray ray{problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                  cosine_direction(frame, u[0], u[1])};
    const Hit hit = problem.rays.first_hit(problem.patches, ray);
    if (!hit.escaped() ||
        first_way_out(problem.lights.openings, looked_at, ray.origin, ray.direction, hit.first) != kNoOpening)
      continue;
    const Vec3& direction = hit.direction(ray);
    sum += light.sky(direction) * hit.transmittance;
    if (row)
      row->push_back(
          RowEntry::of_sky(pack_direction(direction), hit.transmittance * (std::numbers::pi / options.sky_rays)));
  }
  return sum * (std::numbers::pi / options.sky_rays);
}

/// Where a luminaire's own rays end: on patches, outside, or in glass and sides that take no part. [W]
EnergyBalance balance(const Problem& problem, const PlacedLuminaire& luminaire, const Beam& beam, std::uint32_t rays,
                      std::uint64_t key) {
  if (luminaire.mirror != kNoMirror) return {};  // mirrors turn the luminaire's own rays
  double sent = 0, arrived = 0, escaped = 0;
  for (std::uint32_t k = 0; k < rays; ++k) {
    const auto u = sobol4(k, key);
    const Vec3 d = direction_in(beam, u[0], u[1]), q = light_point(luminaire, luminaire.position, u[2], u[3]);
    const double I = luminous_mean(intensity(luminaire, d));
    if (!(I > 0)) continue;
    const Hit hit = problem.rays.first_hit(problem.patches, {ray_start(luminaire, q, d), d});
    sent += I;
    if (hit.escaped()) escaped += I * luminous_mean(hit.transmittance);
    if (hit.patch.valid()) arrived += I * luminous_mean(hit.transmittance);
  }
  const double flux = luminous_mean(power(luminaire));
  if (!(sent > 0)) return {.emitted = flux};
  return {.emitted = flux, .absorbed = flux * (sent - arrived - escaped) / sent, .escaped = flux * escaped / sent};
}

/// Many luminaires share the rays of four.
void balance_luminaires(const Problem& problem, std::span<const Beam> beams, DirectLight& direct,
                        const DirectOptions& options, DirectRows* rows) {
  const std::size_t count = problem.lights.luminaires.size();
  if (count == 0) return;
  const auto rays = static_cast<std::uint32_t>(std::clamp<std::size_t>((1 << 16) / count, 512, 1 << 14));
  std::vector<EnergyBalance> balances(count);
  parallel_for(count, 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t number = from; number < to; ++number)
      balances[number] = balance(problem, problem.lights.luminaires[number], beams[number], rays,
                                 stream_key(options.seed, kFluxOfLuminaire, number));
  });
  for (const EnergyBalance& b : balances) {
    direct.energy.emitted += b.emitted;
    direct.energy.escaped += b.escaped;
    direct.energy.absorbed += b.absorbed;
  }
  for (std::size_t number = 0; rows && number < count; ++number)
    rows->sources[number] = {power(problem.lights.luminaires[number]), balances[number]};
  direct.rays += count * rays;
}

/// Rows of all patches in one, and what suns bring in.
void keep(const Problem& problem, const std::vector<LightRow>& row_of_patch, DirectRows& rows) {
  const std::size_t luminaires = problem.lights.luminaires.size();
  rows.rows = {};
  for (std::size_t i = 0; i < row_of_patch.size(); ++i) {
    rows.rows.append(row_of_patch[i]);
    for (const RowEntry& e : row_of_patch[i])
      if (e.is_of_light() && e.number() >= luminaires) {
        const Spectrum E{double{e.weight[0]}, double{e.weight[1]}, double{e.weight[2]}};
        rows.sources[e.number()].flux += problem.patches.area[i] * E;
      }
  }
  for (std::size_t k = luminaires; k < rows.sources.size(); ++k)
    rows.sources[k].energy.emitted = luminous_mean(rows.sources[k].flux);
}

}  // namespace

DirectLight direct_light(const Illumination& light, const DirectOptions& options, const Monitor& monitor,
                         DirectRows* rows) {
  const Problem& problem = light.problem;
  const Lights& lights = problem.lights;
  const std::size_t n = problem.patches.patch_count();
  DirectLight direct;
  direct.E = Field(n, problem.patches.channels);
  CLERESTORY_ASSERT(options.shadow_rays, >, 0);
  if (rows) {
    rows->sources.resize(lights.luminaires.size() + lights.suns.size());
    rows->rows.begin.assign(n + 1, 0);
  }
  if (lights.empty()) return direct;

  const std::vector<Beam> beams = beams_of(lights);
  const double far_away = 4 * problem.rays.diameter();
  std::vector<double> daylight(n);  // [W] of each patch
  const bool has_openings = !lights.openings.empty();
  std::vector<std::vector<std::uint32_t>> looked_at(has_openings ? n : 0);
  if (has_openings) direct.E_openings = Field(n, problem.patches.channels);
  std::vector<LightRow> row_of_patch(rows ? n : 0);
  const auto light_patch = [&](std::size_t i, const DirectOptions& spend) {
    LightRow* row = rows ? &row_of_patch[i] : nullptr;
    if (row) row->clear();
    const PatchSampler patch(problem, i, spend, row);
    const Spectrum luminaires = from_luminaires(lights, beams, patch);
    Spectrum sky = from_suns(lights, patch, far_away);
    if (has_openings) {
      const Spectrum through = through_openings(light, i, spend, looked_at[i], row);
      direct.E_openings.set(i, through);
      if (spend.sky_rays > 0) sky += through;
    }
    if (!light.sky.dark() && spend.sky_rays > 0)
      sky += from_sky(light, i, spend, has_openings ? looked_at[i] : std::vector<std::uint32_t>{}, row);
    direct.E.set(i, luminaires + sky);
    daylight[i] = luminous_mean(sky) * problem.patches.area[i];
  };
  if (options.rough_first && monitor.deadline != Monitor{}.deadline) {
    // Time may run out below: no patch shall stay dark for that.
    const DirectOptions rough{
        .shadow_rays = 16, .edge_rays = 16, .sky_rays = std::min(16, options.sky_rays), .seed = options.seed};
    parallel_for(n, 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) light_patch(i, rough);
    });
  }
  constexpr std::size_t kBlock = 1 << 11;
  for (std::size_t begin = 0; begin < n && !monitor.should_stop(); begin += kBlock) {
    monitor.report("direct", static_cast<double>(begin) / static_cast<double>(n));
    parallel_for(std::min(kBlock, n - begin), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = begin + from; i < begin + to; ++i) light_patch(i, options);
    });
  }
  for (const double flux : daylight) direct.energy.emitted += flux;
  if (has_openings) {
    direct.openings.begin.push_back(0);
    for (const auto& numbers : looked_at) {
      direct.openings.number.insert(direct.openings.number.end(), numbers.begin(), numbers.end());
      direct.openings.begin.push_back(static_cast<std::uint32_t>(direct.openings.number.size()));
    }
    direct.rays += direct.openings.number.size() * static_cast<std::size_t>(kRaysOfOpening);
  }
  CLERESTORY_ASSERT(all_finite(direct.E), ==, true);
  direct.rays += n * static_cast<std::size_t>(options.shadow_rays) * (lights.luminaires.size() + lights.suns.size());
  if (!light.sky.dark()) direct.rays += n * static_cast<std::size_t>(options.sky_rays);
  balance_luminaires(problem, beams, direct, options, rows);
  if (rows) keep(problem, row_of_patch, *rows);
  return direct;
}

Field delta_light_on(const Problem& problem, std::span<const std::uint32_t> patches, const DirectOptions& options) {
  const std::vector<Beam> beams = beams_of(problem.lights);
  Field E(patches.size(), problem.patches.channels);
  parallel_for(patches.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const PatchSampler patch(problem, patches[k], options, nullptr);
      E.set(k, from_luminaires(problem.lights, beams, patch) +
                   from_suns(problem.lights, patch, 4 * problem.rays.diameter()));
    }
  });
  return E;
}

EnergyBalance DirectSource::energy_at(const Spectrum& factor) const {
  const double all = luminous_mean(flux), share = all > 0 ? luminous_mean(flux * factor) / all : 0;
  return {.emitted = share * energy.emitted, .absorbed = share * energy.absorbed, .escaped = share * energy.escaped};
}

void DirectRows::append(const DirectRows& more) {
  CLERESTORY_ASSERT(rows.size(), ==, more.rows.size());
  LightRows both;
  LightRow row;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    row.assign(rows[i].begin(), rows[i].end());
    for (RowEntry e : more.rows[i]) {
      if (e.is_of_light()) e.source += static_cast<std::uint32_t>(sources.size());
      row.push_back(e);
    }
    both.append(row);
  }
  rows = std::move(both);
  sources.insert(sources.end(), more.sources.begin(), more.sources.end());
}

DirectLayers direct_layers(const PatchSet& patches, const DirectRows& rows, std::span<const Layer> layers) {
  const Field none;
  const RowLight light(layers, patches.channels, none);
  const std::size_t lanes = light.lanes();
  const std::size_t n = rows.rows.size();
  const Field dark(n, static_cast<int>(lanes));
  DirectLayers out{dark, dark, std::vector<EnergyBalance>(layers.size())};
  parallel_for(n, 64, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      for (const RowEntry& e : rows.rows[i])
        light.add({&e, 1}, (e.is_of_sky() ? out.sky : out.delta_light).value.data() + i * lanes);
  });
  for (std::size_t s = 0; s < layers.size(); ++s) {
    out.energy[s].emitted += total_flux(patches, one_layer(out.sky, s, patches.channels));
    for (std::size_t k = 0; k < std::min(rows.sources.size(), layers[s].lights.size()); ++k)
      out.energy[s] += rows.sources[k].energy_at(layers[s].lights[k]);
  }
  return out;
}

}  // namespace clerestory
