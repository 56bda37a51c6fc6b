#include "solver/hierarchy/trace_links.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "solver/hierarchy/arrivals.h"
#include "solver/hierarchy/cut_row.h"
#include "solver/hierarchy/gather_links.h"
#include "solver/hierarchy/receiver_area.h"
#include "solver/hierarchy/receiver_rays.h"
#include "solver/hierarchy/receivers.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/sampling/bundle_net.h"

namespace clerestory {
namespace {

constexpr std::size_t kReceiversInBlock = 64;
constexpr std::size_t kBlocksInBatch = 64;  // between reports

/// Hits of a receiver on others, which tell what space it is in; kNone where there are fewer. Not more: what is seen
/// through a slit by one ray of many is no neighbour.
using Neighbours = std::array<std::uint32_t, 8>;

/// What the links of all receivers are made from.
struct Given {
  Surroundings around;
  const LinkOptions& options;
  BundleNet net;
  NodeLight nodes;  ///< empty: B is not known
};

/// Memory that receivers need in turn.
struct Workspace {
  ReceiverArea area;
  Bundle bundle;
  Arrivals arrivals;
};

BundleNet net_of(const LinkOptions& options) {
  return BundleNet(options.bundle_rays, stream_key(options.seed, kBundle));
}

std::uint64_t key_of(const ReceiverArea& area, const LinkOptions& options) {
  return stream_key(options.seed, kBundle, area.members()[0].patch);
}

/// With B as known so far.
double irradiance(const Given& given, const ReceiverArea& area, const Arrivals& arrivals) {
  const DirectLight& direct = given.around.direct;
  double E = arrivals.E_sky;
  for (const Arrival& a : arrivals.list) E += a.weight * given.nodes.mean[a.node];
  for (const ReceiverArea::Member& m : area.members()) {
    const double share = m.area / area.area();
    E += share * luminous_mean(direct.E[m.patch]);
    if (!direct.E_openings.value.empty()) E += share * luminous_mean(direct.E_openings[m.patch]);
  }
  return E;
}

/// A row of links for each part of the sphere that light comes from, and at least one; then the views of the sky.
void write_rows(Receiver receiver, const Given& given, Workspace& work, LinkBlock& out) {
  sort_for_cut(work.arrivals.list);
  const double limit =
      given.nodes.mean.empty() ? 0 : given.options.uniform * irradiance(given, work.area, work.arrivals);
  std::span<const Arrival> left = work.arrivals.list;
  receiver.rows = 0;
  do {
    const std::uint16_t part = left.empty() ? std::uint16_t{0} : left.front().part;
    std::size_t count = 0;
    while (count < left.size() && left[count].part == part) ++count;
    cut_row(left.first(count), given.around.tree, given.nodes, limit, out.links);
    out.row_end.push_back(static_cast<std::uint32_t>(out.links.size()));
    ++receiver.rows;
    if (receiver.hands_down) work.arrivals.shares.write(part, work.area.members().size(), out.shares);
    left = left.subspan(count);
  } while (!left.empty());
  receiver.views = static_cast<std::uint32_t>(work.arrivals.views.size());
  receiver.view_weight = work.arrivals.view_weight;
  out.views.insert(out.views.end(), work.arrivals.views.begin(), work.arrivals.views.end());
  out.shared_views.insert(out.shared_views.end(), work.arrivals.shared_views.begin(), work.arrivals.shared_views.end());
  out.receivers.push_back(receiver);
}

void write_views(const Workspace& work, Transport& transport) {
  const auto members = work.area.members();
  for (std::size_t m = 0; m < members.size(); ++m) {
    const MemberView& view = work.arrivals.view[m];
    transport.arrives[members[m].patch] = view.arrives;
    transport.escapes[members[m].patch] = view.escapes;
  }
}

/// Not on itself: behind a mirror that hangs on a wall most of what a patch sees is its own image.
void note_neighbours(std::span<const Hit> hits, const ReceiverArea& area, Neighbours& neighbours) {
  std::size_t met = 0;
  const auto is_itself = [&](std::uint32_t q) {
    return std::ranges::any_of(area.members(), [&](const ReceiverArea::Member& m) { return m.patch == q; });
  };
  for (const Hit& hit : hits) {
    if (met == neighbours.size()) return;
    if (hit.patch.valid() && !is_itself(hit.patch.value)) neighbours[met++] = hit.patch.value;
  }
}

void link(const Receiver& receiver, const Given& given, Workspace& work, LinkBlock& out, Transport& transport,
          Neighbours& neighbours) {
  const Illumination& light = given.around.light;
  work.area.look_at(receiver, given.around.tree, light.problem.patches);
  const std::uint64_t key = key_of(work.area, given.options);
  const int pairs = pairs_worth_sending(work.area, light, given.options.bright_rays, key);
  send_bundle(work.area, light.problem, given.net, key, work.bundle);
  find_arrivals(work.area, work.bundle, given.around, pairs, key, work.arrivals);
  note_neighbours(work.bundle.hits, work.area, neighbours);
  write_views(work, transport);
  write_rows(receiver, given, work, out);
}

/// Numbers the spaces: leaves that see each other, directly or over others.
void find_spaces(Transport& transport, const PatchSet& patches, const ElementTree& tree,
                 std::span<const Receiver> receivers, std::span<const Neighbours> neighbours) {
  const std::size_t n = tree.leaf_count();
  DisjointSets joined(n);
  for (std::size_t r = 0; r < receivers.size(); ++r) {
    const std::size_t p = tree.patch[receivers[r].first_leaf];
    for (std::uint32_t l = receivers[r].first_leaf + 1; l < receivers[r].leaf_end; ++l) joined.join(p, tree.patch[l]);
    for (const std::uint32_t q : neighbours[r])
      if (q != PatchId::kNone) joined.join(p, q);
  }
  for (std::size_t i = 0; i < n; ++i)
    for (const PatchSet::Behind& other : patches.patches_behind(i)) joined.join(i, other.patch);
  transport.space.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t first = joined.find(i);
    transport.space[i] = first == i ? static_cast<std::uint32_t>(transport.spaces++) : transport.space[first];
  }
}

}  // namespace

Transport trace_links(const Illumination& light, const ElementTree& tree, const Field& B, const DirectLight& direct,
                      const LinkOptions& options, const Monitor& monitor) {
  const PatchSet& patches = light.problem.patches;
  const std::size_t n = patches.patch_count();
  Transport transport;
  transport.arrives.resize(n), transport.escapes.resize(n);
  transport.bundle_rays = options.bundle_rays;
  transport.has_gloss = light.problem.rays.has_gloss();
  const bool merges = B.size() == n;
  const SlitLines slits(light, options.seed);
  const Given given{{light, tree, direct, slits, options.sky_views, merges && options.uniform > 0},
                    options,
                    net_of(options),
                    merges ? node_light(tree, B) : NodeLight{}};
  const std::vector<Receiver> receivers = choose_receivers(tree, patches, options.cluster_diameter, kMostReceivers);
  Neighbours nobody;
  nobody.fill(PatchId::kNone);
  std::vector<Neighbours> neighbours(receivers.size(), nobody);
  transport.blocks.resize((receivers.size() + kReceiversInBlock - 1) / kReceiversInBlock);

  const auto fill_block = [&](std::size_t b, Workspace& work) {
    LinkBlock& block = transport.blocks[b];
    const std::size_t first = b * kReceiversInBlock, last = std::min(receivers.size(), first + kReceiversInBlock);
    block.first_leaf = receivers[first].first_leaf, block.leaf_end = receivers[last - 1].leaf_end;
    for (std::size_t r = first; r < last; ++r) link(receivers[r], given, work, block, transport, neighbours[r]);
    block.links.shrink_to_fit(), block.shares.shrink_to_fit();
    block.views.shrink_to_fit(), block.shared_views.shrink_to_fit();
  };
  const std::size_t blocks = transport.blocks.size();
  std::atomic<bool> stopped = false;
  for (std::size_t begin = 0; begin < blocks && !stopped; begin += kBlocksInBatch) {
    monitor.report("links", static_cast<double>(begin) / static_cast<double>(blocks));
    parallel_for(std::min(kBlocksInBatch, blocks - begin), 1, [&](std::size_t from, std::size_t to) {
      Workspace work{{}, Bundle(options.bundle_rays), {}};
      for (std::size_t b = begin + from; b < begin + to && !stopped; ++b)
        if (monitor.should_stop())
          stopped = true;
        else
          fill_block(b, work);
    });
  }
  transport.complete = !stopped;
  if (stopped) return transport;
  const int pairs = light.sampler.has_bright_patches() ? options.bright_rays : 0;
  transport.rays = receivers.size() * static_cast<unsigned long long>(options.bundle_rays + pairs) + slits.rays();
  find_spaces(transport, patches, tree, receivers, neighbours);
  return transport;
}

std::vector<BundleRay> trace_bundle(const Illumination& light, const ElementTree& tree, const Receiver& receiver,
                                    const LinkOptions& options) {
  ReceiverArea area;
  area.look_at(receiver, tree, light.problem.patches);
  Bundle bundle(options.bundle_rays);
  send_bundle(area, light.problem, net_of(options), key_of(area, options), bundle);
  std::vector<BundleRay> out;
  for (std::size_t k = 0; k < bundle.rays.size(); ++k) out.push_back({bundle.rays[k], bundle.hits[k]});
  return out;
}

}  // namespace clerestory
