#include "solver/form_factors/surface_form_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/form_factors/sampled.h"
#include "solver/form_factors/shaft.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

/// Sums over the pairs of triangles of one pair of groups.
struct PairSum {
  double exchange = 0;    ///< sum A_p F_pq V_pq [m2]
  double unoccluded = 0;  ///< sum A_p F_pq [m2]
  double variance = 0;    ///< of exchange [m4]

  void operator+=(const PairSum& b) { exchange += b.exchange, unoccluded += b.unoccluded, variance += b.variance; }
};

std::size_t planes_of_object(const PatchSet& patches, std::size_t i, std::vector<std::size_t>& first_of_plane) {
  const PatchId p{i};
  const Vec3 at = patches.corner_positions(p)[0];
  for (std::size_t k = 0; k < first_of_plane.size(); ++k) {
    const PatchId other{first_of_plane[k]};
    const Vec3 n = patches.normal[other], away = at - patches.corner_positions(other)[0];
    if (dot(n, patches.normal[i]) > 1 - 1e-10 &&
        std::abs(dot(n, away)) <= 1e-6 * (length(away) + std::sqrt(patches.area[i])))
      return k;
  }
  first_of_plane.push_back(i);
  return first_of_plane.size() - 1;
}

}  // namespace

PatchGroups group_patches(const PatchSet& patches, GroupBy by) {
  const std::size_t n = patches.patch_count();
  PatchGroups groups;
  groups.group.resize(n);
  if (by == GroupBy::patch) {
    for (std::size_t i = 0; i < n; ++i) {
      groups.name.push_back(std::to_string(i));
      groups.group[i] = static_cast<std::uint32_t>(i);
    }
    return groups;
  }
  // Plane within object counts for GroupBy::surface only. The map is ordered like the model.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> members;
  std::map<std::size_t, std::vector<std::size_t>> planes;
  for (std::size_t i = 0; i < n; ++i) {
    const PatchId p{i};
    const std::size_t whole = by == GroupBy::material ? patches.material(p).value : patches.surface(p).value;
    const std::size_t part = by == GroupBy::surface ? planes_of_object(patches, i, planes[whole]) : 0;
    members[{whole, part}].push_back(i);
  }
  for (const auto& [key, patch_numbers] : members) {
    const auto& [whole, part] = key;
    std::string name = by == GroupBy::material ? patches.materials[whole].name : patches.surfaces[whole];
    if (by == GroupBy::surface && planes[whole].size() > 1) name += "/" + std::to_string(part + 1);
    for (const std::size_t i : patch_numbers) groups.group[i] = static_cast<std::uint32_t>(groups.name.size());
    groups.name.push_back(std::move(name));
  }
  return groups;
}

SurfaceFactors surface_form_factors(const PatchSet& patches, const RayScene& rays, const PatchGroups& groups,
                                    const SurfaceFactorOptions& options, const Monitor& monitor) {
  const std::size_t n = patches.patch_count(), count = groups.name.size();
  const Blockers blockers(patches);
  SurfaceFactors result;

  // One task a patch, with a row of sums over the groups it sends to; patches of a group are added up in order.
  struct PatchRow {
    std::vector<PairSum> to;
    std::size_t unblocked = 0, sampled = 0;
    unsigned long long rays = 0;
  };
  std::vector<double> area(count, 0.0);
  for (std::size_t i = 0; i < n; ++i) area[groups.group[i]] += patches.area[i];
  std::vector<PairSum> sums(count * count);

  const auto patch_row = [&](std::size_t i) {
    PatchRow row{std::vector<PairSum>(count)};
    const auto p = patches.corner_positions(PatchId{i});
    const Box box = Box::around(p);
    std::vector<const Blocker*> in_shaft;
    std::vector<const Screen*> screens;
    for (std::size_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const auto q = patches.corner_positions(PatchId{j});
      PairSum pair;
      pair.unoccluded = exchange_area(p, q);
      if (pair.unoccluded == 0) continue;
      const Box other = Box::around(q);
      blockers.in_shaft(box, other, in_shaft);
      const PairShaft shaft(p, patches.normal[i], q, patches.normal[j], blockers.touching());
      const bool blocked = std::ranges::any_of(in_shaft, [&](const Blocker* b) { return shaft.reached_by(*b); });
      if (!blocked) {
        ++row.unblocked;
        pair.exchange = pair.unoccluded;
      } else {
        blockers.screens_in_shaft(box, other, screens);
        const bool hidden =
            std::ranges::any_of(screens, [&](const Screen* s) { return s->hides(p, q, blockers.touching()); });
        if (!hidden) {
          ++row.sampled;
          const SampledVisibility V = sample_visibility({p, patches.normal[i]}, {q, patches.normal[j]}, rays,
                                                        stream_key(options.seed, i, j), options.samples);
          pair.exchange = pair.unoccluded * V.value;
          pair.variance = std::pow(pair.unoccluded * V.std_error, 2);
          row.rays += static_cast<unsigned long long>(V.rays);
        }
      }
      row.to[groups.group[j]] += pair;
    }
    return row;
  };

  // A slice of patches at a time: their rows would not fit in memory all at once when each patch is a group.
  constexpr std::size_t kSlice = 64;
  std::vector<PatchRow> slice(kSlice);
  for (std::size_t first = 0; first < n && result.complete; first += kSlice) {
    if (monitor.should_stop()) result.complete = false;
    monitor.report("form factors", static_cast<double>(first) / static_cast<double>(n));
    const std::size_t here = std::min(kSlice, n - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) slice[k] = patch_row(first + k);
    });
    for (std::size_t k = 0; k < here; ++k) {
      for (std::size_t g = 0; g < count; ++g) sums[groups.group[first + k] * count + g] += slice[k].to[g];
      result.pairs_unblocked += slice[k].unblocked, result.pairs_sampled += slice[k].sampled;
      result.rays += slice[k].rays;
    }
  }

  result.row_sum.assign(count, 0.0);
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b) {
      const PairSum& sum = sums[a * count + b];
      SurfaceFactor factor{.from = static_cast<std::uint32_t>(a), .to = static_cast<std::uint32_t>(b)};
      if (area[a] > 0) {
        factor.F = sum.exchange / area[a];
        factor.std_error = std::sqrt(sum.variance) / area[a];
      }
      factor.visibility = sum.unoccluded > 0 ? sum.exchange / sum.unoccluded : 1;
      result.row_sum[a] += factor.F;
      const double back = sums[b * count + a].exchange;
      if (sum.exchange + back > 0)
        result.reciprocity_error =
            std::max(result.reciprocity_error, std::abs(sum.exchange - back) / (sum.exchange + back));
      result.rows.push_back(factor);
    }
  return result;
}

}  // namespace clerestory
