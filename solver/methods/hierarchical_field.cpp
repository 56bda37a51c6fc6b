#include "solver/methods/hierarchical_field.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "solver/hierarchy/fine_radiosity.h"
#include "solver/hierarchy/gradients.h"
#include "solver/hierarchy/leaf_errors.h"
#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/methods/near_points.h"
#include "solver/model/units.h"
#include "solver/paths/find_slit_gains.h"

namespace clerestory {
namespace {

/// Mean of sun and luminaire light over leaves of one element, and whether it varies among their corners.
struct DeltaLight {
  Spectrum mean;
  bool varies = false;
  bool known = false;  ///< all corners were gathered; the rest holds only then
};

/// Points of leaves across which the edge of such light runs, parts between the ends of a penumbra apart.
std::vector<bool> points_at_edges(const ElementMesh& mesh, std::span<const std::uint32_t> leaves,
                                  const VertexField& field) {
  constexpr double kEdge = 0.5;  // of the brighter corner
  std::vector<bool> at_edge(field.E.size());
  for (const std::uint32_t leaf : leaves) {
    const auto point = mesh.points_of(leaf);
    const auto delta = [&](std::size_t k) { return luminous_mean(field.delta_light[point[k]]); };
    const auto [low, high] = std::minmax({delta(0), delta(1), delta(2)});
    if (high - low > kEdge * high && !mesh[leaf].penumbra)
      for (const std::uint32_t p : point) at_edge[p] = true;
  }
  return at_edge;
}

DeltaLight delta_light(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const VertexField& field) {
  constexpr double kVaries = 0.1;  // less is left to the vertices, which know it as well
  DeltaLight found;
  double low = std::numeric_limits<double>::infinity(), high = 0, share = 0;
  for (const std::uint32_t leaf : leaves) {
    const double part = mesh[leaf].area / mesh.patches().area[mesh[leaf].patch];
    for (const std::uint32_t p : mesh.points_of(leaf)) {
      if (!field.known[p]) return {};
      const Spectrum luminaires = field.delta_light[p];
      found.mean += luminaires * (part / 3);
      low = std::min(low, luminous_mean(luminaires)), high = std::max(high, luminous_mean(luminaires));
    }
    share += part;
  }
  found.mean *= 1 / share;
  found.varies = high - low > kVaries * high;
  found.known = true;
  return found;
}

/// Sun and luminaire light of the leaves of one element, channel c, so that their mean is the exact one. In proportion
/// to what their corners have: what is added evenly where it is dark would have to be taken away where there is
/// nothing. No leaf gets more than the brightest corner has, or the exact mean; what it has too much goes to the
/// others.
std::vector<double> put_right(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const Field& delta_light,
                              int c, double exact, double mean) {
  std::vector<double> luminaires(leaves.size(), exact);
  if (!(mean > 0)) return luminaires;
  double most = exact, missing = 0, room = 0;
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    double at_corners = 0;
    for (const std::uint32_t p : mesh.points_of(leaves[k])) {
      at_corners += delta_light.at(p, c) / 3;
      most = std::max(most, delta_light.at(p, c));
    }
    luminaires[k] = at_corners * exact / mean;
  }
  for (std::size_t k = 0; k < leaves.size(); ++k) {
    const double area = mesh[leaves[k]].area, more = luminaires[k] - most;
    (more > 0 ? missing : room) += area * std::abs(more);
    luminaires[k] = std::min(luminaires[k], most);
  }
  if (missing > 0 && room > 0)
    for (double& E : luminaires) E += (most - E) * std::min(1.0, missing / room);
  return luminaires;
}

Field without_delta_light(const VertexField& field) {
  Field rest = field.E;
  for (std::size_t k = 0; k < rest.value.size(); ++k)
    rest.value[k] = std::max(0.0, rest.value[k] - field.delta_light.value[k]);  // rounding, beside a bright lamp
  return rest;
}

/// Sun and luminaire light of some leaves, by leaf; of the others nothing. They are looked at from the luminaire, as
/// its peak may lie between their corners.
Field light_near_luminaires(const Problem& on_leaves, const std::vector<std::uint32_t>& near_leaves,
                            std::uint64_t seed) {
  const Field found =
      delta_light_on(on_leaves, near_leaves, {.shadow_rays = 64, .edge_rays = 256, .sky_rays = 0, .seed = seed});
  Field all(on_leaves.patches.patch_count(), on_leaves.patches.channels);
  for (std::size_t k = 0; k < near_leaves.size(); ++k) all.set(near_leaves[k], found[k]);
  if (near_leaves.empty() || on_leaves.lights.caustics.legs.empty()) return all;
  const Field caustics = caustics_on_patches(on_leaves, on_leaves.lights.caustics.legs);
  for (const std::uint32_t leaf : near_leaves) all.add(leaf, caustics[leaf]);
  return all;
}

/// Elements near luminaires whose corners do not tell their light.
struct NearLuminaires {
  std::vector<bool> element;                ///< by element of the transport
  std::vector<std::uint32_t> among_leaves;  ///< numbers of their leaves
  std::vector<std::uint32_t> halved;        ///< of those, the leaves of elements that were halved for what is shown
};
NearLuminaires near_luminaires(const ElementMesh& mesh, std::span<const std::uint32_t> transport_leaves,
                               const HierarchicalSolution& coarse, const VertexField& field, const Lights& lights) {
  constexpr double kResolved = 0.03;
  NearLuminaires near{patches_near_luminaires(coarse.elements, lights), {}, {}};
  if (coarse.delta_light.value.empty()) near.element.assign(near.element.size(), false);
  const std::vector<std::uint32_t> all = mesh.leaves();
  std::uint32_t leaf = 0;
  for (std::size_t j = 0; j < transport_leaves.size(); ++j) {
    const std::size_t leaves = mesh.leaves_under(transport_leaves[j]);
    if (near.element[j]) {
      const DeltaLight gathered = delta_light(mesh, std::span(all).subspan(leaf, leaves), field);
      const double exact = luminous_mean(coarse.delta_light[j]), off = luminous_mean(gathered.mean) - exact;
      near.element[j] = gathered.known && std::abs(off) > kResolved * exact;
    }
    for (std::size_t k = 0; k < leaves; ++k, ++leaf) {
      if (near.element[j]) near.among_leaves.push_back(leaf);
      if (near.element[j] && leaves > 1) near.halved.push_back(leaf);
    }
  }
  return near;
}

/// What leaves of one element near a luminaire have of channel c, so that their mean is the exact one.
std::vector<double> put_right_near(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const Field& light,
                                   std::size_t begin, int c, double exact) {
  double flux = 0, area = 0;
  for (std::size_t k = 0; k < leaves.size(); ++k)
    flux += mesh[leaves[k]].area * light.at(begin + k, c), area += mesh[leaves[k]].area;
  std::vector<double> luminaires(leaves.size(), exact);
  for (std::size_t k = 0; k < leaves.size() && flux > 0; ++k)
    luminaires[k] = light.at(begin + k, c) * (exact * area / flux);
  return luminaires;
}

/// Irradiance of the leaves from that at their vertices; where sun or luminaire light varies among the corners of what
/// was one element for transport, or comes from near by, their mean of it is put right by the exact flux that the
/// transport found there.
/// Beside an edge the gradients tell of the edge, and not of how the light goes on: there it is the mean of the
/// corners.
Field field_on_leaves(const ElementMesh& mesh, std::span<const std::uint32_t> transport_leaves,
                      const HierarchicalSolution& coarse, const VertexField& field, const NearLuminaires& near,
                      const Problem& on_leaves, std::uint64_t seed) {
  Field E = leaf_irradiance(mesh, field.E);
  if (coarse.delta_light.value.empty()) return E;
  const Field rest = leaf_irradiance(mesh, without_delta_light(field));
  const Field near_light = light_near_luminaires(on_leaves, near.halved, seed);
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  const std::vector<bool> at_edge = points_at_edges(mesh, leaves, field);
  std::size_t begin = 0;
  for (std::size_t j = 0; j < transport_leaves.size(); ++j) {
    const auto own = std::span(leaves).subspan(begin, mesh.leaves_under(transport_leaves[j]));
    const DeltaLight gathered = delta_light(mesh, own, field);
    const bool is_exact = gathered.varies || near.element[j];
    for (int c = 0; c < E.channels && is_exact; ++c) {
      const double exact = coarse.delta_light.at(j, c);
      const std::vector<double> luminaires = near.element[j]
                                                 ? put_right_near(mesh, own, near_light, begin, c, exact)
                                                 : put_right(mesh, own, field.delta_light, c, exact, gathered.mean[c]);
      for (std::size_t k = 0; k < own.size(); ++k) E.at(begin + k, c) = rest.at(begin + k, c) + luminaires[k];
    }
    for (std::size_t k = 0; k < own.size() && !is_exact; ++k) {
      const auto p = mesh.points_of(own[k]);
      if (at_edge[p[0]] || at_edge[p[1]] || at_edge[p[2]])
        E.set(begin + k,
              rest[begin + k] + (field.delta_light[p[0]] + field.delta_light[p[1]] + field.delta_light[p[2]]) / 3);
    }
    begin += own.size();
  }
  return E;
}

/// Beside what ends a little off the surface light may fall through a slit, on a strip that no vertex tells of: only
/// rays from all over the element know its flux. Scales the leaves of such elements to E of the transport.
void keep_flux_at_outlines(const ElementMesh& mesh, std::span<const std::uint32_t> transport_leaves,
                           const Field& E_transport, Field& E) {
  if (mesh.patches().outlines.empty()) return;
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  std::size_t begin = 0;
  for (std::size_t j = 0; j < transport_leaves.size(); ++j) {
    const std::size_t end = begin + mesh.leaves_under(transport_leaves[j]);
    if (mesh.patches().has_outline(PatchId{std::size_t{mesh[transport_leaves[j]].patch}}))
      for (int c = 0; c < E.channels; ++c) {
        double flux = 0, area = 0;
        for (std::size_t k = begin; k < end; ++k) {
          flux += mesh[leaves[k]].area * E.at(k, c);
          area += mesh[leaves[k]].area;
        }
        for (std::size_t k = begin; k < end; ++k)
          E.at(k, c) = flux > 0 ? E.at(k, c) * E_transport.at(j, c) * area / flux : E_transport.at(j, c);
      }
    begin = end;
  }
}

/// Scales what the field has of all light but that of sun and luminaires, so that its flux is that of the transport:
/// the vertices share their directions, and so a small error, while the bundles of the elements are independent of each
/// other. Elements beside slits have their own flux already. What differs by more is no such error, and stays. Where a
/// luminaire is near a surface the spot there sends most of the light on, and each vertex sees it by the same few rays:
/// their error is shared, and larger.
void correct_flux(const HierarchicalSolution& coarse, std::span<const std::uint32_t> transport_leaves, const Field& E,
                  const ElementMesh& mesh, bool any_near, VertexField& field) {
  // Totals of fields were 0.1 to 0.3 % low before this, and no scene came near 1 %; beside lamps up to 6 % off.
  const double most = any_near ? 0.1 : 0.01;
  if (!field.complete || coarse.delta_light.value.empty()) return;
  if (std::find(field.known.begin(), field.known.end(), false) != field.known.end()) return;
  const Field rest = without_delta_light(field);
  const Field on_leaves = leaf_irradiance(mesh, rest);
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  for (int c = 0; c < rest.channels; ++c) {
    double found = 0, exact = 0;
    for (std::size_t j = 0, i = 0; j < transport_leaves.size(); ++j) {
      const std::size_t end = i + mesh.leaves_under(transport_leaves[j]);
      if (mesh.patches().has_outline(PatchId{std::size_t{mesh[transport_leaves[j]].patch}})) {
        i = end;
        continue;
      }
      exact += coarse.elements.area[j] * (E.at(j, c) - coarse.delta_light.at(j, c));
      for (; i < end; ++i) found += mesh[leaves[i]].area * on_leaves.at(i, c);
    }
    const double ratio = found > 0 ? exact / found : 1;
    if (std::abs(ratio - 1) > most) continue;
    for (std::size_t p = 0; p < rest.size(); ++p) field.E.at(p, c) = field.delta_light.at(p, c) + ratio * rest.at(p, c);
  }
}

/// Points not gathered take the mean of the elements around them, middles that of the ends they stand between.
void fill_unknown(const ElementMesh& mesh, const std::vector<std::uint32_t>& transport_leaves, const PatchSet& elements,
                  const Field& E, VertexField& field) {
  std::vector<double> area(field.E.size(), 0.0);
  for (std::size_t j = 0; j < transport_leaves.size(); ++j)
    for (const std::uint32_t p : mesh.points_of(transport_leaves[j])) {
      if (field.known[p]) continue;
      field.E.set(p, (field.E[p] * area[p] + E[j] * elements.area[j]) / (area[p] + elements.area[j]));
      area[p] += elements.area[j];
    }
  for (std::size_t p = 0; p < field.E.size(); ++p)
    if (area[p] == 0 && !field.known[p]) field.E.set(p, (field.E[mesh.ends(p)[0]] + field.E[mesh.ends(p)[1]]) / 2);
}

void view_errors(const ElementMesh& mesh, const VertexField& field, DebugShapes<3>& out) {
  std::vector<double> interpolation, std_error, halvings;
  for (const auto& [leaf, off, soft, E, std_error_there, relative, of_mean] : LeafErrors(mesh, field).of_changed()) {
    out.shapes.push_back(mesh.corner_positions(leaf));
    interpolation.push_back(E > 0 ? off / E : 0);
    std_error.push_back(E > 0 ? std_error_there / E : 0);
    halvings.push_back(mesh[leaf].level);
  }
  out.values = {{"interpolation_error", interpolation}, {"std_error", std_error}, {"level", halvings}};
}

constexpr double kShareOfField = 0.1;    ///< of the time that is left, after the elements at least
constexpr double kSecondsOfField = 0.5;  ///< that vertices get at least, late or not: means of elements show far less

/// Share of the time that is left for the gathers of the caller, as what they and the vertices ask for.
double share_for_later(const Problem& problem, const Solution& coarse, const ElementMesh& mesh,
                       const HierarchicalFieldOptions& options) {
  if (options.later.count == 0) return 0;
  const std::uint64_t seed = options.elements.seed;
  const Illumination light = gather_illumination_by_slits(problem, coarse.B, coarse.slit_light, seed);
  const VertexLightmap& at = mesh.points();
  const auto seconds = [&](const Gathers& gathers) {
    return static_cast<double>(gathers.count) * seconds_a_gather(light, gathers, seed);
  };
  const double of_later = seconds(options.later);
  const double of_vertices =
      seconds({at.sample_position.size(), sample_points(at, problem.rays), options.vertices.quality});
  return of_later / std::max(of_later + of_vertices, 1e-9);
}

}  // namespace

HierarchicalField hierarchical_field(const Problem& problem, VertexLightmap map,
                                     const HierarchicalFieldOptions& options, const Monitor& monitor) {
  ElementMesh mesh(problem.patches, std::move(map));
  HierarchyOptions of_elements = options.elements;
  KeptTransport kept;
  if (!options.layers.empty() && !of_elements.keep) of_elements.keep = &kept;
  Monitor for_elements = monitor.within((1 - kShareOfField) * monitor.seconds_left());
  if (problem.lights.times > 1) for_elements.has_result = {};  // the mean alone of several times is nothing to show
  HierarchicalSolution coarse = hierarchical(problem, mesh, of_elements, for_elements);
  const Problem transport{coarse.elements, problem.rays, problem.lights};
  FieldOptions vertices = options.vertices;
  if (options.goes_on) {
    const std::optional<FieldOptions> how = options.goes_on(transport, coarse.solution, mesh.points());
    if (!how) return {{}, {}, {}, {}, false};
    vertices = *how;
  }
  const std::vector<std::uint32_t> transport_leaves = mesh.leaves();
  Balanced layers;
  TransportLayers transport_layers{transport_leaves, {}, {}};
  std::optional<RowLight> of_layers;
  if (!options.layers.empty() && of_elements.keep->complete) {
    layers = solve_for(*of_elements.keep, options.layers, of_elements.residual, monitor);
    transport_layers.E = std::move(layers.E);
    transport_layers.delta_light = direct_layers(coarse.elements, of_elements.keep->direct, options.layers).delta_light;
    of_layers.emplace(options.layers, problem.patches.channels, layers.B);
    kept = {};
    monitor.say_result();
  }
  const double share_of_later = monitor.has_deadline() ? share_for_later(transport, coarse.solution, mesh, options) : 0;
  const double left = monitor.seconds_left();
  std::optional<FineRadiosity> fine;
  // The direct light of `bf` has the sky in it.
  const bool knows_delta_light = !coarse.delta_light.value.empty() && of_elements.oracle == Oracle::error;
  if (knows_delta_light && !monitor.should_stop())
    fine.emplace(mesh, coarse.elements, coarse.solution.E, coarse.delta_light);
  VertexField field =
      gather_field(transport, coarse.solution.B, mesh, vertices,
                   monitor.within(std::max((1 - share_of_later) * left, kSecondsOfField)),
                   of_layers ? &*of_layers : nullptr, coarse.solution.slit_light, fine ? &*fine : nullptr);
  fine.reset();
  if (options.elements.debug) view_errors(mesh, field, options.elements.debug->error);

  Solution solution = std::move(coarse.solution);
  solution.rays += field.rays;
  solution.log.push_back(std::to_string(transport_leaves.size()) + " elements for transport, " +
                         std::to_string(mesh.leaf_count()) + " shown on " +
                         std::to_string(mesh.points().position.size()) + " points, " + std::to_string(field.alike) +
                         " of them as bright as one beside them");
  if (!(field.complete && field.in_time) && solution.stop == StopReason::converged)
    solution.stop = why_stopped(monitor);
  const NearLuminaires near = near_luminaires(mesh, transport_leaves, coarse, field, problem.lights);
  correct_flux(coarse, transport_leaves, solution.E, mesh, !near.among_leaves.empty(), field);
  fill_unknown(mesh, transport_leaves, coarse.elements, solution.E, field);
  std::vector<bool> spot;
  for (std::size_t j = 0; j < coarse.elements.spot.size(); ++j)
    spot.insert(spot.end(), mesh.leaves_under(transport_leaves[j]), coarse.elements.spot[j]);
  coarse.elements = {};  // a million of them are a third of a gigabyte
  HierarchicalField out{mesh.leaf_patches(), {}, {}, {}};
  Field E = field_on_leaves(mesh, transport_leaves, coarse, field, near, {out.elements, problem.rays, problem.lights},
                            of_elements.seed);
  keep_flux_at_outlines(mesh, transport_leaves, solution.E, E);
  solution.E = std::move(E);
  if (of_layers) {
    finish_layers(mesh, transport_layers, problem.patches.channels, field);
    out.layers.E_elements = irradiance_of_layers(mesh, transport_layers, field, solution.E);
    out.layers.B = radiosity_of_layers(out.elements, out.layers.E_elements, options.layers);
    out.layers.E = std::move(field.layers);
    out.layers.energy = std::move(layers.energy);
  }
  out.lightmap = std::move(mesh).leaf_lightmap();
  out.elements.spot = std::move(spot);
  out.lightmap.E = std::move(field.E);
  for (const std::uint32_t p : carry_flux_to_points(out.elements, solution.E, near.among_leaves, out.lightmap))
    if (of_layers) divide_among_layers(out.lightmap.E[p], problem.patches.channels, lanes_of(out.layers.E, p));
  solution.B = Field(out.elements.patch_count(), out.elements.channels);
  for (std::size_t i = 0; i < out.elements.patch_count(); ++i)
    solution.B.set(i, out.elements.M[i] + out.elements.scattered(solution.E, i));
  out.solution = std::move(solution);
  return out;
}

}  // namespace clerestory
