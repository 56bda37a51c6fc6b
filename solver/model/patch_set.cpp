#include "solver/model/patch_set.h"

#include <numeric>

#include "solver/model/assert.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

bool side_reflects_and_emits(const PatchSet& p, PatchId i) {
  const TriangleId t = p.triangle[i];
  return p.side[i] == kFront || p.materials[p.material(i)].sides == 2 || (!p.joined.empty() && p.joined[t]);
}

/// tau, and what lies behind the patches of diffusers.
void join_diffuser_sides(PatchSet& p) {
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    if (!p.front_material(p.triangle[i]).scatters_through()) continue;
    if (p.tau.value.empty()) p.tau = Field(p.patch_count(), p.channels);
    p.tau.set(i, p.materials[p.material(PatchId{i})].transmittance);
  }
  if (p.tau.value.empty()) return;
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    p.behind_begin.push_back(static_cast<std::uint32_t>(p.behind.size()));
    if (p.front_material(p.triangle[i]).scatters_through())
      p.behind.push_back({p.side_patch[p.triangle[i]][1 - p.side[i]], 1});
  }
  p.behind_begin.push_back(static_cast<std::uint32_t>(p.behind.size()));
}

}  // namespace

std::array<Vec3, 3> PatchSet::corner_positions(PatchId p) const {
  const auto& c = corners[triangle[p]];
  if (side[p] == kFront) return {vertices[c[0]], vertices[c[1]], vertices[c[2]]};
  return {vertices[c[0]], vertices[c[2]], vertices[c[1]]};
}

PatchId PatchSet::patch_at(TriangleId t, Side s, double u, double v) const {
  const PatchId root = side_patch[t][s];
  if (splits.empty() || !root.valid()) return root;
  // Corners of a patch run counter-clockwise seen from its side.
  std::array<double, 3> weight = {1 - u - v, s == kFront ? u : v, s == kFront ? v : u};
  std::uint32_t node = root.value;
  while (splits[node].first_part != SplitNode::kNone) {
    const bool second = go_to_part(splits[node].at, splits[node].edge, weight);
    node = splits[node].first_part + second;
  }
  return PatchId{std::size_t{splits[node].patch}};
}

PatchSet::Scattering PatchSet::scatter(PatchId p, double pick) const {
  if (tau.value.empty()) return {normal[p], rho[p]};
  const double through = luminous_mean(tau[p]), back = luminous_mean(rho[p]);
  const double passes = through > 0 ? through / (through + back) : 0;
  if (pick < passes) return {-normal[p], tau[p] / passes};
  return {normal[p], rho[p] / (1 - passes)};
}

double PatchSet::total_area() const { return std::accumulate(area.begin(), area.end(), 0.0); }

double total_flux(const PatchSet& patches, const Field& x) {
  double sum = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) sum += patches.area[i] * luminous_mean(x[i]);
  return sum;
}

void make_patches(PatchSet& patches, const std::vector<bool>& wanted) {
  PatchSet& p = patches;
  CLERESTORY_ASSERT(wanted.size(), ==, 2 * p.triangle_count());
  p.triangle.clear();
  p.side.clear();
  p.area.clear();
  p.normal.clear();
  p.level.clear();
  p.space.clear();
  p.room.clear();
  p.tau = Field();
  p.behind_begin.clear();
  p.behind.clear();
  p.side_patch.assign(p.triangle_count(), {PatchId{}, PatchId{}});
  for (std::size_t t = 0; t < p.triangle_count(); ++t) {
    if (!p.front_material(TriangleId{t}).receives()) continue;
    const auto& c = p.corners[t];
    const Vec3 a = p.vertices[c[0]];
    const Vec3 scaled_normal = cross(p.vertices[c[1]] - a, p.vertices[c[2]] - a);
    const double area = length(scaled_normal) / 2;
    if (!(area > 0)) continue;
    const bool both = p.front_material(TriangleId{t}).scatters_through() && (wanted[2 * t] || wanted[2 * t + 1]);
    for (const Side side : {kFront, kBack}) {
      if (!wanted[2 * t + side] && !both) continue;
      p.side_patch[t][side] = PatchId{p.triangle.size()};
      p.triangle.push_back(TriangleId{t});
      p.side.push_back(side);
      p.area.push_back(area);
      p.normal.push_back(normalized(scaled_normal) * (side == kFront ? 1.0 : -1.0));
    }
  }

  std::vector<double> emitting_area(p.materials.size(), 0.0);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    const MaterialId m = p.material(PatchId{i});
    if (side_reflects_and_emits(p, PatchId{i})) emitting_area[m] += p.area[i];
  }
  p.rho = Field(p.patch_count(), p.channels);
  p.M = Field(p.patch_count(), p.channels);
  for (std::size_t i = 0; i < p.patch_count(); ++i) {
    const MaterialId m = p.material(PatchId{i});
    const Material& material = p.materials[m];
    if (!side_reflects_and_emits(p, PatchId{i})) continue;
    p.rho.set(i, material.reflectance);
    p.M.set(i, material.total_power ? *material.total_power / emitting_area[m] : material.exitance);
  }
  join_diffuser_sides(p);
}

}  // namespace clerestory
