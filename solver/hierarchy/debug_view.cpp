#include "solver/hierarchy/debug_view.h"

#include <algorithm>
#include <cstdint>
#include <numbers>

#include "solver/hierarchy/gather_links.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// A receiver and where its links are.
struct Place {
  Receiver receiver;
  std::span<const Link> links;
};

std::vector<Place> receivers(const Transport& transport) {
  std::vector<Place> places;
  for (const LinkBlock& block : transport.blocks) {
    std::size_t row = 0, first = 0;
    for (const Receiver& r : block.receivers) {
      row += r.rows;
      const std::size_t last = row > 0 ? block.row_end[row - 1] : 0;
      places.push_back({r, std::span(block.links).subspan(first, last - first)});
      first = last;
    }
  }
  return places;
}

/// Centres of all nodes.
std::vector<Vec3> centres(const ElementTree& tree, const PatchSet& patches) {
  Field of_leaves(patches.patch_count(), 3), of_nodes;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const auto x = patches.corner_positions(PatchId{i});
    const Vec3 c = (x[0] + x[1] + x[2]) / 3;
    of_leaves.set(i, {c.x, c.y, c.z});
  }
  pull(tree, of_leaves, of_nodes);
  std::vector<Vec3> out(tree.size());
  for (std::size_t v = 0; v < out.size(); ++v) out[v] = {of_nodes.at(v, 0), of_nodes.at(v, 1), of_nodes.at(v, 2)};
  return out;
}

Vec3 centre_of(const Receiver& r, const ElementTree& tree, const PatchSet& patches) {
  Vec3 sum;
  double area = 0;
  for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
    const PatchId p{std::size_t{tree.patch[l]}};
    const auto x = patches.corner_positions(p);
    sum += (x[0] + x[1] + x[2]) / 3 * patches.area[p];
    area += patches.area[p];
  }
  return sum / area;
}

double cluster_around(const ElementTree& tree, std::uint32_t v) {
  while (tree.parent[v] != ElementTree::kNone && !tree.cluster[v]) v = tree.parent[v];
  return v;
}

void view_elements(const PatchSet& patches, const ElementTree& tree, std::span<const Place> places, const Field& E,
                   DebugShapes<3>& out) {
  const std::size_t n = patches.patch_count();
  std::vector<double> level(n), cluster(n), links(n), receiver(n), irradiance(n);
  for (std::size_t r = 0; r < places.size(); ++r)
    for (std::uint32_t l = places[r].receiver.first_leaf; l < places[r].receiver.leaf_end; ++l) {
      links[tree.patch[l]] = static_cast<double>(places[r].links.size());
      receiver[tree.patch[l]] = static_cast<double>(r);
    }
  out.shapes.clear();
  for (std::size_t i = 0; i < n; ++i) {
    out.shapes.push_back(patches.corner_positions(PatchId{i}));
    level[i] = patches.level.empty() ? 0 : patches.level[i];
    cluster[i] = cluster_around(tree, tree.node_of_patch[i]);
    irradiance[i] = luminous_mean(E[i]);
  }
  out.values = {
      {"level", level}, {"cluster", cluster}, {"links", links}, {"receiver", receiver}, {"irradiance", irradiance}};
}

void view_links(const PatchSet& patches, const ElementTree& tree, const Place& place, const Field& B,
                DebugShapes<2>& out) {
  Field of_nodes;
  pull(tree, B, of_nodes);
  const std::vector<Vec3> centre = centres(tree, patches);
  const Vec3 here = centre_of(place.receiver, tree, patches);
  std::vector<double> weight, radiosity;
  out.shapes.clear();
  for (const Link& link : place.links) {
    out.shapes.push_back({here, centre[link.source]});
    weight.push_back(double{link.weight});
    radiosity.push_back(luminous_mean(of_nodes[link.source]));
  }
  out.values = {{"weight", weight}, {"source_radiosity", radiosity}};
}

void view_rays(const Illumination& light, std::span<const BundleRay> bundle, const Field& B, DebugShapes<2>& out) {
  double longest = 0;
  for (const BundleRay& b : bundle)
    if (!b.hit.escaped()) longest = std::max(longest, b.hit.distance);
  if (longest == 0) longest = light.problem.rays.diameter();
  std::vector<double> radiosity;
  out.shapes.clear();
  for (const auto& [ray, hit] : bundle) {
    out.shapes.push_back({ray.origin, ray.origin + ray.direction * (hit.escaped() ? longest : hit.distance)});
    Spectrum landed(0.0);
    if (hit.escaped()) landed = light.sky(ray.direction) * std::numbers::pi;
    if (hit.patch.valid()) landed = B[hit.patch];
    radiosity.push_back(luminous_mean(landed));
  }
  out.values = {{"landed_radiosity", radiosity}};
}

}  // namespace

void view_round(const Illumination& light, const ElementTree& tree, const Transport& transport,
                const LinkOptions& options, const Solution& solution, HierarchyDebug& view) {
  const PatchSet& patches = light.problem.patches;
  const std::vector<Place> places = receivers(transport);
  view_elements(patches, tree, places, solution.E, view.hierarchy);
  const auto most = std::max_element(places.begin(), places.end(),
                                     [](const Place& a, const Place& b) { return a.links.size() < b.links.size(); });
  if (most == places.end()) return;
  view_links(patches, tree, *most, solution.B, view.links);
  view_rays(light, trace_bundle(light, tree, most->receiver, options), solution.B, view.rays);
}

}  // namespace clerestory
