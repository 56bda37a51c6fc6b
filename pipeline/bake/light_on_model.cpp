#include "pipeline/bake/light_on_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "pipeline/bake/covering_triangles.h"
#include "solver/model/bake_points.h"

namespace clerestory {
namespace {

/// One corner of one side of a triangle of a part.
struct Corner {
  std::uint32_t triangle, k;  ///< of the part, and its corner there
  bool is_back = false;
  Vec3 normal;  ///< of the side, times the area of the facet
  Spectrum E, shown;
  double lux = 0;
};

/// The corners at a vertex that share one vertex of the lit part.
struct Group {
  std::vector<std::size_t> corners;
  Vec3 normal;
  Spectrum E, shown;  ///< of the first
  bool is_back = false;
};

/// Facets that face so much the same way are parts of one flat surface: light that jumps between them does so at the
/// rim of something that stands there.
constexpr double kFlat = 0.999;
constexpr double kJump = 0.01;  ///< of the light [1]

bool jumps(const Spectrum& a, const Spectrum& b) {
  for (int k = 0; k < kMaxChannels; ++k)
    if (std::abs(a[k] - b[k]) > kJump * std::max(a[k], b[k])) return true;
  return false;
}

class PartLight {
 public:
  PartLight(const WrittenResult& result, const Field& shown)
      : result_(result),
        E_(result.of_points.at("irradiance")),
        lux_(result.of_points.at("illuminance").value),
        shown_(shown) {}

  /// covering  of each side and corner of the part's triangles: 6 a triangle, front first.
  LitPart operator()(const ModelPart& part, std::span<const Covering> covering) {
    LitPart lit;
    lit.E.channels = lit.shown.channels = E_.components;
    std::vector<Corner> corners = corners_of(part, covering, lit);
    std::ranges::stable_sort(corners, {}, [&](const Corner& c) { return part.triangles[c.triangle][c.k]; });

    std::vector<std::uint32_t> place(corners.size());  // of each corner: its vertex
    std::vector<std::pair<std::uint32_t, Group>> split;
    for (std::size_t begin = 0, end = 0; begin < corners.size(); begin = end) {
      const std::uint32_t vertex = part.triangles[corners[begin].triangle][corners[begin].k];
      while (end < corners.size() && part.triangles[corners[end].triangle][corners[end].k] == vertex) ++end;
      std::vector<Group> groups = groups_of(corners, begin, end, part.sharp_cosine);
      add_vertex(lit, vertex, groups.front(), corners, place);
      for (std::size_t g = 1; g < groups.size(); ++g) split.push_back({vertex, std::move(groups[g])});
    }
    for (const auto& [vertex, group] : split) add_vertex(lit, vertex, group, corners, place);

    // Triangles in the part's order, the front before the back.
    std::vector<std::size_t> order(corners.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto key = [&](std::size_t i) {
      return std::tuple(corners[i].triangle, corners[i].is_back, corners[i].is_back ? 2 - corners[i].k : corners[i].k);
    };
    std::ranges::sort(order, {}, key);
    for (std::size_t i = 0; i + 2 < order.size(); i += 3)
      lit.triangles.push_back({place[order[i]], place[order[i + 1]], place[order[i + 2]]});
    return lit;
  }

 private:
  std::vector<Corner> corners_of(const ModelPart& part, std::span<const Covering> covering, LitPart& lit) const {
    std::vector<Corner> corners;
    corners.reserve(3 * part.triangles.size());
    for (std::uint32_t t = 0; t < part.triangles.size(); ++t) {
      const std::span<const Covering> of_triangle = covering.subspan(6 * t, 6);
      if (of_triangle.front().is_pane()) continue;
      const auto& v = part.triangles[t];
      const Vec3 normal = cross(part.position[v[1]] - part.position[v[0]], part.position[v[2]] - part.position[v[0]]);
      const auto is_lit = [&](std::size_t side) { return of_triangle[3 * side].is_lit(); };
      for (std::size_t side = 0; side < 2; ++side) {
        if (!is_lit(side) && (side == 1 || is_lit(1))) continue;
        for (std::uint32_t k = 0; k < 3; ++k) {
          Corner& c = corners.emplace_back(Corner{t, k, side == 1, side == 0 ? normal : -normal, {}, {}, 0});
          const Covering& by = of_triangle[3 * side + k];
          if (!by.is_lit()) continue;
          if (!lit.material) lit.material = result_.material[by.triangle];
          for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t p = result_.triangles[by.triangle][i];
            c.lux += by.weight[i] * double{lux_[p]};
            c.shown += by.weight[i] * shown_[p];
            for (int n = 0; n < kMaxChannels; ++n)
              c.E[n] += by.weight[i] * double{E_.value[p * static_cast<std::size_t>(E_.components) +
                                                       static_cast<std::size_t>(std::min(n, E_.components - 1))]};
          }
        }
      }
    }
    return corners;
  }

  static std::vector<Group> groups_of(const std::vector<Corner>& corners, std::size_t begin, std::size_t end,
                                      double sharp_cosine) {
    std::vector<Group> groups;
    for (std::size_t i = begin; i < end; ++i) {
      const Corner& c = corners[i];
      const auto joins = [&](const Group& g) {
        if (g.is_back != c.is_back) return false;
        const double both = length(g.normal) * length(c.normal);
        if (!(both > 0)) return true;  // of no area
        const double cosine = dot(g.normal, c.normal) / both;
        if (cosine < sharp_cosine) return false;
        return cosine < kFlat || !(jumps(g.E, c.E) || jumps(g.shown, c.shown));
      };
      const auto at = std::ranges::find_if(groups, joins);
      Group& g = at != groups.end() ? *at : groups.emplace_back(Group{{}, {}, c.E, c.shown, c.is_back});
      g.corners.push_back(i);
      g.normal += c.normal;
    }
    return groups;
  }

  static void add_vertex(LitPart& lit, std::uint32_t vertex, const Group& group, const std::vector<Corner>& corners,
                         std::vector<std::uint32_t>& place) {
    Spectrum E, shown;
    double lux = 0, all = 0;
    for (const std::size_t i : group.corners) {
      const double area = std::max(length(corners[i].normal), 1e-300);
      E += area * corners[i].E, shown += area * corners[i].shown, lux += area * corners[i].lux, all += area;
      place[i] = static_cast<std::uint32_t>(lit.vertex.size());
    }
    const Vec3 normal = normalized(group.normal);
    lit.vertex.push_back(vertex);
    lit.is_back.push_back(group.is_back);
    lit.normal.push_back(length(normal) > 0 ? normal : Vec3{0, 0, 1});
    for (int k = 0; k < lit.E.channels; ++k) {
      lit.E.value.push_back(E[k] / all);
      lit.shown.value.push_back(shown[k] / all);
    }
    lit.illuminance.push_back(static_cast<float>(lux / all));
  }

  const WrittenResult& result_;
  const WrittenArray& E_;
  const std::vector<float>& lux_;
  const Field& shown_;
};

}  // namespace

LitModel light_on_model(const WrittenResult& result, std::span<const ModelPart> parts) {
  std::vector<std::array<Vec3, 3>> triangles;
  for (const ModelPart& part : parts)
    for (const auto& [a, b, c] : part.triangles)
      triangles.push_back({part.position[a], part.position[b], part.position[c]});
  const CoveredModel covered = cover_model(result, triangles);
  const Field shown = shown_at_points(result, glowing_materials(result));
  LitModel lit{{}, covered.missing_share};
  PartLight light(result, shown);
  std::size_t first = 0;
  for (const ModelPart& part : parts) {
    const std::size_t n = 6 * part.triangles.size();
    lit.parts.push_back(light(part, std::span(covered.covering).subspan(first, n)));
    first += n;
  }
  return lit;
}

}  // namespace clerestory
