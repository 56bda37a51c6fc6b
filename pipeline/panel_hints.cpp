#include "pipeline/panel_hints.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "pipeline/wording.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::uint32_t kRays = 256;
constexpr double kRightBehind = 0.1;  ///< what a panel may be mounted on [m]
constexpr double kClose = 0.05;       ///< of a side that hardly lights anything [m]

/// What rays from one side of a material's triangles meet, as shares of them.
struct Sight {
  double room = 0;   ///< fronts farther away than kRightBehind
  double close = 0;  ///< another material within kClose of the panel's plane
  double gap = 0;    ///< median distance to that, across the plane [m]
  MaterialId what;   ///< most of it
};

/// One side of a triangle, and the way back.
struct TriangleSide {
  TriangleId triangle;
  Side side;
  TriangleSide other() const { return {triangle, side == kFront ? kBack : kFront}; }
};

/// Sides of a material that shine: fronts, and backs that are fronts of a joined face. Of a two-sided material the
/// fronts of what has it on both sides.
std::vector<TriangleSide> lit_sides_of(const PatchSet& patches, MaterialId m) {
  const bool one_sided = patches.materials[m].sides == 1;
  std::vector<TriangleSide> all;
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    const bool front = patches.side_material[t][kFront].value == m.value;
    const bool back = patches.side_material[t][kBack].value == m.value;
    const bool joined = !patches.joined.empty() && patches.joined[t];
    if (one_sided ? front : front && back && !joined) all.push_back({TriangleId{t}, kFront});
    if (one_sided && back && joined) all.push_back({TriangleId{t}, kBack});
  }
  return all;
}

/// Rays from those sides, or from behind them.
Sight look(const Problem& problem, MaterialId m, const std::vector<TriangleSide>& sides,
           const std::vector<double>& area_up_to, bool from_behind) {
  const PatchSet& patches = problem.patches;
  Sight sight;
  std::vector<double> gaps;
  std::map<std::uint32_t, int> seen;
  const std::uint64_t key = stream_key(m, kPanelRays, from_behind);
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, key);
    const double at = (k + 0.5) / kRays * area_up_to.back();
    const auto place = std::upper_bound(area_up_to.begin(), area_up_to.end(), at) - area_up_to.begin();
    const TriangleSide lit = sides[static_cast<std::size_t>(place)], from = from_behind ? lit.other() : lit;
    const auto& corner = patches.corners[from.triangle];
    const Vec3 a = patches.vertices[corner[0]], b = patches.vertices[corner[1]], c = patches.vertices[corner[2]];
    const Vec3 n = normalized(cross(b - a, c - a)) * (from.side == kFront ? 1.0 : -1.0);
    const Vec3 p = point_on_triangle({a, b, c}, u[2], u[3]) + n * problem.rays.lift();
    const Ray ray{p, cosine_direction(Frame(n), u[0], u[1])};
    const Hit hit = problem.rays.first_hit(patches, ray);
    if (hit.escaped()) continue;
    const auto& met = patches.corners[hit.triangle];
    const Vec3 q = patches.vertices[met[0]];
    const Vec3 normal = cross(patches.vertices[met[1]] - q, patches.vertices[met[2]] - q);
    const Side side = dot(normal, hit.direction(ray)) < 0 ? kFront : kBack;
    const double across = dot(hit.position(ray) - p, n);
    const MaterialId material = patches.side_material[hit.triangle][side];
    sight.room += (side == kFront && double{hit.distance} > kRightBehind) / double{kRays};
    if (!hit.reflected && across < kClose && material.value != m.value) {
      sight.close += 1.0 / kRays;
      gaps.push_back(across);
      if (++seen[material.value] >= seen[sight.what.valid() ? sight.what.value : material.value]) sight.what = material;
    }
  }
  if (!gaps.empty()) {
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    sight.gap = gaps[gaps.size() / 2];
  }
  return sight;
}

std::string millimetres(double metres) { return rounded(1000 * metres, 2) + " mm"; }

}  // namespace

std::vector<std::string> hints_about_panels(const Problem& problem) {
  const PatchSet& patches = problem.patches;
  std::vector<std::string> hints;
  for (std::size_t i = 0; i < patches.materials.size(); ++i) {
    const Material& material = patches.materials[i];
    if (!material.emits() || !material.receives()) continue;
    const MaterialId m{i};
    const std::vector<TriangleSide> sides = lit_sides_of(patches, m);
    std::vector<double> area_up_to;
    double area = 0;
    for (const TriangleSide& side : sides) {
      const auto& corner = patches.corners[side.triangle];
      const Vec3 a = patches.vertices[corner[0]];
      area += length(cross(patches.vertices[corner[1]] - a, patches.vertices[corner[2]] - a)) / 2;
      area_up_to.push_back(area);
    }
    if (!(area > 0)) continue;
    const Sight front = look(problem, m, sides, area_up_to, false), back = look(problem, m, sides, area_up_to, true);
    if (material.sides == 1) {
      if (front.room < 0.05 && back.room > 0.5)
        hints.push_back("material '" + material.name + "' shines away from the room behind it" +
                        (front.close > 0.5 ? ": its lit side sees '" + patches.materials[front.what].name + "', " +
                                                 millimetres(front.gap) + " away"
                                           : "") +
                        ". Turn its faces round, or leave out \"sides\": 1.");
      continue;
    }
    for (const auto& [near, far] : {std::pair{&front, &back}, {&back, &front}})
      if (near->close > 0.8 && far->close < 0.2 && far->room > 0.5)
        hints.push_back("material '" + material.name + "' shines from both sides, and one of them lies " +
                        millimetres(near->gap) + " from '" + patches.materials[near->what].name +
                        "': half of its light is spent there. Write \"sides\": 1 if it shines from one side only, with "
                        "its faces wound counter-clockwise as seen from the room.");
  }
  return hints;
}

}  // namespace clerestory
