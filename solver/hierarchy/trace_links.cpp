#include "solver/hierarchy/trace_links.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numbers>

#include "solver/hierarchy/gather_links.h"
#include "solver/hierarchy/receivers.h"
#include "solver/model/disjoint_sets.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/bundle_net.h"
#include "solver/sampling/two_estimators.h"
#include "solver/sampling/unit_square.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

constexpr double kMostOwed = 0.1;         // of the limit for one link: a row may not drift by more while it is cut
constexpr int kZones = 6, kSectors = 12;  // parts of the sphere
constexpr std::size_t kParts = kZones * kSectors;
constexpr std::size_t kReceiversInBlock = 64;
constexpr std::size_t kMostLinks = 192;  // of a row; more are merged, whatever `uniform` says
constexpr std::size_t kNeighbours = 8;   // hits of a receiver that tell which space it is in

/// Parts of the sphere that a cluster tells apart: zones of equal height in equal sectors.
std::uint16_t part_of_sphere(const Vec3& d) {
  const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5;
  const int zone = std::clamp(static_cast<int>((d.z + 1) / 2 * kZones), 0, kZones - 1);
  const int sector = std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1);
  return static_cast<std::uint16_t>(zone * kSectors + sector);
}

/// Light on its way into a receiver.
struct Arrival {
  std::uint32_t node;  ///< leaf of the tree
  float weight;
  std::uint16_t part;  ///< of the sphere; 0 for surfaces
  bool bright;
};

/// One receiver after another; holds the memory they need in turn.
class Tracer {
 public:
  Tracer(const Illumination& light, const ElementTree& tree, const BundleNet& net, const NodeLight* nodes,
         const DirectLight& direct, const LinkOptions& options)
      : light_(light),
        tree_(tree),
        net_(net),
        nodes_(nodes),
        direct_(direct),
        options_(options),
        patches_(light.problem.patches),
        rays_(static_cast<std::size_t>(options.bundle_rays)),
        hits_(rays_.size()),
        from_(rays_.size()) {}

  void add(const Receiver& receiver, LinkBlock& out, Transport& transport, std::span<std::uint32_t> neighbours) {
    look_at(receiver);
    pairs_ =
        light_.sampler.has_bright_patches() && options_.bright_rays > 0 && (light_.sky.dark() || sees_bright_patches());
    send_bundle(transport, neighbours);
    if (pairs_) send_pairs();
    fill_row(transport);
    write(receiver, out);
  }

  std::vector<BundleRay> bundle(const Receiver& receiver) {
    look_at(receiver);
    send_rays();
    std::vector<BundleRay> out;
    for (std::size_t k = 0; k < rays_.size(); ++k) out.push_back({rays_[k], hits_[k]});
    return out;
  }

 private:
  struct Member {
    std::uint32_t patch;
    std::array<Vec3, 3> corners;
    Vec3 normal;
    double area, cumulative;
  };

  void look_at(const Receiver& receiver) {
    members_.clear();
    double sum = 0;
    for (std::uint32_t l = receiver.first_leaf; l < receiver.leaf_end; ++l) {
      const PatchId p{std::size_t{tree_.patch[l]}};
      sum += patches_.area[p];
      members_.push_back({p.value, patches_.corner_positions(p), patches_.normal[p], patches_.area[p], sum});
    }
    area_ = sum;
    key_ = stream_key(options_.seed, kBundle, members_[0].patch);
    hands_down_ = receiver.hands_down;
    arrivals_.clear();
    bright_ = bright_seen_ = bright_hits_ = 0;
    if (hands_down_) shares_ = {}, part_weight_ = {};
  }

  /// The member at the share x of the area; x becomes the place within it, uniform again.
  const Member& pick(double& x) const {
    if (members_.size() == 1) return members_[0];
    const double at = x * area_;
    const auto m = std::upper_bound(members_.begin(), members_.end() - 1, at,
                                    [](double a, const Member& member) { return a < member.cumulative; });
    x = std::clamp((at - (m->cumulative - m->area)) / m->area, 0.0, 1 - 1e-12);
    return *m;
  }

  /// What member m gets of light from d, against an even share by area: cos_m sum a / sum a cos.
  void find_shares(const Vec3& d, std::span<double> share) const {
    double sum = 0;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      share[m] = std::max(0.0, dot(members_[m].normal, d));
      sum += members_[m].area * share[m];
    }
    for (double& s : share) s = sum > 0 ? s * area_ / sum : 1;
  }

  std::uint16_t part(const Vec3& d) const { return hands_down_ ? part_of_sphere(d) : std::uint16_t{0}; }

  void send_rays() {
    const Problem& problem = light_.problem;
    const Frame frame(members_[0].normal);
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      auto u = net_(k, key_);
      from_[k] = &pick(u[2]);
      const Vec3 normal = from_[k]->normal;
      rays_[k] = {point_on_triangle(from_[k]->corners, u[2], u[3]) + normal * problem.rays.lift(),
                  cosine_direction(members_.size() > 1 ? Frame(normal) : frame, u[0], u[1])};
    }
    problem.rays.first_hits(patches_, rays_, hits_);
  }

  void send_bundle(Transport& transport, std::span<std::uint32_t> neighbours) {
    const int R = options_.bundle_rays;
    const std::size_t n = members_.size();
    std::array<double, kMostMembers> share{}, all{}, arrive{}, escape{};
    std::array<Spectrum, kMostMembers> sky{};
    share[0] = 1;
    std::size_t met = 0;
    send_rays();
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      const Hit& hit = hits_[k];
      const Member& from = *from_[k];
      const auto& [x, d] = rays_[k];
      const double passes = luminous_mean(hit.transmittance);
      if (n > 1) find_shares(d, std::span(share).first(n));
      if (hit.escaped()) {
        const Spectrum from_sky = light_.sky(hit.direction(rays_[k])) * std::numbers::pi * hit.transmittance;
        for (std::size_t m = 0; m < n; ++m) {
          escape[m] += share[m] * passes;
          if (!is_looked_for(members_[m].patch, rays_[k], hit)) sky[m] += from_sky * share[m];
        }
      } else if (hit.patch.valid()) {
        if (met < neighbours.size()) neighbours[met++] = hit.patch.value;
        const bool bright = pairs_ && !hit.reflected && light_.sampler.is_bright(hit.patch);
        double weight = 1.0 / R;
        if (bright) {
          const double cos_p = dot(from.normal, d) / std::numbers::pi;
          const double density = light_.sampler.density(hit, x, from.normal, d, true);
          weight = cos_p * power_heuristic_over_density(R * cos_p, options_.bright_rays * density);
        }
        if (bright) bright_hits_ += 1.0 / R;
        add_arrival(hit.patch, weight, passes, bright, d);
        for (std::size_t m = 0; m < n && !bright; ++m) arrive[m] += share[m] * passes;
      }
      for (std::size_t m = 0; m < n; ++m) all[m] += share[m];
    }
    sky_mean_ = 0;
    for (std::size_t m = 0; m < n; ++m) {
      const std::uint32_t p = members_[m].patch;
      transport.E_sky.set(p, sky[m] / R);
      transport.arrives[p] = static_cast<float>(all[m] > 0 ? arrive[m] / all[m] : 0);
      transport.escapes[p] = static_cast<float>(all[m] > 0 ? escape[m] / all[m] : 0);
      sky_mean_ += members_[m].area / area_ * luminous_mean(sky[m] / R);
    }
  }

  /// Whether direct light has looked for this ray's sky through an opening.
  bool is_looked_for(std::uint32_t patch, const Ray& ray, const Hit& hit) const {
    const auto openings = direct_.openings.of(patch);
    return !openings.empty() &&
           first_way_out(light_.problem.lights.openings, openings, ray.origin, ray.direction, hit.first) != kNoOpening;
  }

  /// One pair of a point of the receiver with one of a bright patch.
  struct Pair {
    Vec3 from, to, normal;
    LightSample sample;
  };
  Pair pair(std::uint32_t number, std::uint64_t key) const {
    // Place and choice of the source matter most: they share one sequence, and are stratified against each other.
    const auto u = sobol4(number, key);
    auto v = sobol4(number, mix_bits(key));
    const Member& member = pick(v[1]);
    const Vec3 from = point_on_triangle(member.corners, u[0], u[1]) + member.normal * light_.problem.rays.lift();
    const LightSample s = light_.sampler.sample(from, member.normal, u[2], u[3], v[0], true);
    return {from, s.density > 0 ? s.end : from, member.normal, s};
  }

  /// Under the sky bright patches mostly lie outdoors, and most receivers do not see them: a few pairs tell. Without
  /// any that gets through, bright patches are left to the bundle.
  bool sees_bright_patches() const {
    return any_visible(light_.problem.rays, 16, [&](std::uint32_t k, Vec3& from, Vec3& to) {
      const Pair p = pair(k, mix_bits(key_ + kBrightPairPilot));
      from = p.from, to = p.to;
      return p.sample.density > 0;
    });
  }

  void send_pairs() {
    const RayScene& rays = light_.problem.rays;
    const std::uint64_t key = mix_bits(key_ + kBrightPairs);
    struct Load {
      PatchId source;
      double weight;
      Vec3 direction;
    };
    auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Vec3& from, const Vec3& to) {
      const double passes = luminous_mean(rays.glass_transmittance(from, to));
      add_arrival(load.source, load.weight, passes, true, load.direction);
    });
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(options_.bright_rays); ++k) {
      const Pair p = pair(k, key);
      if (!(p.sample.density > 0)) continue;
      const Vec3 direction = normalized(p.to - p.from);
      const double cos_p = std::max(0.0, dot(p.normal, direction)) / std::numbers::pi;
      const double weight =
          cos_p * power_heuristic_over_density(options_.bright_rays * p.sample.density, options_.bundle_rays * cos_p);
      if (weight > 0) shadows.send(p.from, p.to, {p.sample.patch, weight, direction});
    }
    shadows.trace();
  }

  void add_arrival(PatchId source, double weight, double passes, bool bright, const Vec3& d) {
    if (bright) bright_seen_ += weight, bright_ += weight * passes;
    weight *= passes;
    const std::uint16_t where = part(d);
    arrivals_.push_back({tree_.node_of_patch[source], static_cast<float>(weight), where, bright});
    if (hands_down_) add_shares(where, weight, d);
  }

  /// All directions sum to 1. What the bright sources leave, by their better estimate, is shared by the rest of the
  /// bundle: other patches, what escapes, what is lost.
  void fill_row(Transport& transport) {
    const bool rest = bright_hits_ < 1 && bright_seen_ < 1;
    const double gain = rest ? (1 - bright_seen_) / (1 - bright_hits_) : 0;
    const double gain_bright = rest ? 1 : 1 / bright_seen_;
    for (Arrival& a : arrivals_) a.weight = static_cast<float>(a.weight * (a.bright ? gain_bright : gain));
    for (const Member& m : members_) {
      transport.E_sky.set(m.patch, transport.E_sky[m.patch] * gain);
      transport.escapes[m.patch] = static_cast<float>(transport.escapes[m.patch] * gain);
      transport.arrives[m.patch] = static_cast<float>(transport.arrives[m.patch] * gain + bright_ * gain_bright);
    }
    sky_mean_ *= gain;
  }

  void write(const Receiver& receiver, LinkBlock& out) {
    std::sort(arrivals_.begin(), arrivals_.end(), [](const Arrival& a, const Arrival& b) {
      return a.part < b.part || (a.part == b.part && a.node < b.node);
    });
    limit_ = nodes_ ? options_.uniform * irradiance() : 0;
    most_owed_ = kMostOwed * limit_, owed_ = 0;
    Receiver r = receiver;
    r.rows = 0;
    std::size_t first = 0;
    do {
      std::size_t last = first;
      while (last < arrivals_.size() && arrivals_[last].part == arrivals_[first].part) ++last;
      const std::size_t before = out.links.size();
      double limit = limit_;
      if (last > first) cut(0, first, last, out.links);
      while (nodes_ && limit_ > 0 && out.links.size() - before > kMostLinks && limit_ < 64 * limit) {
        limit_ *= 2;
        owed_ = 0;
        out.links.resize(before);
        cut(0, first, last, out.links);
      }
      if (nodes_) settle(std::span(out.links).subspan(before));
      limit_ = limit, owed_ = 0;
      out.row_end.push_back(static_cast<std::uint32_t>(out.links.size()));
      ++r.rows;
      if (r.hands_down) write_shares(first < last ? arrivals_[first].part : 0, out.shares);
      first = last;
    } while (first < arrivals_.size());
    out.receivers.push_back(r);
  }

  /// With B as known so far.
  double irradiance() const {
    double E = sky_mean_;
    for (const Arrival& a : arrivals_) E += a.weight * nodes_->mean[a.node];
    for (const Member& m : members_) {
      E += m.area / area_ * luminous_mean(direct_.E[m.patch]);
      if (!direct_.E_openings.value.empty()) E += m.area / area_ * luminous_mean(direct_.E_openings[m.patch]);
    }
    return E;
  }

  void add_shares(std::uint16_t part, double weight, const Vec3& d) {
    std::array<double, kMostMembers> share{};
    find_shares(d, std::span(share).first(members_.size()));
    for (std::size_t m = 0; m < members_.size(); ++m) shares_[part][m] += weight * share[m];
    part_weight_[part] += weight;
  }
  void write_shares(std::uint16_t part, std::vector<float>& out) const {
    const double weight = part_weight_[part];
    for (std::size_t m = 0; m < members_.size(); ++m)
      out.push_back(static_cast<float>(weight > 0 ? shares_[part][m] / weight : 1));
  }

  /// Nodes are a little darker than what is seen of them: their hidden parts lie in shadows. Some weight goes from the
  /// darkest to the brightest source, so that the row brings what its rays found, and its sum stays.
  void settle(std::span<Link> links) {
    if (links.size() < 2 || owed_ == 0) return;
    const auto [low, high] = std::minmax_element(links.begin(), links.end(), [&](const Link& a, const Link& b) {
      return nodes_->mean[a.source] < nodes_->mean[b.source];
    });
    const double apart = nodes_->mean[high->source] - nodes_->mean[low->source];
    if (!(apart > 0)) return;
    const double most = 0.5 * std::min(low->weight, high->weight);
    const auto moved = static_cast<float>(std::clamp(owed_ / apart, -most, most));
    high->weight -= moved, low->weight += moved;
  }

  /// Links for arrivals first .. last - 1, all under node v.
  void cut(std::uint32_t v, std::size_t first, std::size_t last, std::vector<Link>& out) {
    double weight = 0, light = 0;
    for (std::size_t k = first; k < last; ++k) {
      weight += arrivals_[k].weight;
      if (nodes_) light += arrivals_[k].weight * nodes_->mean[arrivals_[k].node];
    }
    bool uniform = tree_.is_leaf(v);
    if (!uniform && limit_ > 0 && weight * nodes_->deviation[v] <= limit_) {
      const double more = owed_ + weight * nodes_->mean[v] - light;
      uniform = std::abs(more) <= most_owed_;
      if (uniform) owed_ = more;
    }
    if (uniform) {
      out.push_back({v, static_cast<float>(weight)});
      return;
    }
    if (arrivals_[first].node == arrivals_[last - 1].node) {
      out.push_back({arrivals_[first].node, static_cast<float>(weight)});
      return;
    }
    for (std::uint32_t child = v + 1; first < last; child = tree_.end[child]) {
      if (arrivals_[first].node >= tree_.end[child]) continue;
      std::size_t next = first;
      while (next < last && arrivals_[next].node < tree_.end[child]) ++next;
      cut(child, first, next, out);
      first = next;
    }
  }

  const Illumination& light_;
  const ElementTree& tree_;
  const BundleNet& net_;
  const NodeLight* nodes_;
  const DirectLight& direct_;
  const LinkOptions& options_;
  const PatchSet& patches_;
  std::vector<Member> members_;
  std::vector<Ray> rays_;
  std::vector<Hit> hits_;
  std::vector<const Member*> from_;
  std::vector<Arrival> arrivals_;
  std::array<std::array<double, kMostMembers>, kParts> shares_{};  ///< by part of the sphere, sums
  std::array<double, kParts> part_weight_{};
  std::uint64_t key_ = 0;
  bool hands_down_ = false, pairs_ = false;
  double bright_ = 0, bright_seen_ = 0;  ///< what arrives of bright patches, after and before glass [1]
  double bright_hits_ = 0;               ///< share of the bundle that ended on them
  double area_ = 0, sky_mean_ = 0, limit_ = 0, owed_ = 0, most_owed_ = 0;
};

void find_spaces(Transport& transport, const PatchSet& patches, const ElementTree& tree,
                 std::span<const Receiver> receivers,
                 std::span<const std::array<std::uint32_t, kNeighbours>> neighbours) {
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
  transport.E_sky = Field(n, patches.channels);
  transport.arrives.resize(n), transport.escapes.resize(n);
  NodeLight nodes;
  if (B.size() == n) nodes = node_light(tree, B);
  const BundleNet net(options.bundle_rays, stream_key(options.seed, kBundle));
  const std::vector<Receiver> receivers = choose_receivers(tree, patches, options.cluster_diameter, kMostReceivers);
  std::array<std::uint32_t, kNeighbours> nobody;
  nobody.fill(PatchId::kNone);
  std::vector<std::array<std::uint32_t, kNeighbours>> neighbours(receivers.size(), nobody);
  transport.blocks.resize((receivers.size() + kReceiversInBlock - 1) / kReceiversInBlock);

  constexpr std::size_t kBatch = 64;  // blocks between reports
  std::atomic<bool> stopped = false;
  for (std::size_t begin = 0; begin < transport.blocks.size(); begin += kBatch) {
    monitor.report("links", static_cast<double>(begin) / static_cast<double>(transport.blocks.size()));
    parallel_for(std::min(kBatch, transport.blocks.size() - begin), 1, [&](std::size_t from, std::size_t to) {
      Tracer tracer(light, tree, net, B.size() == n ? &nodes : nullptr, direct, options);
      for (std::size_t b = begin + from; b < begin + to; ++b) {
        if (monitor.should_stop()) {
          stopped = true;
          return;
        }
        LinkBlock& block = transport.blocks[b];
        const std::size_t first = b * kReceiversInBlock, last = std::min(receivers.size(), first + kReceiversInBlock);
        block.first_leaf = receivers[first].first_leaf, block.leaf_end = receivers[last - 1].leaf_end;
        for (std::size_t r = first; r < last; ++r) tracer.add(receivers[r], block, transport, neighbours[r]);
        block.links.shrink_to_fit(), block.shares.shrink_to_fit();
      }
    });
    if (stopped) {
      transport.complete = false;
      return transport;
    }
  }
  const int pairs = light.sampler.has_bright_patches() ? options.bright_rays : 0;
  transport.rays = receivers.size() * static_cast<unsigned long long>(options.bundle_rays + pairs);
  find_spaces(transport, patches, tree, receivers, neighbours);
  return transport;
}

std::vector<BundleRay> trace_bundle(const Illumination& light, const ElementTree& tree, const Receiver& receiver,
                                    const LinkOptions& options) {
  const BundleNet net(options.bundle_rays, stream_key(options.seed, kBundle));
  const DirectLight none;
  return Tracer(light, tree, net, nullptr, none, options).bundle(receiver);
}

}  // namespace clerestory
