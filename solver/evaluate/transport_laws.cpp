#include "solver/evaluate/transport_laws.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "solver/hierarchy/gather_links.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kStdErrors = 5;  // one in two million by chance
constexpr const char* kByStake = "links by flux at stake are good for that flux, and not for every form factor";
constexpr const char* kNoTime = "there was no time";
constexpr double kFloatError = 1e-6;  // values, areas and scales, each rounded to float once

/// Patches of one surface in one room.
struct Surfaces {
  std::vector<std::uint32_t> of_patch;  ///< N
  std::vector<std::size_t> room;        ///< by surface
  std::vector<double> area, area2;      ///< by surface: sum A, sum A^2

  explicit Surfaces(const PatchSet& patches) : of_patch(patches.patch_count()) {
    std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> number;
    for (std::size_t i = 0; i < of_patch.size(); ++i) {
      const std::size_t in = patches.room_of(i);
      const auto [at, is_new] =
          number.try_emplace({in, patches.surface(PatchId{i}).value}, static_cast<std::uint32_t>(room.size()));
      if (is_new) room.push_back(in), area.push_back(0), area2.push_back(0);
      of_patch[i] = at->second;
      area[at->second] += patches.area[i];
      area2[at->second] += patches.area[i] * patches.area[i];
    }
  }
  /// Of a patch as rays see it: the area of the patch that a place of the surface is on, on the mean.
  double typical_area(std::uint32_t g) const { return area[g] > 0 ? area2[g] / area[g] : 0; }
};

/// Variance of a share found by so many rays, which is never known to be nothing. A ray that ends on gloss goes on: it
/// may count more than once, and shares sum to more than 1.
double variance_of_share(double share, int rays, bool has_gloss) {
  if (has_gloss) return std::max(share, 1.0 / rays) * (1 + share) / rays;
  const double n = rays, smoothed = (std::clamp(share, 0.0, 1.0) * n + 1) / (n + 2);
  return smoothed * (1 - smoothed) / n;
}

struct Exchange {
  double area = 0;      ///< sum A_p F_pq [m2]
  double variance = 0;  ///< [m4]
};

/// What arrives over links, from surface to surface, by receiver and sender.
struct Exchanges {
  std::unordered_map<std::uint64_t, Exchange> of_pair;
  std::vector<double> mixed;  ///< by receiver, over nodes of more than one surface [m2]

  static std::uint64_t key(std::uint32_t to, std::uint32_t from) { return std::uint64_t{to} << 32 | from; }
  Exchange at(std::uint32_t to, std::uint32_t from) const {
    const auto found = of_pair.find(key(to, from));
    return found == of_pair.end() ? Exchange{} : found->second;
  }
};

constexpr std::uint32_t kMixed = 0xffffffff;

/// By node the surface that all of its leaves are of, or kMixed.
std::vector<std::uint32_t> surface_of_nodes(const ElementTree& tree, const Surfaces& surfaces) {
  const std::size_t n = tree.leaf_count();
  std::vector<std::uint32_t> end_of_run(n), of_node(tree.size());
  for (std::size_t l = n; l-- > 0;) {
    const bool goes_on = l + 1 < n && surfaces.of_patch[tree.patch[l]] == surfaces.of_patch[tree.patch[l + 1]];
    end_of_run[l] = goes_on ? end_of_run[l + 1] : static_cast<std::uint32_t>(l + 1);
  }
  for (std::uint32_t v = 0; v < tree.size(); ++v) {
    const std::uint32_t first = tree.first_leaf(v);
    const bool alike = first < n && end_of_run[first] >= tree.leaf_end(v);
    of_node[v] = alike ? surfaces.of_patch[tree.patch[first]] : kMixed;
  }
  return of_node;
}

/// Less than all when the monitor stops it.
Exchanges add_up_links(const PatchSet& leaves, const ElementTree& tree, const Transport& transport,
                       const Surfaces& surfaces, const Monitor& monitor) {
  const std::vector<std::uint32_t> of_node = surface_of_nodes(tree, surfaces);
  Exchanges sums{{}, std::vector<double>(surfaces.room.size(), 0.0)};
  std::map<std::uint32_t, double> arrives;  // of one row, by sender
  std::map<std::uint64_t, double> of_receiver;
  for (const LinkBlock& block : transport.blocks) {
    if (monitor.should_stop()) break;
    std::size_t link = 0, row = 0;
    const float* share = block.shares.data();
    for (const Receiver& r : block.receivers) {
      of_receiver.clear();
      double area = 0;
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) area += leaves.area[tree.patch[l]];
      for (std::uint32_t k = 0; k < r.rows; ++k, ++row) {
        arrives.clear();
        for (; link < block.row_end[row]; ++link)
          arrives[of_node[block.links[link].source]] += double{block.links[link].weight};
        for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
          const std::uint32_t p = tree.patch[l], to = surfaces.of_patch[p];
          const double part = leaves.area[p] * (r.hands_down ? double{*share++} : 1.0);
          for (const auto& [from, weight] : arrives) {
            if (from == kMixed)
              sums.mixed[to] += part * weight;
            else
              of_receiver[Exchanges::key(to, from)] += part * weight;
          }
        }
      }
      // A receiver's rays are shared by its leaves.
      for (const auto& [pair, x] : of_receiver) {
        Exchange& sum = sums.of_pair[pair];
        sum.area += x;
        if (area > 0) {
          const double F = std::clamp(x / area, 0.0, 1.0);
          sum.variance += area * area * F * (1 - F) / transport.bundle_rays;
        }
      }
    }
  }
  return sums;
}

LawCheck reciprocity(std::vector<LawInRoom> rooms) {
  const char* const why = rooms.empty() ? "no two surfaces of the model see each other" : "";
  return {Law::reciprocity, std::move(rooms), why};
}

}  // namespace

LawCheck reciprocity_of_matrix(const PatchSet& patches, const FormFactorMatrix& F, const Monitor& monitor) {
  WorstInRooms worst(patches.rooms);
  for (std::size_t i = 0; i < F.n; ++i) {
    if (monitor.should_stop()) return {Law::reciprocity, {}, kNoTime};
    double off = 0;
    for (std::size_t j = 0; j < i; ++j) {
      const double there = patches.area[i] * double{F.at(i, j)}, back = patches.area[j] * double{F.at(j, i)};
      const double most = std::max(there, back), difference = std::abs(there - back);
      if (difference > off * most || !std::isfinite(difference)) off = difference / most;
    }
    worst.see(patches.room_of(i), off, kFloatError);
  }
  return reciprocity(worst.rooms());
}

LawCheck reciprocity_of_links(const PatchSet& leaves, const ElementTree& tree, const Transport& transport,
                              const Monitor& monitor) {
  if (transport.bundle_rays == 0) return {Law::reciprocity, {}, kByStake};
  const Surfaces surfaces(leaves);
  const Exchanges sums = add_up_links(leaves, tree, transport, surfaces, monitor);
  if (monitor.should_stop()) return {Law::reciprocity, {}, kNoTime};
  WorstInRooms worst(leaves.rooms);
  for (const auto& [pair, there] : sums.of_pair) {
    const auto g = static_cast<std::uint32_t>(pair >> 32), h = static_cast<std::uint32_t>(pair);
    const Exchange back = sums.at(h, g);
    if (g < h && back.area > 0) continue;  // seen the other way round
    const double area = std::min(surfaces.area[g], surfaces.area[h]);
    if (g == h || !(area > 0)) continue;
    // Where few rays are expected the rays of the other direction tell how many.
    const auto variance = [&](const Exchange& x, std::uint32_t of, const Exchange& other) {
      return std::max(x.variance, other.area * surfaces.typical_area(of) / transport.bundle_rays);
    };
    const double std_error = std::sqrt(variance(there, g, back) + variance(back, h, there));
    const double bound = kStdErrors * std_error + std::min(sums.mixed[g] + sums.mixed[h], area);
    worst.see(surfaces.room[g], std::abs(there.area - back.area) / area, bound / area);
  }
  return reciprocity(worst.rooms());
}

LawCheck row_sums_of_matrix(const PatchSet& patches, const FormFactorMatrix& F, const Closure& closure, int rays) {
  WorstInRooms worst(patches.rooms);
  const Surfaces surfaces(patches);
  std::vector<double> off(surfaces.room.size()), variance(off.size()), own(off.size());
  for (std::size_t i = 0; i < F.n; ++i) {
    const double arrives = luminous_mean(closure.arrives[i]), difference = F.row_sum[i] * F.row_gain(i) - arrives;
    if (F.closed[i] && arrives > 1 - 1e-9) {
      worst.see(patches.room_of(i), std::abs(difference), kFloatError);
      continue;
    }
    const double error2 = variance_of_share(arrives, rays, closure.has_gloss), A = patches.area[i];
    const std::uint32_t g = surfaces.of_patch[i];
    if (!closure.has_gloss)  // else rays from one patch tell too little, and surfaces tell all
      worst.see(patches.room_of(i), std::abs(difference), kStdErrors * (std::sqrt(error2) + F.row_error[i]));
    off[g] += A * difference, variance[g] += A * A * error2, own[g] += A * F.row_error[i];
  }
  for (std::size_t g = 0; g < off.size(); ++g)
    if (variance[g] > 0)
      worst.see(surfaces.room[g], std::abs(off[g]) / surfaces.area[g],
                (kStdErrors * std::sqrt(variance[g]) + own[g]) / surfaces.area[g]);
  return {Law::row_sums, worst.rooms(), {}};
}

LawCheck row_sums_of_links(const PatchSet& leaves, const ElementTree& tree, const Transport& transport,
                           const Closure& closure, int rays) {
  if (transport.bundle_rays == 0) return {Law::row_sums, {}, kByStake};
  Field ones(leaves.patch_count(), 1), nodes, sum(leaves.patch_count(), 1);
  std::ranges::fill(ones.value, 1.0);
  pull(tree, ones, nodes);
  gather_and_push(transport, tree, nodes, sum);
  const Surfaces surfaces(leaves);
  std::vector<double> off(surfaces.room.size()), variance(off.size());
  for (std::size_t i = 0; i < leaves.patch_count(); ++i) {
    const double arrives = luminous_mean(closure.arrives[i]), A = leaves.area[i];
    const std::uint32_t g = surfaces.of_patch[i];
    off[g] += A * (sum.at(i, 0) - arrives);
    variance[g] += A * A * variance_of_share(arrives, rays, closure.has_gloss);
  }
  // A receiver's rays are shared by its leaves.
  std::map<std::uint32_t, std::pair<double, double>> of_receiver;  // by surface: area, what arrives
  for (const LinkBlock& block : transport.blocks)
    for (const Receiver& r : block.receivers) {
      of_receiver.clear();
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
        const std::uint32_t p = tree.patch[l];
        auto& [area, arrives] = of_receiver[surfaces.of_patch[p]];
        area += leaves.area[p], arrives += leaves.area[p] * sum.at(p, 0);
      }
      for (const auto& [g, of] : of_receiver)
        if (of.first > 0)
          variance[g] +=
              of.first * of.first * variance_of_share(of.second / of.first, transport.bundle_rays, closure.has_gloss);
    }
  WorstInRooms worst(leaves.rooms);
  for (std::size_t g = 0; g < off.size(); ++g)
    worst.see(surfaces.room[g], std::abs(off[g]) / surfaces.area[g],
              kStdErrors * std::sqrt(variance[g]) / surfaces.area[g]);
  return {Law::row_sums, worst.rooms(), {}};
}

}  // namespace clerestory
