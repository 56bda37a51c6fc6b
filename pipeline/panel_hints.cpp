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

constexpr std::uint32_t kPoints = 64, kRays = 16;  ///< of a material, and from each side of a point
constexpr double kRightBehind = 0.1;               ///< what a panel may be mounted on [m]
constexpr double kClose = 0.05;                    ///< of a side that hardly lights anything [m]
constexpr double kWorthAWord = 0.1;                ///< share of the points

/// What rays from one side of a point meet.
struct Sight {
  std::uint32_t room = 0;        ///< fronts farther away than kRightBehind, and diffusers, which let light out
  std::uint32_t other_room = 0;  ///< those of other materials
  std::uint32_t far = 0;         ///< other materials farther away than kRightBehind, whichever side of them
  std::uint32_t close = 0;       ///< other materials within kClose of the panel's plane
};

/// What lies close to a panel: how far across its plane [m], and how often which material.
struct Neighbours {
  std::vector<double> gaps;
  std::map<std::uint32_t, int> materials;
};

struct TriangleSide {
  TriangleId triangle;
  Side side;
};

/// By material, the sides that shine: fronts, and backs that are fronts of a joined face. Of a two-sided material the
/// fronts of what has it on both sides.
std::vector<std::vector<TriangleSide>> lit_sides(const PatchSet& patches) {
  std::vector<std::vector<TriangleSide>> lit(patches.materials.size());
  const auto shines = [&](MaterialId m) { return patches.materials[m].emits() && patches.materials[m].receives(); };
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    const auto [front, back] = patches.side_material[t];
    const bool joined = !patches.joined.empty() && patches.joined[t];
    const bool on_both_sides = front.value == back.value && !joined;
    if (shines(front) && (patches.materials[front].sides == 1 || on_both_sides))
      lit[front].push_back({TriangleId{t}, kFront});
    if (joined && shines(back) && patches.materials[back].sides == 1) lit[back].push_back({TriangleId{t}, kBack});
  }
  return lit;
}

Sight look(const Problem& problem, MaterialId m, const Vec3& point, const Vec3& n, std::uint64_t key,
           Neighbours& neighbours) {
  const PatchSet& patches = problem.patches;
  const Vec3 p = point + n * problem.rays.lift();
  const Frame frame(n);
  Sight sight;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, key);
    const Ray ray{p, cosine_direction(frame, u[0], u[1])};
    const Hit hit = problem.rays.first_hit(patches, ray);
    if (hit.escaped()) continue;
    const auto& corner = patches.corners[hit.triangle];
    const Vec3 a = patches.vertices[corner[0]];
    const Vec3 normal = cross(patches.vertices[corner[1]] - a, patches.vertices[corner[2]] - a);
    const Side side = dot(normal, hit.direction(ray)) < 0 ? kFront : kBack;
    const MaterialId material = patches.side_material[hit.triangle][side];
    const bool is_other = material.value != m.value;
    const bool is_far = hit.distance > kRightBehind;
    if (patches.materials[material].scatters_through()) {
      ++sight.room;
      continue;
    }
    sight.room += is_far && side == kFront, sight.other_room += is_far && side == kFront && is_other;
    sight.far += is_far && is_other;
    const double across = dot(hit.position(ray) - p, n);
    if (hit.reflected || !is_other || across > kClose) continue;
    ++sight.close;
    neighbours.gaps.push_back(across);
    ++neighbours.materials[material.value];
  }
  return sight;
}

/// "'ceiling', 5.0 mm away"
std::string nearest(Neighbours& neighbours, const PatchSet& patches) {
  const auto middle = neighbours.gaps.begin() + static_cast<std::ptrdiff_t>(neighbours.gaps.size() / 2);
  std::nth_element(neighbours.gaps.begin(), middle, neighbours.gaps.end());
  const auto most = std::ranges::max_element(neighbours.materials, {}, [](const auto& m) { return m.second; });
  return "'" + patches.materials[most->first].name + "', " + rounded(1000 * *middle, 2) + " mm away";
}

std::string hint_about(const Problem& problem, MaterialId m, const std::vector<TriangleSide>& sides) {
  const PatchSet& patches = problem.patches;
  std::vector<double> area_up_to;
  double area = 0;
  for (const TriangleSide& s : sides) {
    const auto& corner = patches.corners[s.triangle];
    const Vec3 a = patches.vertices[corner[0]];
    area += length(cross(patches.vertices[corner[1]] - a, patches.vertices[corner[2]] - a)) / 2;
    area_up_to.push_back(area);
  }
  if (!(area > 0)) return "";
  const bool one_sided = patches.materials[m].sides == 1;
  Neighbours neighbours;
  double wrong = 0;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    const std::uint64_t key = stream_key(m, kPanelRays, k);
    const auto place = std::upper_bound(area_up_to.begin(), area_up_to.end(), (k + 0.5) / kPoints * area);
    const TriangleSide& s = sides[static_cast<std::size_t>(place - area_up_to.begin())];
    const auto& corner = patches.corners[s.triangle];
    const Vec3 a = patches.vertices[corner[0]], b = patches.vertices[corner[1]], c = patches.vertices[corner[2]];
    const Vec3 n = normalized(cross(b - a, c - a)) * (s.side == kFront ? 1.0 : -1.0);
    const auto u = sobol4(k, stream_key(m, kPanelRays, kPoints));
    const Vec3 p = point_on_triangle({a, b, c}, u[0], u[1]);
    Neighbours at_front, at_back;
    const Sight front = look(problem, m, p, n, key, at_front), back = look(problem, m, p, -n, key, at_back);
    const auto add = [&](const Neighbours& near) {
      wrong += 1.0 / kPoints;
      neighbours.gaps.insert(neighbours.gaps.end(), near.gaps.begin(), near.gaps.end());
      for (const auto& [material, count] : near.materials) neighbours.materials[material] += count;
    };
    const auto is_wasted = [](const Sight& near, const Sight& far) {
      return near.close > 0.8 * kRays && far.close < 0.2 * kRays && far.far > 0.5 * kRays;
    };
    if (one_sided) {
      if (is_wasted(front, back) || (front.room < 0.1 * kRays && back.other_room > 0.5 * kRays)) add(at_front);
    } else if (is_wasted(front, back)) {
      add(at_front);
    } else if (is_wasted(back, front)) {
      add(at_back);
    }
  }
  if (wrong < kWorthAWord) return "";
  const std::string what = "material '" + patches.materials[m].name + "'" +
                           (wrong < 1 - kWorthAWord ? ", in some " + rounded(100 * wrong, 1) + " % of its area," : "");
  if (one_sided)
    return what + " shines away from the room behind it" +
           (neighbours.gaps.empty() ? "" : ": its lit side sees " + nearest(neighbours, patches)) +
           ". Turn its faces round, or leave out \"sides\": 1.";
  return what + " shines from both sides, and one of them sees " + nearest(neighbours, patches) +
         ": half of its light is spent there. Write \"sides\": 1 if it shines from one side only, with its faces wound "
         "counter-clockwise as seen from the room.";
}

}  // namespace

std::vector<std::string> hints_about_panels(const Problem& problem) {
  std::vector<std::string> hints;
  const std::vector<std::vector<TriangleSide>> lit = lit_sides(problem.patches);
  for (std::size_t m = 0; m < lit.size(); ++m)
    if (std::string hint = hint_about(problem, MaterialId{m}, lit[m]); !hint.empty()) hints.push_back(std::move(hint));
  return hints;
}

}  // namespace clerestory
