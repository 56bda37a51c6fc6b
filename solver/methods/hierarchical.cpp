#include "solver/methods/hierarchical.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numeric>
#include <span>

#include "solver/hierarchy/balance.h"
#include "solver/hierarchy/bf_refine.h"
#include "solver/hierarchy/build_tree.h"
#include "solver/hierarchy/caustic_edges.h"
#include "solver/hierarchy/debug_view.h"
#include "solver/hierarchy/refine.h"
#include "solver/hierarchy/shadow_edges.h"
#include "solver/hierarchy/sky_views.h"
#include "solver/hierarchy/trace_links.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/methods/progressive.h"
#include "solver/model/units.h"
#include "solver/paths/find_slit_gains.h"
#include "solver/spaces/closure.h"

namespace clerestory {
namespace {

constexpr int kMostRounds = 4;                // of coarse solves before the last one
constexpr double kWorthAnother = 1.3;         // growth of the leaves that makes a coarse solve on them worth its rays
constexpr double kWorthAnotherMerged = 1.01;  // the same where nodes are linked: halves must be solved first
constexpr double kStakeByTolerance = 1e-4;    // flux at stake of `bf`, as a share of tolerance times all emitted flux
/// Rays of all bundles, and of all pairs, in one round: seconds of a core. Beyond, receivers get fewer, as a wrong one
/// among so many does little harm.
constexpr double kMostRays = 1.5e7;
/// Scenes of few elements cost next to nothing, and their energy would hang on few rays: they get more of them.
constexpr std::size_t kFewLeaves = 1500;
/// The same where a luminaire is so near to a surface that elements near by get this share of all its light: a spot
/// sends it on, and the energy hangs on the rays that meet the spot.
constexpr std::size_t kFewLeavesBySpot = 6000;
constexpr double kShareOfSpot = 0.25;
constexpr int kMostOfOne = 1024;       // rays of one receiver; by judgement
constexpr double kDarkestShare = 0.1;  // share of a space's area that is no brighter than its ground light

constexpr double kShareOfFirst = 0.7;  // of the time that is left: a first round that takes longer is of no use

/// Quality of one round: thresholds fall from round to round.
struct Quality {
  LinkOptions links;
  DirectOptions direct;
  double residual;
  bool tells_slit_gains = false;
};

Quality coarse(const HierarchyOptions& o) {
  return {{.bundle_rays = std::max(32, o.bundle_rays / 4), .bright_rays = 16, .uniform = 0.02, .seed = o.seed + 1},
          {.shadow_rays = 16, .gloss_rays = 8, .edge_rays = 16, .sky_rays = 0, .seed = o.seed + 1},
          1e-3};
}
Quality full(const HierarchyOptions& o, std::size_t leaves, bool by_spot = false) {
  int bundle = o.bundle_rays, pairs = o.bright_rays;
  for (std::size_t n = leaves; n < (by_spot ? kFewLeavesBySpot : kFewLeaves) && bundle < kMostOfOne; n *= 2)
    bundle *= 2, pairs *= 2;
  return {{.bundle_rays = bundle, .bright_rays = pairs, .seed = o.seed},
          {.shadow_rays = 64, .edge_rays = 256, .sky_rays = 0, .seed = o.seed},  // few miss that a corner is lit
          o.residual,
          true};
}

int rays_of(const LinkOptions& links) { return links.bundle_rays + links.bright_rays; }

/// With fewer rays where the deadline would come too early: the last coarse round tells what they take.
Quality in_time(Quality quality, const Quality& before, double seconds_before, const Monitor& monitor) {
  const double left = monitor.seconds_left(), a_ray = seconds_before / rays_of(before.links);
  while (a_ray * rays_of(quality.links) > left && rays_of(quality.links) > 2 * rays_of(before.links))
    quality.links.bundle_rays /= 2, quality.links.bright_rays /= 2;
  return quality;
}

bool merges(std::size_t leaves, const LinkOptions& links) {
  return static_cast<double>(leaves) * rays_of(links) > kLinksToSpare;
}

/// What one round hands to the next: the light on the leaves as they were.
struct Round {
  HierarchicalSolution result;
  DirectLight direct;
  std::vector<std::uint32_t> element;  ///< of the mesh, by leaf
  std::vector<std::uint32_t> space;    ///< by leaf
  std::size_t spaces = 0;
  std::vector<std::uint32_t> to_halve;  ///< of the mesh, by `bf`
  bool complete = false;
};

/// What was found for the elements that were leaves, on the leaves of now: halves inherit. Both are in the order of the
/// mesh.
Field inherited(const Field& B, std::span<const std::uint32_t> were_leaves, const ElementMesh& mesh) {
  Field out(mesh.leaf_count(), B.channels);
  std::size_t leaf = 0;
  for (std::size_t i = 0; i < were_leaves.size(); ++i)
    for (std::size_t k = mesh.leaves_under(were_leaves[i]); k > 0; --k) out.set(leaf++, B[i]);
  return out;
}

/// What bright sources are told by: B without the part of their space's ground light that has gone round eight times or
/// more. In a very bright room that is most of the light, it comes from everywhere, and bundles know it exactly; lamps
/// must stand out before it, or the energy they send would be met by chance.
Field above_ground(const PatchSet& leaves, const Field& B, const Round& round) {
  std::vector<std::uint32_t> order(B.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<double> light(B.size()), area(round.spaces, 0.0), rho(round.spaces, 0.0);
  for (std::size_t i = 0; i < B.size(); ++i) {
    light[i] = luminous_mean(B[i]);
    area[round.space[i]] += leaves.area[i];
    rho[round.space[i]] += leaves.area[i] * luminous_mean(leaves.albedo(i));
  }
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return light[a] < light[b] || (light[a] == light[b] && a < b); });
  std::vector<Spectrum> ground(round.spaces);
  std::vector<double> darker(round.spaces, 0.0);
  for (const std::uint32_t i : order) {
    const std::uint32_t s = round.space[i];
    if (darker[s] < kDarkestShare * area[s]) ground[s] = B[i] * std::pow(rho[s] / area[s], 8);
    darker[s] += leaves.area[i];
  }
  Field above(B.size(), B.channels);
  for (std::size_t i = 0; i < B.size(); ++i) {
    const Spectrum more = B[i] - ground[round.space[i]];
    above.set(i, {std::max(0.0, more[0]), std::max(0.0, more[1]), std::max(0.0, more[2])});
  }
  return above;
}

/// Leaves that mostly look at others, and have most of their light from the sun or luminaires, many times what is usual
/// among such: a facade in the sun, or a ground, must not hide the sun's patch in the room behind it.
std::vector<bool> spots(const PatchSet& leaves, const Field& B, const Field& delta_light,
                        const std::vector<float>& arrives) {
  std::vector<bool> indoors(leaves.patch_count()), spot(leaves.patch_count());
  for (std::size_t i = 0; i < indoors.size(); ++i) indoors[i] = arrives[i] > 0.5f;
  const double bright = kBrighter * area_median(leaves, B, indoors);
  for (std::size_t i = 0; i < spot.size(); ++i) {
    const double sent = luminous_mean(B[i]);
    spot[i] = indoors[i] && sent > bright && luminous_mean(leaves.scattered(delta_light, i)) > 0.5 * sent;
  }
  return spot;
}

/// Faces that fit into this are no receivers of their own [m].
double receiver_size(const PatchSet& patches, double shortest_edge) {
  const double n = static_cast<double>(std::max<std::size_t>(patches.patch_count(), 1));
  const double area = patches.total_area();
  return std::max(shortest_edge, 0.5 * std::sqrt(area / n));
}

/// Whether much of the light of luminaires and suns falls on elements near luminaires.
bool is_lit_by_spot(const HierarchicalSolution& s, const Lights& lights) {
  if (lights.luminaires.empty()) return false;
  const std::vector<bool> near = patches_near_luminaires(s.elements, lights);
  double there = 0, all = 0;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const double flux = s.elements.area[i] * luminous_mean(s.delta_light[i]);
    all += flux;
    if (near[i]) there += flux;
  }
  return there > kShareOfSpot * all;
}

std::string round_line(const char* what, const Solution& s, std::size_t leaves, std::size_t receivers) {
  char line[200];
  std::snprintf(line, sizeof line,
                "%s: %zu elements, %zu receivers, %zu clusters, %zu links, %ld sweeps, residual %.2g", what, leaves,
                receivers, s.clusters, s.links, s.iterations, s.residual);
  return line;
}

/// Of each element of `now`, its place among those of `then`.
std::vector<std::uint32_t> numbers_of_the_same(std::span<const std::uint32_t> then,
                                               std::span<const std::uint32_t> now) {
  std::vector<std::uint32_t> place(then.empty() ? 0 : *std::ranges::max_element(then) + 1, PatchesOfRound::kNew);
  for (std::size_t i = 0; i < then.size(); ++i) place[then[i]] = static_cast<std::uint32_t>(i);
  std::vector<std::uint32_t> numbers;
  for (const std::uint32_t e : now) numbers.push_back(e < place.size() ? place[e] : PatchesOfRound::kNew);
  return numbers;
}

/// links -> gather -> push-pull on the leaves as they are. before: the round that came earlier, if any; keep: null, or
/// where its transport goes.
Round solve_round(const Problem& whole, const ElementMesh& mesh, const HierarchyOptions& options, Quality quality,
                  const char* name, Round* before, const Monitor& monitor, KeptTransport* keep = nullptr) {
  Round round;
  round.element = mesh.leaves();
  HierarchicalSolution& out = round.result;
  out.elements = mesh.leaf_patches();
  const PatchSet& leaves = out.elements;
  const Problem problem{leaves, whole.rays, whole.lights};
  const std::size_t n = leaves.patch_count();

  if (options.oracle == Oracle::bf) quality.direct.sky_rays = options.bundle_rays;
  quality.direct.rough_first = false;  // a round that is stopped is not returned
  PatchesOfRound same{round.element, options.seed, nullptr, {}};
  if (before) same.before = &before->direct, same.number = numbers_of_the_same(before->element, round.element);
  round.direct = direct_light(Illumination(problem), quality.direct, monitor, keep ? &keep->direct : nullptr, &same);
  const DirectLight& direct = round.direct;
  if (monitor.should_stop()) return round;
  Field guess, glow;
  if (before) {
    guess = inherited(before->result.solution.B, before->element, mesh);
    glow = inherited(above_ground(before->result.elements, before->result.solution.B, *before), before->element, mesh);
    before->result.elements = {};  // 200 bytes each; should this round be stopped, they are made anew
  } else {
    glow = leaves.M;
    for (std::size_t i = 0; i < n; ++i) glow.add(i, leaves.scattered(direct.E, i));
  }
  ElementTree tree = build_tree(leaves, before ? guess : glow);
  Illumination light(problem, glow);
  if (before && quality.tells_slit_gains) {
    out.solution.slit_light = find_slit_light(problem, options.seed, monitor);
    light.slit_gains = slit_gains(problem, guess, out.solution.slit_light, options.seed);
  }
  const auto receivers = static_cast<double>(std::min(n, kMostReceivers));
  for (int* rays : {&quality.links.bundle_rays, &quality.links.bright_rays})
    while (*rays * receivers > kMostRays && *rays >= 64) *rays /= 2;
  if (!merges(n, quality.links)) quality.links.uniform = 0;
  quality.links.cluster_diameter = receiver_size(mesh.patches(), options.shortest_edge.anywhere);
  quality.links.sky_views = keep || !light.sky.dark();
  Transport transport;
  if (options.oracle == Oracle::error) {
    transport = trace_links(light, tree, before ? glow : Field{}, direct, quality.links, monitor);
  } else {
    double first_flux = 0;
    for (std::size_t i = 0; i < n; ++i)
      first_flux += leaves.area[i] * luminous_mean(leaves.M[i] + leaves.scattered(direct.E, i));
    BfLinks links = bf_refine(problem, tree, before ? guess : glow,
                              {kStakeByTolerance * options.tolerance * first_flux, options.seed}, monitor);
    for (const std::uint32_t p : links.to_halve) {
      const std::uint32_t e = round.element[p];
      if (mesh.longest_edge(e) >= 2 * options.shortest_edge.of(mesh.patches(), mesh[e].patch))
        round.to_halve.push_back(e);
    }
    transport = std::move(links.transport);
  }
  if (!transport.complete) return round;

  out.delta_light = direct.E;
  Field E_direct = direct.E;
  double sky_flux = 0;
  if (!light.sky.dark() && quality.direct.sky_rays == 0) {
    const SkyRadiance* const sky = &light.sky;
    Field E_sky = sky_irradiance(leaves, tree, transport, {&sky, 1});
    for (std::size_t k = 0; k < direct.E_openings.value.size(); ++k) E_sky.value[k] += direct.E_openings.value[k];
    for (std::size_t k = 0; k < E_sky.value.size(); ++k) E_direct.value[k] += E_sky.value[k];
    sky_flux = total_flux(leaves, E_sky);
  }
  monitor.report("gather", 0);
  Solution& s = out.solution;
  Balanced balanced = balance(leaves, tree, transport, leaves.M, E_direct, std::move(guess), quality.residual, monitor);
  s.E = std::move(balanced.E), s.B = std::move(balanced.B);
  s.energy = balanced.energy[0];
  s.stop = balanced.stop, s.iterations = balanced.iterations, s.residual = balanced.residual;
  s.method = "hierarchical";
  s.energy.emitted += total_flux(leaves, leaves.M) + sky_flux;
  s.energy += direct.energy;
  s.rays = direct.rays + transport.rays;
  s.clusters = tree.clusters;
  s.links = transport.link_count();
  s.log = {round_line(name, s, n, transport.receiver_count())};
  if (options.debug) view_round(light, tree, transport, quality.links, s, *options.debug);
  out.elements.spot = spots(leaves, s.B, out.delta_light, transport.arrives);
  round.spaces = transport.spaces;
  round.space = keep ? transport.space : std::move(transport.space);
  round.complete = true;
  if (keep) {
    keep->elements = leaves;
    keep->tree = std::move(tree), keep->transport = std::move(transport);
    keep->complete = true;
  }
  return round;
}

/// Something to show where time was not enough for the first round: shooting as far as there is time, or the ambient
/// term alone.
HierarchicalSolution rough_picture(const Problem& whole, const ElementMesh& mesh, const HierarchyOptions& options,
                                   const Monitor& monitor) {
  HierarchicalSolution out;
  out.elements = mesh.leaf_patches();
  const Problem problem{out.elements, whole.rays, whole.lights};
  const bool late = monitor.should_stop();
  const DirectLight direct = direct_light(
      Illumination(problem),
      {.shadow_rays = 16, .edge_rays = 16, .sky_rays = late ? 8 : 32, .seed = options.seed, .rough_first = false}, {});
  out.solution = shoot(
      problem, direct, measure_closure(problem, late ? 8 : 16, options.seed),
      {.stop_fraction = 0.03, .rays_per_patch = 32, .max_rounds = late ? 0 : 1000, .seed = options.seed}, monitor);
  out.solution.method = "hierarchical";
  out.solution.log = {late ? "the ambient estimate" : "progressive shooting"};
  return out;
}

}  // namespace

HierarchicalSolution hierarchical(const Problem& problem, ElementMesh& mesh, const HierarchyOptions& options,
                                  const Monitor& monitor) {
  std::vector<std::uint32_t> returned = mesh.leaves();  // the elements of what is returned
  std::unique_ptr<Round> last;
  std::vector<std::string> log;
  unsigned long long rays = 0;
  const auto go_on = [&](Round&& round) {
    rays += round.result.solution.rays;
    if (!round.complete) return false;
    log.insert(log.end(), round.result.solution.log.begin(), round.result.solution.log.end());
    last = std::make_unique<Round>(std::move(round));
    monitor.say_result();
    return !monitor.should_stop();
  };

  bool going = !monitor.should_stop();
  double seconds = 0;  // of the last coarse round
  for (int number = 0; going && number < kMostRounds; ++number) {
    monitor.report("refine", static_cast<double>(number) / kMostRounds);
    std::size_t before = mesh.leaf_count();
    const std::string name = "round " + std::to_string(number);
    const double left = monitor.seconds_left();
    const Monitor in_time = number == 0 ? monitor.within(kShareOfFirst * left) : monitor;
    going = go_on(solve_round(problem, mesh, options, coarse(options), name.c_str(), last.get(), in_time));
    if (!going) break;
    if (monitor.has_deadline()) seconds = left - monitor.seconds_left();
    if (options.oracle == Oracle::bf) {
      // Each round refines by the light that the last one found.
      if (mesh.leaf_count() + 4 * last->to_halve.size() <= options.most_elements) mesh.split(last->to_halve);
      continue;
    }
    const Problem on_leaves{last->result.elements, problem.rays, problem.lights};
    const Field glow = above_ground(last->result.elements, last->result.solution.B, *last);
    monitor.report("refine", (number + 0.5) / kMostRounds);
    if (number == 0) {  // straight edges need no halving
      const ShadowEdges edges =
          cut_shadow_edges(mesh, on_leaves, last->result.solution.E,
                           {.shortest_edge = options.shortest_edge, .most_elements = options.most_elements}, monitor);
      log.push_back(name + ": " + std::to_string(edges.cut) + " cut along edges of shadows, " +
                    std::to_string(edges.halved) + " halved at them");
      before = mesh.leaf_count();  // which direct light knows, without another round
    }
    const RefineOptions how{options.tolerance, options.shortest_edge, options.most_elements, options.seed};
    const std::size_t halved = refine(mesh, Illumination(on_leaves, glow), last->result.solution.E,
                                      last->result.solution.B, how, rays, monitor);
    const std::size_t at_caustics =
        halve_at_caustics(mesh, on_leaves, last->element, last->result.solution.E, how, monitor);
    if (at_caustics > 0) log.push_back(name + ": " + std::to_string(at_caustics) + " halved at caustics");
    log.push_back(name + ": " + std::to_string(halved) + " halved, " + std::to_string(mesh.leaf_count()) + " elements");
    // Halves know no more of the light than the element they came from did: nodes must not take them for alike.
    const double worth_another =
        merges(mesh.leaf_count(), full(options, mesh.leaf_count()).links) ? kWorthAnotherMerged : kWorthAnother;
    if (static_cast<double>(mesh.leaf_count()) < worth_another * static_cast<double>(before)) break;
  }
  if (going) {
    const bool by_spot = last && is_lit_by_spot(last->result, problem.lights);
    const Quality quality = in_time(full(options, mesh.leaf_count(), by_spot), coarse(options), seconds, monitor);
    going = go_on(solve_round(problem, mesh, options, quality, "last round", last.get(), monitor, options.keep));
  }

  HierarchicalSolution out;
  if (last) {
    out = std::move(last->result);
    returned = std::move(last->element);
  } else {
    out = rough_picture(problem, mesh, options, monitor);
    rays += out.solution.rays;
    log.push_back(out.solution.log.back());
  }
  if (!going) {
    out.solution.stop = why_stopped(monitor);
    if (!log.empty()) out.solution.stopped_at = log.back();
    log.push_back("stopped early");
  }
  if (out.elements.patch_count() != mesh.leaf_count()) {  // stopped after more were halved, or in the next round
    for (Field* f : {&out.delta_light, &out.solution.E, &out.solution.B})
      if (!f->value.empty()) *f = inherited(*f, returned, mesh);
    out.elements = mesh.leaf_patches();
  }
  out.solution.log = std::move(log);
  out.solution.rays = rays;
  return out;
}

}  // namespace clerestory
