#include "solver/illumination/direct.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <utility>

#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/delta_light.h"
#include "solver/illumination/one_light.h"
#include "solver/illumination/sky_through_openings.h"
#include "solver/lights/beam.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/model/assert.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/echoes.h"

namespace clerestory {
namespace {

Spectrum from_sky(const Illumination& light, std::size_t patch, const DirectOptions& options,
                  std::span<const std::uint32_t> looked_at, LightRow* row) {
  const Problem& problem = light.problem;
  const std::span<const LightArea> openings = problem.lights.sky_openings();
  const Frame frame(problem.patches.normal[patch]);
  const auto corners = problem.patches.corner_positions(PatchId{patch});
  const std::uint64_t key = stream_key(options.seed, kSkyRaysOfPatch, patch);
  Spectrum sum(0.0);
  for (int k = 0; k < options.sky_rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), key);
    const Ray ray{problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                  cosine_direction(frame, u[0], u[1])};
    Echo echo;
    const Hit hit = problem.rays.first_hit(problem.patches, ray, &echo);
    const auto take = [&](const Hit& h) {
      if (!h.escaped()) return;
      const Vec3& direction = h.direction(ray);
      sum += light.sky(direction) * h.transmittance;
      if (row)
        row->push_back(
            RowEntry::of_sky(pack_direction(direction), h.transmittance * (std::numbers::pi / options.sky_rays)));
    };
    if (first_way_out(openings, looked_at, ray.origin, ray.direction, hit.first) == kNoOpening) take(hit);
    follow_echo(problem.rays, problem.patches, echo, key, static_cast<std::uint64_t>(k), take);
  }
  return sum * (std::numbers::pi / options.sky_rays);
}

/// Where a luminaire's own rays end: on patches, outside, or in glass and sides that take no part. [W]
EnergyBalance balance(const Problem& problem, const PlacedLuminaire& luminaire, const Beam& beam, std::uint32_t rays,
                      std::uint64_t key) {
  if (luminaire.is_image()) return {};  // mirrors turn the luminaire's own rays
  double sent = 0, arrived = 0, escaped = 0;
  for (std::uint32_t k = 0; k < rays; ++k) {
    const auto u = sobol4(k, key);
    const Vec3 d = direction_in(beam, u[0], u[1]), q = light_point(luminaire, luminaire.position, u[2], u[3]);
    const double I = luminous_mean(intensity(luminaire, d));
    if (!(I > 0)) continue;
    Echo echo;
    const Hit hit = problem.rays.first_hit(problem.patches, {ray_start(luminaire, q, d), d}, &echo);
    sent += I;
    const auto take = [&](const Hit& h) {
      if (h.escaped()) escaped += I * luminous_mean(h.transmittance);
      if (h.patch.valid()) arrived += I * luminous_mean(h.transmittance);
    };
    take(hit);
    follow_echo(problem.rays, problem.patches, echo, key, k, take);
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

/// Caustics that land on patches: of luminaires and suns like all direct light.
void add_caustics(const Problem& problem, std::vector<LightRow>& row_of_patch, DirectLight& direct) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Spectrum> of_light;  // rows are floats
  each_landing(problem, problem.lights.caustics.legs, [&](const CausticLanding& landing) {
    const Spectrum E = landing.flux / problem.patches.area[landing.patch];
    direct.E.add(landing.patch, E);
    if (is_sun(problem.lights, landing.light)) direct.energy.emitted += luminous_mean(landing.flux);
    if (!row_of_patch.empty()) of_light.try_emplace({landing.patch.value, landing.light}, 0.0).first->second += E;
  });
  for (const auto& [where, E] : of_light) add_to_row(row_of_patch[where.first], where.second, E);
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
                         DirectRows* rows, const PatchesOfRound* round) {
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
  std::vector<double> daylight(n);  // [W] of each patch
  const bool has_openings = !lights.sky_openings().empty();
  std::vector<std::vector<std::uint32_t>> looked_at(has_openings ? n : 0);
  if (has_openings) direct.E_openings = Field(n, problem.patches.channels);
  std::vector<LightRow> row_of_patch(rows ? n : 0);
  const auto light_patch = [&](std::size_t i, const DirectOptions& spend) {
    LightRow* row = rows ? &row_of_patch[i] : nullptr;
    if (row) row->clear();
    const DeltaIrradiance delta = delta_light_of_patch(problem, light.sampler.gloss(), beams, i, spend, row);
    Spectrum sky = delta.suns + delta.by_gloss.suns;
    if (has_openings) {
      const std::uint32_t same = round && round->before && !row ? round->number[i] : PatchesOfRound::kNew;
      Spectrum through;
      if (same != PatchesOfRound::kNew) {
        const auto seen = round->before->openings.of(same);
        looked_at[i].assign(seen.begin(), seen.end());
        through = round->before->E_openings[same];
      } else {
        const std::uint64_t key = round ? stream_key(round->seed, kOpeningRaysOfPatch, round->name[i])
                                        : stream_key(spend.seed, kOpeningRaysOfPatch, i);
        through = sky_through_openings(light, i, key, looked_at[i], row);
      }
      direct.E_openings.set(i, through);
      if (spend.sky_rays > 0) sky += through;
    }
    if (!light.sky.dark() && spend.sky_rays > 0)
      sky += from_sky(light, i, spend, has_openings ? looked_at[i] : std::vector<std::uint32_t>{}, row);
    direct.E.set(i, delta.luminaires + delta.by_gloss.luminaires + sky);
    daylight[i] = luminous_mean(sky) * problem.patches.area[i];
  };
  if (options.rough_first && monitor.has_deadline()) {
    // Time may run out below: no patch shall stay dark for that.
    const DirectOptions rough{.shadow_rays = 16,
                              .gloss_rays = 4,
                              .edge_rays = 16,
                              .sky_rays = std::min(16, options.sky_rays),
                              .seed = options.seed};
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
  add_caustics(problem, row_of_patch, direct);
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
  if (!light.sampler.gloss().empty())
    direct.rays += n * static_cast<std::size_t>(options.gloss_rays) * GlossLight::kRaysOfPair;
  if (!light.sky.dark()) direct.rays += n * static_cast<std::size_t>(options.sky_rays);
  balance_luminaires(problem, beams, direct, options, rows);
  if (rows) keep(problem, row_of_patch, *rows);
  return direct;
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
