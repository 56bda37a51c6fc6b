#include "pipeline/bake/light_on_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "pipeline/bake/covering_triangles.h"
#include "solver/model/bake_points.h"

namespace clerestory {
namespace {

/// A corner of one side of a triangle, by number: 6 a triangle, those of the front first.
struct CornerId {
  std::uint32_t value;
  std::uint32_t triangle() const { return value / 6; }
  bool is_back() const { return value % 6 >= 3; }
  std::uint32_t k() const { return value % 3; }
};

struct Light {
  Spectrum E, shown;
  double lux = 0;
};

/// The corners at a vertex that share one vertex of the lit part.
struct Group {
  std::vector<CornerId> corners;
  Vec3 normal;       ///< of the facets, by area
  Light first, sum;  ///< of the first corner; by `area`
  double area = 0;
  bool is_back = false, is_hidden = false;
};

/// Facets that face so much the same way are parts of one flat surface: light that jumps between them does so at the
/// rim of something that stands there.
constexpr double kFlat = 0.999;
constexpr double kJump = 0.002;      ///< of the light [1]
constexpr double kHiddenJump = 0.5;  ///< the same at corners under something, which have light from farther off

bool jumps(const Spectrum& a, const Spectrum& b, double most) {
  for (int k = 0; k < kMaxChannels; ++k)
    if (std::abs(a[k] - b[k]) > most * std::max(a[k], b[k])) return true;
  return false;
}

class PartLight {
 public:
  PartLight(const WrittenResult& result, const Field& shown, const ModelPart& part,
            std::span<const CornerCover> covering)
      : result_(result),
        E_(result.of_points.at("irradiance")),
        lux_(result.of_points.at("illuminance").value),
        shown_(shown),
        part_(part),
        covering_(covering),
        place_(covering.size(), kNone) {}

  LitPart operator()() {
    lit_.E.channels = lit_.shown.channels = E_.components;
    find_shown_sides();
    std::vector<std::pair<std::uint32_t, Group>> split;
    std::vector<Group> groups;
    for (std::uint32_t v = 0; v < part_.position.size(); ++v) {
      groups.clear();
      const std::span<const std::uint32_t> around = std::span(corners_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
      for (const std::uint32_t c : around)
        if (!is_of_sliver(CornerId{c})) put(CornerId{c}, groups);
      for (const std::uint32_t c : around)
        if (is_of_sliver(CornerId{c})) put_sliver(CornerId{c}, groups);
      if (groups.empty()) continue;
      add_vertex(v, groups.front());
      for (std::size_t g = 1; g < groups.size(); ++g) split.push_back({v, std::move(groups[g])});
    }
    for (const auto& [vertex, group] : split) add_vertex(vertex, group);
    light_slivers();
    for (std::size_t c = 0; c < place_.size(); c += 3) {
      if (place_[c] == kNone) continue;
      if (c % 6 == 0)
        lit_.triangles.push_back({place_[c], place_[c + 1], place_[c + 2]});
      else
        lit_.triangles.push_back({place_[c + 2], place_[c + 1], place_[c]});
    }
    return std::move(lit_);
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t vertex_of(CornerId c) const { return part_.triangles[c.triangle()][c.k()]; }
  Vec3 normal_of(CornerId c) const {
    const auto& [i, j, k] = part_.triangles[c.triangle()];
    const Vec3 n = cross(part_.position[j] - part_.position[i], part_.position[k] - part_.position[i]);
    return c.is_back() ? -n : n;
  }

  /// The sides that light reaches, else the front; and their corners by vertex.
  void find_shown_sides() {
    const auto visit = [&](const auto& take) {
      for (std::uint32_t t = 0; t < part_.triangles.size(); ++t) {
        const bool front = covering_[6 * t].is_lit(), back = covering_[6 * t + 3].is_lit();
        if (covering_[6 * t].is_pane()) continue;
        for (std::uint32_t c = 6 * t; c < 6 * t + 6; ++c)
          if (c % 6 < 3 ? front || !back : back) take(CornerId{c});
      }
    };
    begin_.assign(part_.position.size() + 1, 0);
    visit([&](CornerId c) { ++begin_[vertex_of(c) + 1]; });
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    corners_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    visit([&](CornerId c) { corners_[next[vertex_of(c)]++] = c.value; });
  }

  Light light_of(CornerId c) const {
    Light light;
    const CornerCover& by = covering_[c.value];
    if (!by.is_lit()) return light;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t p = result_.triangles[by.triangle][i];
      const double weight = by.weight[i];
      light.lux += weight * double{lux_[p]};
      light.shown += weight * shown_[p];
      const float* E = &E_.value[p * static_cast<std::size_t>(E_.components)];
      light.E += E_.components == 1 ? Spectrum(weight * double{*E})
                                    : Spectrum(weight * double{E[0]}, weight * double{E[1]}, weight * double{E[2]});
    }
    return light;
  }

  /// Of a face that is too narrow to have light of its own.
  bool is_of_sliver(CornerId c) const { return covering_[c.value].is_hidden && !covering_[c.value].is_lit(); }
  /// Into the group that faces most as it does, whose light it takes.
  void put_sliver(CornerId c, std::vector<Group>& groups) {
    const auto facing = [n = normalized(normal_of(c))](const Group& g) {
      return g.is_back ? -2.0 : dot(n, normalized(g.normal));
    };
    const auto at = std::ranges::max_element(groups, {}, facing);
    if (at == groups.end() || at->is_back)
      put(c, groups);
    else
      at->corners.push_back(c);
  }

  /// Into the first group that goes on smoothly to the corner, or one of its own.
  void put(CornerId c, std::vector<Group>& groups) {
    const Vec3 normal = normal_of(c);
    const Light light = light_of(c);
    const bool is_hidden = covering_[c.value].is_hidden;
    if (!lit_.material && covering_[c.value].is_lit()) lit_.material = result_.material[covering_[c.value].triangle];
    const auto joins = [&](const Group& g) {
      if (g.is_back != c.is_back()) return false;
      const double both = length(g.normal) * length(normal);
      if (!(both > 0)) return true;  // of no area
      const double cosine = dot(g.normal, normal) / both;
      if (cosine < part_.sharp_cosine) return false;
      const double most = is_hidden || g.is_hidden ? kHiddenJump : kJump;
      return cosine < kFlat || !(jumps(g.first.E, light.E, most) || jumps(g.first.shown, light.shown, most));
    };
    auto at = std::ranges::find_if(groups, joins);
    if (at == groups.end()) at = groups.insert(at, Group{{}, {}, light, {}, 0, c.is_back(), is_hidden});
    // Of hidden corners and others, the others tell the light.
    const double area = std::max(length(normal) * (is_hidden ? 1e-9 : 1), 1e-300);
    at->corners.push_back(c);
    at->normal += normal;
    at->area += area;
    at->sum.E += area * light.E, at->sum.shown += area * light.shown, at->sum.lux += area * light.lux;
  }

  /// Vertices that slivers alone have take the light of others in the same place: bevels of no width have their own.
  void light_slivers() {
    if (slivers_.empty()) return;
    std::map<std::array<double, 3>, std::uint32_t> lit_at;
    const auto place_of = [&](std::uint32_t i) {
      const Vec3& p = part_.position[lit_.vertex[i]];
      return std::array<double, 3>{p.x, p.y, p.z};
    };
    for (std::uint32_t i = 0; i < lit_.vertex.size(); ++i)
      if (lit_.illuminance[i] > 0 && !lit_.is_back[i]) lit_at.try_emplace(place_of(i), i);
    for (const std::uint32_t i : slivers_) {
      const auto at = lit_at.find(place_of(i));
      if (at == lit_at.end()) continue;
      lit_.E.set(i, lit_.E[at->second]), lit_.shown.set(i, lit_.shown[at->second]);
      lit_.illuminance[i] = lit_.illuminance[at->second];
    }
  }

  void add_vertex(std::uint32_t vertex, const Group& group) {
    if (std::ranges::all_of(group.corners, [&](CornerId c) { return is_of_sliver(c); }))
      slivers_.push_back(static_cast<std::uint32_t>(lit_.vertex.size()));
    for (const CornerId c : group.corners) place_[c.value] = static_cast<std::uint32_t>(lit_.vertex.size());
    const Vec3 normal = normalized(group.normal);
    lit_.vertex.push_back(vertex);
    lit_.is_back.push_back(group.is_back);
    lit_.normal.push_back(length(normal) > 0 ? normal : Vec3{0, 0, 1});
    for (int k = 0; k < lit_.E.channels; ++k) {
      lit_.E.value.push_back(group.sum.E[k] / group.area);
      lit_.shown.value.push_back(group.sum.shown[k] / group.area);
    }
    lit_.illuminance.push_back(static_cast<float>(group.sum.lux / group.area));
  }

  const WrittenResult& result_;
  const WrittenArray& E_;
  const std::vector<float>& lux_;
  const Field& shown_;
  const ModelPart& part_;
  std::span<const CornerCover> covering_;
  std::vector<std::uint32_t> begin_, corners_;  ///< by vertex
  std::vector<std::uint32_t> place_;            ///< of each corner: its vertex in the lit part
  std::vector<std::uint32_t> slivers_;          ///< of the lit part's vertices, those of slivers alone
  LitPart lit_;
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
  std::size_t first = 0;
  for (const ModelPart& part : parts) {
    const std::size_t n = 6 * part.triangles.size();
    lit.parts.push_back(PartLight(result, shown, part, std::span(covered.covering).subspan(first, n))());
    first += n;
  }
  return lit;
}

}  // namespace clerestory
