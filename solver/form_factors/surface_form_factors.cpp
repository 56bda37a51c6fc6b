#include "solver/form_factors/surface_form_factors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "solver/form_factors/factors_of_group.h"
#include "solver/form_factors/shaft.h"

namespace clerestory {
namespace {

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
  std::vector<double> area(count, 0.0);
  std::vector<std::vector<std::uint32_t>> members(count);
  for (std::size_t i = 0; i < n; ++i) {
    area[groups.group[i]] += patches.area[i];
    members[groups.group[i]].push_back(static_cast<std::uint32_t>(i));
  }

  std::vector<PairSum> sums(count * count);
  std::size_t done = 0;
  for (std::size_t a = 0; a < count && result.complete; ++a) {
    const std::span<PairSum> row = std::span(sums).subspan(a * count, count);
    FactorsOfGroup from(patches, rays, blockers, groups, options);
    result.complete = from.find(members[a], row, [&](double share) {
      monitor.report("form factors", (static_cast<double>(done) + share * static_cast<double>(members[a].size())) /
                                         static_cast<double>(n));
      return !monitor.should_stop();
    });
    done += members[a].size();
    result.pairs_unblocked += from.pairs_unblocked, result.pairs_sampled += from.pairs_sampled;
    result.rays += from.rays_cast;
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
