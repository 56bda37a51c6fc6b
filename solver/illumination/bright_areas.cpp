#include "solver/illumination/bright_areas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "solver/model/disjoint_sets.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

// By judgement, but for what a comment says was measured.
constexpr std::size_t kMostBrightAreas = 64;  ///< every point asks each of them what it may give
constexpr std::size_t kFewPlanes = 4;         ///< one glowing wall and what it lights best
constexpr double kDark = 1e-3;                ///< of the brightest patch: does not count as light
constexpr double kLeastFilled = 1.0 / 3;      ///< of the hull; emptier ones waste most of their rays
constexpr double kFull = 0.8;                 ///< of the brightest patch: has all of a spot's light
constexpr double kDim = 0.2;                  ///< of the brightest patch: no part of a spot
constexpr double kSameDirection = 1 - 1e-9;   ///< cosine: rounding of normals of one plane

struct Corner {
  std::uint32_t vertex, number;
  friend auto operator<=>(const Corner&, const Corner&) = default;
};

struct Flat {
  double x, y;
  friend auto operator<=>(const Flat&, const Flat&) = default;
};

/// Counter-clockwise, without straight corners. Source: Andrew, "Another efficient algorithm for convex hulls in two
/// dimensions", 1979.
std::vector<Flat> convex_hull(std::vector<Flat> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  const double size =
      points.empty() ? 0 : std::hypot(points.back().x - points.front().x, points.back().y - points.front().y);
  std::vector<Flat> hull;
  const auto run = [&](auto begin, auto end) {
    const std::size_t start = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= start + 2) {
        const Flat &a = hull[hull.size() - 2], &b = hull.back();
        if ((b.x - a.x) * (p->y - a.y) - (b.y - a.y) * (p->x - a.x) > 1e-9 * size * size) break;
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  run(points.begin(), points.end());
  run(points.rbegin(), points.rend());
  return hull;
}

/// Takes away what is dim around a spot that has most of the light: rays at its hull would mostly miss it.
void keep_spot(const PatchSet& patches, const Field& glow, std::vector<std::uint32_t>& group) {
  double brightest = 0, flux = 0, full_flux = 0;
  for (const std::uint32_t p : group) brightest = std::max(brightest, luminous_mean(glow[p]));
  for (const std::uint32_t p : group) {
    const double B = luminous_mean(glow[p]);
    flux += patches.area[p] * B;
    if (B >= kFull * brightest) full_flux += patches.area[p] * B;
  }
  if (full_flux > 0.5 * flux)
    std::erase_if(group, [&](std::uint32_t p) { return luminous_mean(glow[p]) < kDim * brightest; });
}

LightArea area_of(const PatchSet& patches, const std::vector<std::uint32_t>& group, const Field& glow) {
  LightArea bright_area;
  bright_area.normal = patches.normal[group[0]];
  const Frame frame(bright_area.normal);
  const Vec3 origin = patches.corner_positions(PatchId{std::size_t{group[0]}})[0];
  std::vector<Flat> points;
  double flux = 0, area = 0;
  for (const std::uint32_t p : group) {
    for (const Vec3& c : patches.corner_positions(PatchId{std::size_t{p}}))
      points.push_back({dot(c - origin, frame.t), dot(c - origin, frame.b)});
    flux += patches.area[p] * luminous_mean(glow[p]);
    area += patches.area[p];
  }
  const std::vector<Flat> hull = convex_hull(std::move(points));
  const auto lift = [&](const Flat& f) { return origin + frame.t * f.x + frame.b * f.y; };
  for (const Flat& f : hull) bright_area.corners.push_back(lift(f));
  for (std::size_t k = 2; k < hull.size(); ++k) {
    bright_area.triangles.push_back({lift(hull[0]), lift(hull[k - 1]), lift(hull[k])});
    const auto& t = bright_area.triangles.back();
    bright_area.area += length(cross(t[1] - t[0], t[2] - t[0])) / 2;
  }
  for (const Flat& f : hull) bright_area.centre += lift(f) / static_cast<double>(hull.size());
  for (const Flat& f : hull) bright_area.radius = std::max(bright_area.radius, length(lift(f) - bright_area.centre));
  bright_area.brightness = area > kLeastFilled * bright_area.area ? flux / (area * std::numbers::pi) : 0;
  return bright_area;
}

}  // namespace

std::vector<std::vector<std::uint32_t>> plane_groups(const PatchSet& patches, const std::vector<std::uint32_t>& of) {
  std::vector<Corner> corners;
  for (std::uint32_t k = 0; k < of.size(); ++k)
    for (const VertexId v : patches.corners[patches.triangle[of[k]]]) corners.push_back({v.value, k});
  std::sort(corners.begin(), corners.end());
  DisjointSets joined(of.size());
  for (std::size_t first = 0; first < corners.size();) {
    std::size_t last = first;
    for (; last < corners.size() && corners[last].vertex == corners[first].vertex; ++last)
      for (std::size_t k = first; k < last; ++k)
        if (dot(patches.normal[of[corners[k].number]], patches.normal[of[corners[last].number]]) > kSameDirection)
          joined.join(corners[k].number, corners[last].number);
    first = last;
  }
  std::vector<std::uint32_t> group_of(of.size(), BrightAreas::kNone);
  std::vector<std::vector<std::uint32_t>> groups;
  for (std::size_t k = 0; k < of.size(); ++k) {
    const std::size_t name = joined.find(k);
    if (group_of[name] == BrightAreas::kNone) {
      group_of[name] = static_cast<std::uint32_t>(groups.size());
      groups.emplace_back();
    }
    groups[group_of[name]].push_back(of[k]);
  }
  return groups;
}

BrightAreas find_bright_areas(const PatchSet& patches, const LightSampler& sampler) {
  const Field& glow = sampler.glow();
  std::vector<std::uint32_t> bright, glowing;
  double brightest = 0;
  BrightAreas bright_areas;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    brightest = std::max(brightest, luminous_mean(glow[i]));
    if (!sampler.is_bright(PatchId{std::size_t{i}})) continue;
    bright.push_back(i);
    bright_areas.all_flux += patches.area[i] * luminous_mean(glow[i]);
  }
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i)
    if (luminous_mean(glow[i]) > kDark * brightest) glowing.push_back(i);
  std::vector<std::vector<std::uint32_t>> groups = plane_groups(patches, glowing);
  if (groups.size() > kFewPlanes) groups = plane_groups(patches, bright);
  for (auto& group : groups) keep_spot(patches, glow, group);
  const auto flux = [&](const std::vector<std::uint32_t>& group) {
    return std::accumulate(group.begin(), group.end(), 0.0,
                           [&](double sum, std::uint32_t p) { return sum + patches.area[p] * luminous_mean(glow[p]); });
  };
  std::vector<std::pair<double, std::uint32_t>> by_flux;
  for (std::uint32_t g = 0; g < groups.size(); ++g) by_flux.emplace_back(-flux(groups[g]), g);
  std::sort(by_flux.begin(), by_flux.end());
  by_flux.resize(std::min(by_flux.size(), kMostBrightAreas));
  for (const auto& [darkness, g] : by_flux) {
    LightArea shape = area_of(patches, groups[g], glow);
    if (!(shape.brightness > 0)) continue;
    if (bright_areas.of_patch.empty()) bright_areas.of_patch.assign(patches.patch_count(), BrightAreas::kNone);
    double of_bright = 0;
    for (const std::uint32_t p : groups[g]) {
      bright_areas.of_patch[p] = static_cast<std::uint32_t>(bright_areas.shape.size());
      if (sampler.is_bright(PatchId{std::size_t{p}})) of_bright += patches.area[p] * luminous_mean(glow[p]);
    }
    bright_areas.flux.push_back(of_bright);
    bright_areas.shape.push_back(std::move(shape));
  }
  double dim_area = 0;
  for (std::uint32_t i = 0; i < patches.patch_count(); ++i) {
    const PatchId p{std::size_t{i}};
    if (sampler.is_bright(p) || bright_areas.of(p) != BrightAreas::kNone) continue;
    bright_areas.ambient += patches.area[i] * luminous_mean(glow[i]);
    dim_area += patches.area[i];
  }
  if (dim_area > 0) bright_areas.ambient /= dim_area;
  return bright_areas;
}

}  // namespace clerestory
