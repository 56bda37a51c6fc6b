#include "solver/solve_hierarchical.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "solver/gather.h"
#include "solver/hierarchy/vertex_field.h"
#include "solver/memory_estimate.h"
#include "solver/methods/hierarchical.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// What --accuracy stands for.
struct Detail {
  int bundle_rays, lamp_rays;
  double element_tolerance;  ///< of the irradiance within an element
  double vertex_tolerance;   ///< of the irradiance between vertices
  double finest;             ///< shortest edge / longest edge
  std::size_t most_points;   ///< gathered
};

Detail detail(const SolveOptions& options) {
  const int more = 1 << options.tighten;
  const double finer = std::pow(0.7071, options.tighten);
  switch (options.accuracy) {
    case Accuracy::draft:
      return {128 * more, 64 * more, 0.3, 0.1 * finer, 1.0 / 4, 100'000};
    case Accuracy::standard:
      return {256 * more, 128 * more, 0.1, 0.05 * finer, 1.0 / 8, 400'000};
    case Accuracy::fine:
      return {256 * more, 256 * more, 0.05, 0.035 * finer, 1.0 / 16, 1'600'000};
  }
  return {};
}

MemoryCounts whole(const PatchSet& patches, const VertexLightmap& map) {
  const std::size_t sides = patches.patch_count();
  return {.triangles = patches.triangle_count(), .sides = sides, .elements = sides, .points = map.position.size()};
}

/// The detail that was asked for, or what a limit of memory leaves of it.
std::optional<MemoryPlan> memory_plan(const PatchSet& patches, const VertexLightmap& map, const SolveOptions& options) {
  const Detail d = detail(options);
  const MemoryPlan wish{std::min(20 * map.position.size() + 10'000, d.most_points), HierarchyOptions{}.most_elements,
                        d.bundle_rays, d.lamp_rays};
  if (options.memory_limit == 0) return wish;
  return plan_memory(whole(patches, map), wish, options.memory_limit);
}

/// Mean of sun and lamp light over leaves of one element, and whether it varies among their corners.
struct SmallLights {
  Spectrum mean;
  bool varies = false;
};

SmallLights small_lights(const ElementMesh& mesh, std::span<const std::uint32_t> leaves, const VertexField& field) {
  constexpr double kVaries = 0.1;  // less is left to the vertices, which know it as well
  SmallLights found;
  double low = std::numeric_limits<double>::infinity(), high = 0, share = 0;
  for (const std::uint32_t leaf : leaves) {
    const double part = std::ldexp(1.0, -mesh[leaf].level);
    for (const std::uint32_t p : mesh[leaf].point) {
      if (!field.known[p]) return {};
      const Spectrum lamps = field.small_lights[p];
      found.mean += lamps * (part / 3);
      low = std::min(low, luminous_mean(lamps)), high = std::max(high, luminous_mean(lamps));
    }
    share += part;
  }
  found.mean *= 1 / share;
  found.varies = high - low > kVaries * high;
  return found;
}

Field without_small_lights(const VertexField& field) {
  Field rest = field.E;
  for (std::size_t k = 0; k < rest.value.size(); ++k) rest.value[k] -= field.small_lights.value[k];
  return rest;
}

/// Irradiance of the leaves from that at their vertices; where sun or lamp light varies among the corners of what was
/// one element for transport, their mean of it is put right by the exact flux that the transport found there.
Field field_on_leaves(const ElementMesh& mesh, std::span<const std::uint32_t> transport_leaves,
                      const HierarchicalSolution& coarse, const VertexField& field) {
  Field E = leaf_irradiance(mesh, field.E);
  if (coarse.small_lights.value.empty()) return E;
  const Field rest = leaf_irradiance(mesh, without_small_lights(field));
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  std::size_t begin = 0;
  for (std::size_t j = 0; j < transport_leaves.size(); ++j) {
    const auto own = std::span(leaves).subspan(begin, mesh.leaves_under(transport_leaves[j]));
    const SmallLights gathered = small_lights(mesh, own, field);
    for (std::size_t k = 0; k < own.size() && gathered.varies; ++k)
      for (int c = 0; c < E.channels; ++c) {
        double lamps = 0;
        for (const std::uint32_t p : mesh[own[k]].point) lamps += field.small_lights.at(p, c) / 3;
        // In proportion: what is added evenly where it is dark would have to be taken away where there is nothing.
        const double exact = coarse.small_lights.at(j, c), mean = gathered.mean[c];
        E.at(begin + k, c) = rest.at(begin + k, c) + (mean > 0 ? lamps * exact / mean : exact);
      }
    begin += own.size();
  }
  return E;
}

/// Scales what the field has of all light but that of sun and lamps, so that its flux is that of the transport: the
/// vertices share their directions, and so a small error, while the bundles of the elements are independent of each
/// other. What differs by more is no such error, and stays.
void correct_flux(const HierarchicalSolution& coarse, const Field& E, const ElementMesh& mesh, VertexField& field) {
  constexpr double kMost = 0.01;
  if (!field.complete || coarse.small_lights.value.empty()) return;
  const Field rest = without_small_lights(field);
  const Field on_leaves = leaf_irradiance(mesh, rest);
  const std::vector<std::uint32_t> leaves = mesh.leaves();
  for (int c = 0; c < rest.channels; ++c) {
    double found = 0, exact = 0;
    for (std::size_t j = 0; j < coarse.elements.patch_count(); ++j)
      exact += coarse.elements.area[j] * (E.at(j, c) - coarse.small_lights.at(j, c));
    for (std::size_t i = 0; i < leaves.size(); ++i)
      found += std::ldexp(mesh.patches().area[mesh[leaves[i]].patch], -mesh[leaves[i]].level) * on_leaves.at(i, c);
    const double ratio = found > 0 ? exact / found : 1;
    if (std::abs(ratio - 1) > kMost) continue;
    for (std::size_t p = 0; p < rest.size(); ++p)
      field.E.at(p, c) = field.small_lights.at(p, c) + ratio * rest.at(p, c);
  }
}

/// Points not gathered take the mean of the elements around them, middles that of the ends they stand between.
void fill_unknown(const ElementMesh& mesh, const std::vector<std::uint32_t>& transport_leaves, const PatchSet& elements,
                  const Field& E, VertexField& field) {
  std::vector<double> area(field.E.size(), 0.0);
  for (std::size_t j = 0; j < transport_leaves.size(); ++j)
    for (const std::uint32_t p : mesh[transport_leaves[j]].point) {
      if (field.known[p]) continue;
      field.E.set(p, (field.E[p] * area[p] + E[j] * elements.area[j]) / (area[p] + elements.area[j]));
      area[p] += elements.area[j];
    }
  for (std::size_t p = 0; p < field.E.size(); ++p)
    if (area[p] == 0 && !field.known[p]) field.E.set(p, (field.E[mesh.ends(p)[0]] + field.E[mesh.ends(p)[1]]) / 2);
}

void view_errors(const ElementMesh& mesh, const VertexField& field, DebugShapes<3>& out) {
  std::vector<double> interpolation, noise, halvings;
  for (const auto& [leaf, off, level, standard_error] : leaf_errors(mesh, field)) {
    out.shapes.push_back(mesh.corner_positions(leaf));
    interpolation.push_back(level > 0 ? off / level : 0);
    noise.push_back(level > 0 ? standard_error / level : 0);
    halvings.push_back(mesh[leaf].level);
  }
  out.values = {{"interpolation_error", interpolation}, {"noise", noise}, {"level", halvings}};
}

}  // namespace

bool has_memory_for(const PatchSet& patches, const VertexLightmap& map, const SolveOptions& options) {
  if (options.method == Method::hierarchical) return memory_plan(patches, map, options).has_value();
  return options.memory_limit == 0 || predicted_memory(whole(patches, map)) <= options.memory_limit;
}

ShownSolution solve_hierarchical(const Problem& problem, VertexLightmap map, double longest_edge,
                                 const SolveOptions& options, const Monitor& monitor, HierarchyDebug* debug) {
  const Detail d = detail(options);
  const MemoryPlan plan = memory_plan(problem.patches, map, options).value_or(MemoryPlan{0, 0, 32, 16});
  ElementMesh mesh(problem.patches, std::move(map));
  HierarchicalSolution coarse = hierarchical(problem, mesh,
                                             {.bundle_rays = plan.bundle_rays,
                                              .lamp_rays = plan.lamp_rays,
                                              .tolerance = d.element_tolerance,
                                              .shortest_edge = d.finest * longest_edge,
                                              .most_elements = plan.most_elements,
                                              .seed = options.seed,
                                              .debug = debug},
                                             monitor);
  const std::vector<std::uint32_t> transport_leaves = mesh.leaves();
  const Problem transport{coarse.elements, problem.rays, problem.lights};
  VertexField field = gather_field(transport, coarse.solution.B, mesh,
                                   {.tolerance = d.vertex_tolerance,
                                    .shortest_edge = d.finest * longest_edge,
                                    .most_points = plan.most_points,
                                    .quality = vertex_quality(options),
                                    .seed = options.seed},
                                   monitor);

  if (debug) view_errors(mesh, field, debug->error);

  Solution solution = std::move(coarse.solution);
  solution.rays += field.rays;
  solution.log.push_back(std::to_string(transport_leaves.size()) + " elements for transport, " +
                         std::to_string(mesh.leaf_count()) + " shown on " +
                         std::to_string(mesh.points().position.size()) + " points");
  if (!field.complete && solution.stop == StopReason::converged) solution.stop = why_stopped(monitor);
  correct_flux(coarse, solution.E, mesh, field);
  fill_unknown(mesh, transport_leaves, coarse.elements, solution.E, field);
  coarse.elements = {};  // a million of them are a third of a gigabyte
  solution.E = field_on_leaves(mesh, transport_leaves, coarse, field);
  ShownSolution shown{mesh.leaf_patches(), std::move(mesh).leaf_lightmap(), {}};
  shown.lightmap.E = std::move(field.E);
  solution.B = Field(shown.elements.patch_count(), shown.elements.channels);
  for (std::size_t i = 0; i < shown.elements.patch_count(); ++i)
    solution.B.set(i, shown.elements.M[i] + shown.elements.scattered(solution.E, i));
  shown.solution = std::move(solution);
  return shown;
}

}  // namespace clerestory
