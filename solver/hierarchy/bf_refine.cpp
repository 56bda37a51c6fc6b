#include "solver/hierarchy/bf_refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/hierarchy/build_tree.h"
#include "solver/hierarchy/gather_links.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"
#include "solver/spaces/closure.h"
#include "solver/visibility/echoes.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr std::size_t kPatchesInBlock = 32;
constexpr int kRaysForClosure = 64;
constexpr std::uint32_t kPairsOfLink = 16, kRaysForEchoes = 128;

Vec3 centre_of(const Sphere& s) { return {s.centre[0], s.centre[1], s.centre[2]}; }

/// What all links need to know.
struct Scene {
  const Problem& problem;
  const ElementTree& tree;
  std::vector<Sphere> sphere;
  std::vector<float> B;      ///< by node, luminous [W/m2]
  std::vector<double> area;  ///< N + 1, of the leaves before each one [m2]
  std::vector<double> flux;  ///< the same of what they send [W]

  Scene(const Problem& p, const ElementTree& t, const Field& radiosity)
      : problem(p), tree(t), sphere(bounding_spheres(t, p.patches)), B(node_light(t, radiosity).mean) {
    area.push_back(0), flux.push_back(0);
    for (const std::uint32_t patch : t.patch) {
      area.push_back(area.back() + p.patches.area[patch]);
      flux.push_back(flux.back() + p.patches.area[patch] * luminous_mean(radiosity[patch]));
    }
  }

  PatchId leaf(std::uint32_t v) const { return PatchId{std::size_t{tree.patch[tree.first_leaf(v)]}}; }
  /// The leaf under v at the share x of its area.
  PatchId leaf_by_area(std::uint32_t v, double x) const { return leaf_at(v, x, area); }
  /// The leaf under v at the share x of what they send.
  PatchId leaf_by_flux(std::uint32_t v, double x) const {
    return leaf_at(v, x, flux[tree.leaf_end(v)] > flux[tree.first_leaf(v)] ? flux : area);
  }

 private:
  PatchId leaf_at(std::uint32_t v, double x, const std::vector<double>& before) const {
    const std::size_t first = tree.first_leaf(v), last = tree.leaf_end(v);
    const double at = before[first] + x * (before[last] - before[first]);
    const auto begin = before.begin() + static_cast<std::ptrdiff_t>(first) + 1;
    const auto found = std::upper_bound(begin, before.begin() + static_cast<std::ptrdiff_t>(last), at);
    return PatchId{std::size_t{tree.patch[static_cast<std::size_t>(found - begin) + first]}};
  }
};

/// Links of one patch and its halves.
class PatchLinks {
 public:
  PatchLinks(const Scene& scene, const BfOptions& options, std::uint32_t root)
      : scene_(scene), options_(options), root_(root), links_(scene.tree.end[root] - root) {}

  void refine(std::uint32_t p, std::uint32_t q) {
    const ElementTree& tree = scene_.tree;
    if (q <= p && p < tree.end[q]) return refine_children_of_source(p, q);
    if (p < q && q < tree.end[p]) return;  // in its plane
    const Sphere &at = scene_.sphere[p], &from = scene_.sphere[q];
    const Vec3 d = centre_of(from) - centre_of(at);
    const PatchSet& patches = scene_.problem.patches;
    if (dot(patches.normal[scene_.leaf(p)], d) < -double{from.radius}) return;
    if (!tree.cluster[q] && dot(patches.normal[scene_.leaf(q)], d) > double{at.radius}) return;
    const double distance = length(d), near = double{at.radius} + double{from.radius};
    const double F = distance <= near ? 1 : std::min(1.0, tree.area[q] / (std::numbers::pi * distance * distance));
    const double stake = luminous_mean(patches.albedo(scene_.leaf(p))) * tree.area[p] * F * double{scene_.B[q]};
    const bool p_leaf = tree.is_leaf(p), q_leaf = tree.is_leaf(q);
    if (stake <= options_.flux_at_stake || (p_leaf && q_leaf)) {
      if (stake > options_.flux_at_stake) to_halve.push_back(scene_.leaf(tree.area[p] >= tree.area[q] ? p : q).value);
      return link(p, q, distance <= 2 * near);
    }
    if (q_leaf || (!p_leaf && tree.area[p] > tree.area[q])) {
      refine(p + 1, q);
      refine(tree.end[p + 1], q);
    } else {
      refine_children_of_source(p, q);
    }
  }

  /// What panes turn back to the leaves: by rays, as kernels do not find it.
  void link_echoes() {
    const Problem& problem = scene_.problem;
    if (!problem.rays.has_echoes()) return;
    for (std::uint32_t v = root_; v < scene_.tree.end[root_]; ++v) {
      if (!scene_.tree.is_leaf(v)) continue;
      const PatchId leaf = scene_.leaf(v);
      const Frame frame(problem.patches.normal[leaf]);
      const auto corners = problem.patches.corner_positions(leaf);
      const std::uint64_t key = stream_key(options_.seed, kEchoFactors, leaf.value);
      for (std::uint32_t k = 0; k < kRaysForEchoes; ++k) {
        const auto u = sobol4(k, key);
        Echo echo;
        problem.rays.first_hit(problem.patches,
                               {problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), frame.n),
                                cosine_direction(frame, u[0], u[1])},
                               &echo);
        follow_echo(problem.rays, problem.patches, echo, key, k, [&](const Hit& hit) {
          if (hit.patch.valid())
            links_[v - root_].push_back({scene_.tree.node_of_patch[hit.patch],
                                         static_cast<float>(luminous_mean(hit.transmittance) / kRaysForEchoes)});
        });
      }
      rays += kRaysForEchoes;
    }
  }

  void write(LinkBlock& block) const {
    for (std::uint32_t v = root_; v < scene_.tree.end[root_]; ++v) {
      const std::vector<Link>& links = links_[v - root_];
      if (links.empty()) continue;
      block.links.insert(block.links.end(), links.begin(), links.end());
      block.row_end.push_back(static_cast<std::uint32_t>(block.links.size()));
      block.receivers.push_back({scene_.tree.first_leaf(v), scene_.tree.leaf_end(v), 1, false});
    }
  }

  std::vector<std::uint32_t> to_halve;
  unsigned long long rays = 0;

 private:
  void refine_children_of_source(std::uint32_t p, std::uint32_t q) {
    for (std::uint32_t child = q + 1; child < scene_.tree.end[q]; child = scene_.tree.end[child]) refine(p, child);
  }

  void link(std::uint32_t p, std::uint32_t q, bool near) {
    const PatchSet& patches = scene_.problem.patches;
    const RayScene& scene = scene_.problem.rays;
    const std::uint64_t key = stream_key(stream_key(options_.seed, kBfPairs), p, q);
    double open = 0, seen = 0;
    auto shadows = shadow_rays<double>(
        scene, [&](double kernel, const Spectrum& passes) { seen += kernel / kPairsOfLink * luminous_mean(passes); });
    for (std::uint32_t k = 0; k < kPairsOfLink; ++k) {
      const auto u = sobol4(k, key), v = sobol4(k, mix_bits(key));
      const PatchId a = scene_.leaf_by_area(p, v[0]), b = scene_.leaf_by_flux(q, v[1]);
      const Vec3 x = point_on_triangle(patches.corner_positions(a), u[0], u[1]);
      const Vec3 y = point_on_triangle(patches.corner_positions(b), u[2], u[3]);
      const double kernel = point_kernel(x, patches.normal[a], y, patches.normal[b]);
      if (!(kernel > 0)) continue;
      shadows.send(scene.off_surface(x, patches.normal[a]), scene.off_surface(y, patches.normal[b]), kernel);
      open += kernel / kPairsOfLink;
    }
    shadows.trace();
    if (!(open > 0)) return;
    rays += kPairsOfLink;
    if (!(seen > 0)) return;
    double F = open * scene_.tree.area[q];
    if (near && scene_.tree.is_leaf(p) && scene_.tree.is_leaf(q))
      F = polygon_to_polygon(patches.corner_positions(scene_.leaf(p)), patches.corner_positions(scene_.leaf(q)));
    links_[p - root_].push_back({q, static_cast<float>(std::min(1.0, F) * seen / open)});
  }

  const Scene& scene_;
  const BfOptions& options_;
  std::uint32_t root_;
  std::vector<std::vector<Link>> links_;
};

}  // namespace

BfLinks bf_refine(const Problem& problem, const ElementTree& tree, const Field& B, const BfOptions& options,
                  const Monitor& monitor) {
  const std::size_t n = tree.leaf_count();
  const Scene scene(problem, tree, B);
  std::vector<std::uint32_t> patches;
  for (std::uint32_t v = 0; v < tree.size();) {
    const bool surface = !tree.cluster[v];
    if (surface) patches.push_back(v);
    v = surface ? tree.end[v] : v + 1;
  }
  BfLinks out;
  Transport& transport = out.transport;
  Closure closure = measure_closure(problem, kRaysForClosure, options.seed);
  transport.arrives.resize(n), transport.escapes.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    transport.arrives[i] = static_cast<float>(luminous_mean(closure.arrives[i]));
    transport.escapes[i] = static_cast<float>(luminous_mean(closure.escapes[i]));
  }
  transport.space = std::move(closure.space), transport.spaces = closure.spaces;
  transport.rays = closure.rays;
  transport.has_gloss = closure.has_gloss;

  transport.blocks.resize((patches.size() + kPatchesInBlock - 1) / kPatchesInBlock);
  std::vector<std::vector<std::uint32_t>> to_halve(transport.blocks.size());
  std::vector<unsigned long long> rays(transport.blocks.size(), 0);
  constexpr std::size_t kBatch = 32;  // blocks between looks at the clock
  for (std::size_t begin = 0; begin < transport.blocks.size() && transport.complete; begin += kBatch) {
    monitor.report("links", static_cast<double>(begin) / static_cast<double>(transport.blocks.size()));
    parallel_for(std::min(kBatch, transport.blocks.size() - begin), 1, [&](std::size_t from, std::size_t to) {
      for (std::size_t b = begin + from; b < begin + to; ++b) {
        const std::size_t first = b * kPatchesInBlock, last = std::min(patches.size(), first + kPatchesInBlock);
        LinkBlock& block = transport.blocks[b];
        block.first_leaf = tree.first_leaf(patches[first]), block.leaf_end = tree.leaf_end(patches[last - 1]);
        for (std::size_t k = first; k < last; ++k) {
          PatchLinks links(scene, options, patches[k]);
          links.refine(patches[k], 0);
          links.link_echoes();
          links.write(block);
          to_halve[b].insert(to_halve[b].end(), links.to_halve.begin(), links.to_halve.end());
          rays[b] += links.rays;
        }
      }
    });
    transport.complete = !monitor.should_stop();
  }
  for (const auto& some : to_halve) out.to_halve.insert(out.to_halve.end(), some.begin(), some.end());
  std::sort(out.to_halve.begin(), out.to_halve.end());
  out.to_halve.erase(std::unique(out.to_halve.begin(), out.to_halve.end()), out.to_halve.end());
  for (const auto r : rays) transport.rays += r;
  return out;
}

}  // namespace clerestory
