#include "solver/hierarchy/arrivals.h"

#include <algorithm>
#include <numbers>
#include <span>

#include "solver/hierarchy/sky_views.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/openings/openings.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/two_estimators.h"
#include "solver/visibility/echoes.h"
#include "solver/visibility/shadow_rays.h"

namespace clerestory {
namespace {

/// Sums over a bundle, by member, of what each gets of its rays.
struct BundleSums {
  std::array<double, kMostMembers> all{}, arrives{}, escapes{};
};

/// Whether direct light has looked for this ray's sky through an opening.
bool is_looked_for(const Surroundings& around, std::uint32_t patch, const Ray& ray, const Hit& hit) {
  const auto openings = around.direct.openings.of(patch);
  return !openings.empty() && first_way_out(around.light.problem.lights.openings, openings, ray.origin, ray.direction,
                                            hit.first) != kNoOpening;
}

/// Fills one receiver's arrivals.
class Collector {
 public:
  Collector(const ReceiverArea& area, const Surroundings& around, int rays, int pairs, Arrivals& out)
      : area_(area), around_(around), R_(rays), L_(pairs), out_(out), slits_(around.slits.slits_over(area)) {}

  void take_bundle(const Bundle& bundle, std::uint64_t key) {
    const std::size_t n = area_.members().size();
    std::array<double, kMostMembers> share{1.0};  // a single member gets all
    BundleSums sums;
    for (std::size_t k = 0; k < bundle.rays.size(); ++k) {
      const Ray& ray = bundle.rays[k];
      const Hit& hit = bundle.hits[k];
      const auto shares = std::span(share).first(n);
      if (n > 1) area_.find_shares(ray.direction, shares);
      if (hit.escaped())
        take_escape(ray, hit, false, shares, sums);
      else if (hit.patch.valid() && !comes_by_slit(ray.origin, ray.direction, hit.first))
        take_patch(ray, hit, bundle.from[k]->normal, shares, sums);
      for (std::size_t m = 0; m < n; ++m) sums.all[m] += shares[m];
      if (bundle.echoes.empty()) continue;
      const Problem& problem = around_.light.problem;
      follow_echo(problem.rays, problem.patches, bundle.echoes[k], key, k, [&](const Hit& echo) {
        if (echo.escaped())
          take_escape(ray, echo, true, shares, sums);
        else if (echo.patch.valid())
          take_patch(ray, echo, bundle.from[k]->normal, shares, sums);
      });
    }
    note_view(sums);
  }

  void take_pairs(std::uint64_t key) {
    const RayScene& rays = around_.light.problem.rays;
    struct Load {
      PatchId source;
      double weight;
      Vec3 direction;
    };
    auto shadows = shadow_rays<Load>(rays, [&](const Load& load, const Spectrum& passes) {
      add(load.source, load.weight, luminous_mean(passes), true, load.direction);
    });
    for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(L_); ++k) {
      const BrightPair pair = bright_pair(area_, around_.light, k, key);
      if (!pair.valid()) continue;
      const Vec3 direction = normalized(pair.to - pair.from);
      if (comes_by_slit(pair.from, direction, length(pair.to - pair.from))) continue;
      const double c = std::max(0.0, dot(pair.normal, direction)) / std::numbers::pi;
      const double weight = c * power_heuristic_over_density(L_ * pair.sample.density, R_ * c);
      if (weight > 0) shadows.send(pair.from, pair.to, {pair.sample.patch, weight, direction});
    }
    shadows.trace();
  }

  void take_slits() {
    if (slits_.empty()) return;
    for (const ReceiverArea::Member& m : area_.members())
      for (const SlitLine& line : around_.slits.at(m.patch))
        if (slit_on_the_way(line.place, line.direction, line.distance) == line.slit)
          out_.list.push_back({around_.tree.node_of_patch[line.source], static_cast<float>(line.weight / area_.area()),
                               std::uint16_t{0}, false});
  }

 private:
  std::uint32_t slit_on_the_way(const Vec3& from, const Vec3& direction, double distance) const {
    if (slits_.empty()) return kNoOpening;
    return first_way_out(around_.light.problem.lights.openings, slits_, from, direction, distance);
  }
  bool comes_by_slit(const Vec3& from, const Vec3& direction, double distance) const {
    return slit_on_the_way(from, direction, distance) != kNoOpening;
  }

  /// is_echo: glass turned it back, and direct light has not looked for it.
  void take_escape(const Ray& ray, const Hit& hit, bool is_echo, std::span<const double> share, BundleSums& sums) {
    const double passes = luminous_mean(hit.transmittance);
    for (std::size_t m = 0; m < share.size(); ++m) sums.escapes[m] += share[m] * passes;
    if (!around_.keeps_sky_views || hit.transmittance.is_black()) return;
    std::uint32_t looking = 0;
    for (std::size_t m = 0; m < share.size(); ++m)
      if (is_echo || !is_looked_for(around_, area_.members()[m].patch, ray, hit)) looking |= 1u << m;
    if (looking == 0) return;
    out_.views.push_back(pack_sky_view(hit.direction(ray), hit.transmittance));
    if (area_.hands_down()) out_.shared_views.push_back({pack_direction(ray.direction), looking});
    if (!around_.sums_sky) return;
    const double E = std::numbers::pi * luminous_mean(around_.light.sky(hit.direction(ray)) * hit.transmittance);
    for (std::size_t m = 0; m < share.size(); ++m)
      if ((looking >> m & 1) != 0) out_.E_sky += area_.members()[m].area / area_.area() * share[m] * E / R_;
  }

  void take_patch(const Ray& ray, const Hit& hit, const Vec3& normal, std::span<const double> share, BundleSums& sums) {
    const LightSampler& sampler = around_.light.sampler;
    const double passes = luminous_mean(hit.transmittance);
    if (L_ > 0 && !hit.reflected && sampler.is_bright(hit.patch)) {
      const double c = dot(normal, ray.direction) / std::numbers::pi;
      const double density = sampler.density(hit, ray.origin, normal, ray.direction, true);
      out_.bright.hits += 1.0 / R_;
      add(hit.patch, c * power_heuristic_over_density(R_ * c, L_ * density), passes, true, ray.direction);
    } else {
      add(hit.patch, 1.0 / R_, passes, false, ray.direction);
      for (std::size_t m = 0; m < share.size(); ++m) sums.arrives[m] += share[m] * passes;
    }
  }

  /// weight  before glass, which lets the share `passes` through.
  void add(PatchId source, double weight, double passes, bool bright, const Vec3& d) {
    if (bright) out_.bright.seen += weight, out_.bright.arrives += weight * passes;
    weight *= passes;
    const std::uint16_t part = area_.hands_down() ? part_of_sphere(d) : std::uint16_t{0};
    out_.list.push_back({around_.tree.node_of_patch[source], static_cast<float>(weight), part, bright});
    if (!area_.hands_down()) return;
    std::array<double, kMostMembers> share;
    const auto shares = std::span(share).first(area_.members().size());
    area_.find_shares(d, shares);
    out_.shares.add(part, weight, shares);
  }

  void note_view(const BundleSums& sums) {
    const auto part = [](double sum, double all) { return static_cast<float>(all > 0 ? sum / all : 0); };
    for (std::size_t m = 0; m < area_.members().size(); ++m)
      out_.view[m] = {part(sums.arrives[m], sums.all[m]), part(sums.escapes[m], sums.all[m])};
  }

  const ReceiverArea& area_;
  const Surroundings& around_;
  const int R_, L_;
  Arrivals& out_;
  const std::vector<std::uint32_t> slits_;  ///< whose light comes by lines
};

void clear(Arrivals& arrivals, bool hands_down) {
  arrivals.list.clear();
  arrivals.bright = {};
  arrivals.views.clear(), arrivals.shared_views.clear();
  arrivals.E_sky = 0;
  if (hands_down) arrivals.shares.clear();
}

/// All directions but slits sum to 1. What the bright sources leave, by their better estimate, is shared by the rest of
/// the bundle: other patches, what escapes, what is lost.
void make_sum_one(std::size_t members, int rays, Arrivals& arrivals) {
  const BrightShares& bright = arrivals.bright;
  const bool rest = bright.hits < 1 && bright.seen < 1;
  const double gain = rest ? (1 - bright.seen) / (1 - bright.hits) : 0;
  const double gain_bright = rest ? 1 : 1 / bright.seen;
  for (Arrival& a : arrivals.list) a.weight = static_cast<float>(a.weight * (a.bright ? gain_bright : gain));
  for (MemberView& v : std::span(arrivals.view).first(members)) {
    v.escapes = static_cast<float>(v.escapes * gain);
    v.arrives = static_cast<float>(v.arrives * gain + bright.arrives * gain_bright);
  }
  arrivals.view_weight = static_cast<float>(gain / rays);
  arrivals.E_sky *= gain;
}

}  // namespace

void find_arrivals(const ReceiverArea& area, const Bundle& bundle, const Surroundings& around, int pairs,
                   std::uint64_t key, Arrivals& out) {
  clear(out, area.hands_down());
  Collector collector(area, around, static_cast<int>(bundle.rays.size()), pairs, out);
  collector.take_bundle(bundle, key);
  if (pairs > 0) collector.take_pairs(mix_bits(key + kBrightPairs));
  make_sum_one(area.members().size(), static_cast<int>(bundle.rays.size()), out);
  collector.take_slits();
}

}  // namespace clerestory
