#include "solver/illumination/delta_light.h"

#include <algorithm>
#include <numbers>

#include "solver/illumination/image_beams.h"
#include "solver/illumination/light_rows.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/luminaire_view.h"
#include "solver/lights/near_planes.h"
#include "solver/lights/sun.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

/// A way from a point of a patch to a light, not yet known to be free.
struct ShadowTry {
  ShadowSegment way;
  Spectrum irradiance;       ///< when nothing blocks
  std::uint32_t number = 0;  ///< of the light, see Layer::lights
  MirrorWay over{};          ///< of an image
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
  bool may_see(const PlacedSun& sun) const { return may_reach(problem_.rays, sun, corners_); }
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
    return luminaire.share * (std::min(sum / 4, 10 * all_round) + 0.05 * all_round);
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
      return {shadow_segment(luminaire, q, from), per_flux * flux, number, luminaire.way};
    };
    if (opening_rays(luminaire, middle) == 1) {
      const double flux = view.look_from(luminaire.position);
      if (!(flux > 0)) return Spectrum(0.0);
      // What is partly hidden of so much light deserves more rays.
      const int edge_rays =
          options_.edge_rays <= options_.shadow_rays
              ? options_.edge_rays
              : std::clamp(static_cast<int>(kRaysOfAll * flux / beam.flux), options_.edge_rays, 4 * options_.edge_rays);
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
    auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Spectrum& passes) {
      const Spectrum arrives = load.irradiance * passes;
      tally.sum += arrives;
      ++tally.visible;
      if (row_) note(load.number, arrives);
    });
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(count); ++k) {
      const ShadowTry to_light = try_of(k, key, sobol4(k, key));
      if (to_light.irradiance.is_black()) continue;
      ++tally.facing;
      const auto& [from, to, is_free] = to_light.way;
      if (to_light.over.empty() && !is_free) {
        shadows.send(from, to, {to_light.irradiance, to_light.number});
        continue;
      }
      const Spectrum passes = is_free ? Spectrum(1.0) : rays.transmittance_by_mirrors(from, to, to_light.over);
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
                luminaire.way};
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
                           luminaire.way};
                 },
                 wide);
}

Spectrum from_sun(const PatchSampler& patch, const PlacedSun& sun, std::uint32_t number, double far_away) {
  if (dot(patch.normal(), sun.direction) < -0.01 || !patch.may_see(sun)) return Spectrum(0.0);
  return patch.mean([&](const Vec3& p, double u, double v, const auto&) -> ShadowTry {
    const Vec3 d = direction_to_sun(sun, u, v);
    return {
        {p, p + d * far_away, false}, sun.normal_irradiance * std::max(0.0, dot(patch.normal(), d)), number, sun.way};
  });
}

Spectrum from_suns(const Lights& lights, const PatchSampler& patch, double far_away) {
  Spectrum E(0.0);
  const auto luminaires = static_cast<std::uint32_t>(lights.luminaires.size());
  for (std::uint32_t k = 0; k < lights.suns.size(); ++k) E += from_sun(patch, lights.suns[k], luminaires + k, far_away);
  return E;
}

/// By one pair from each of some points.
GlossIrradiance from_gloss(const Problem& problem, const GlossLight& gloss, std::size_t patch,
                           const DirectOptions& options, LightRow* row) {
  const std::uint64_t key = stream_key(options.seed, kGlossOfPatch, patch);
  const auto corners = problem.patches.corner_positions(PatchId{patch});
  const Vec3 normal = problem.patches.normal[patch];
  const std::size_t begin = row ? row->size() : 0;
  GlossIrradiance sum;
  for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(options.gloss_rays); ++k) {
    const auto at = sobol4(k, key);
    RandomStream random(key, k);
    const GlossIrradiance found =
        gloss.by_one_pair(problem.rays.off_surface(point_on_triangle(corners, at[0], at[1]), normal), normal,
                          {sobol4(k, key + 1), sobol4(k, key + 2), sobol4(k, key + 3)}, random, row);
    sum.luminaires += found.luminaires, sum.suns += found.suns;
  }
  if (row)
    for (RowEntry& e : std::span(*row).subspan(begin)) e.scale(Spectrum(1.0 / options.gloss_rays));
  return {sum.luminaires / options.gloss_rays, sum.suns / options.gloss_rays};
}

}  // namespace

std::vector<Beam> beams_of(const Lights& lights) {
  std::vector<Beam> beams;
  for (const Luminaire& luminaire : lights.luminaires) beams.push_back(beam_of(luminaire));
  return beams;
}

DeltaIrradiance delta_light_of_patch(const Problem& problem, const GlossLight& gloss, std::span<const Beam> beams,
                                     std::size_t patch, const DirectOptions& options, LightRow* row) {
  const PatchSampler sampler(problem, patch, options, row);
  DeltaIrradiance light;
  light.luminaires = from_luminaires(problem.lights, beams, sampler);
  light.suns = from_suns(problem.lights, sampler, 4 * problem.rays.diameter());
  if (!gloss.empty()) light.by_gloss = from_gloss(problem, gloss, patch, options, row);
  return light;
}

Field delta_light_on(const Problem& problem, std::span<const std::uint32_t> patches, const DirectOptions& options) {
  const std::vector<Beam> beams = beams_of(problem.lights);
  const GlossLight gloss(problem);
  Field E(patches.size(), problem.patches.channels);
  parallel_for(patches.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const DeltaIrradiance light = delta_light_of_patch(problem, gloss, beams, patches[k], options, nullptr);
      E.set(k, light.sum());
    }
  });
  return E;
}

}  // namespace clerestory
