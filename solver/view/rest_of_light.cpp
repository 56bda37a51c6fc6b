#include "solver/view/rest_of_light.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>

#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/units.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {
namespace {

constexpr double kSure = 0.02;   // bounds nearer than this, as a share of the upper one, are no edge of a shadow
constexpr int kMostSweeps = 64;  // over points that take after their neighbours
constexpr std::size_t kMostOfFacing = 8;  // facets of one facing that a point looks from

/// Which triangles are at each point.
struct TrianglesOfPoints {
  std::vector<std::uint32_t> begin, triangle;
  std::span<const std::uint32_t> of(std::size_t p) const {
    return std::span(triangle).subspan(begin[p], begin[p + 1] - begin[p]);
  }
};

TrianglesOfPoints triangles_of_points(const WrittenResult& result) {
  TrianglesOfPoints at{std::vector<std::uint32_t>(result.points.size() + 1), {}};
  for (const auto& corners : result.triangles)
    for (const std::uint32_t p : corners) ++at.begin[p + 1];
  std::partial_sum(at.begin.begin(), at.begin.end(), at.begin.begin());
  at.triangle.resize(at.begin.back());
  std::vector<std::uint32_t> next(at.begin.begin(), at.begin.end() - 1);
  for (std::uint32_t t = 0; t < result.triangles.size(); ++t)
    for (const std::uint32_t p : result.triangles[t]) at.triangle[next[p]++] = t;
  return at;
}

Vec3 normal_of(const WrittenResult& result, std::uint32_t t) {
  const auto& [a, b, c] = result.triangles[t];
  return normalized(cross(result.points[b] - result.points[a], result.points[c] - result.points[a]));
}

/// Points where the surface goes on as another point: something stands there, and the solve looked from farther inside.
std::vector<bool> outline_points(const WrittenResult& result, const TrianglesOfPoints& at) {
  const auto place = [&](std::uint32_t p) {
    const Vec3& x = result.points[p];
    return std::tuple(x.x, x.y, x.z);
  };
  std::vector<std::uint32_t> order(result.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(
      order, [&](std::uint32_t p, std::uint32_t q) { return place(p) != place(q) ? place(p) < place(q) : p < q; });
  std::vector<bool> is_outline(order.size());
  const auto face_alike = [&](std::uint32_t p, std::uint32_t q) {
    for (const std::uint32_t t : at.of(p))
      for (const std::uint32_t s : at.of(q))
        if (result.material[t] == result.material[s] &&
            dot(normal_of(result, t), normal_of(result, s)) > VertexLightmap::kAlike)
          return true;
    return false;
  };
  for (std::size_t first = 0, end; first < order.size(); first = end) {
    for (end = first + 1; end < order.size() && place(order[end]) == place(order[first]);) ++end;
    for (std::size_t i = first; i < end; ++i)
      for (std::size_t k = i + 1; k < end; ++k)
        if (face_alike(order[i], order[k])) is_outline[order[i]] = is_outline[order[k]] = true;
  }
  return is_outline;
}

/// Facets around a point that face nearly the same way.
struct FacetsAlike {
  Vec3 normal;  ///< of the first
  std::vector<std::uint32_t> facets;
};

std::vector<FacetsAlike> facings_of(const WrittenResult& result, std::span<const std::uint32_t> facets) {
  std::vector<FacetsAlike> facings;
  for (const std::uint32_t t : facets) {
    const Vec3 n = normal_of(result, t);
    auto at =
        std::ranges::find_if(facings, [&](const FacetsAlike& f) { return dot(f.normal, n) > VertexLightmap::kAlike; });
    if (at == facings.end()) at = facings.insert(at, FacetsAlike{n, {}});
    at->facets.push_back(t);
  }
  return facings;
}

/// So far from point p to the middle of the facet.
Vec3 on_facet(const WrittenResult& result, std::size_t p, std::uint32_t facet, double way) {
  const auto& [a, b, c] = result.triangles[facet];
  const auto& x = result.points;
  return x[p] + ((x[a] + x[b] + x[c]) / 3 - x[p]) * way;
}

/// Straight light of a point, as its facets have it: the mean over the ways they face.
StraightLight at_facets(const WrittenResult& result, const FineLight& light, std::size_t p,
                        std::span<const std::uint32_t> facets, double way) {
  const std::vector<FacetsAlike> facings = facings_of(result, facets);
  StraightLight all;
  for (const FacetsAlike& facing : facings) {
    const std::size_t step = (facing.facets.size() + kMostOfFacing - 1) / kMostOfFacing;
    StraightLight mean, bounds;
    double count = 0;
    for (std::size_t i = 0; i < facing.facets.size(); i += step, ++count) {
      const std::uint32_t facet = facing.facets[i];
      const StraightLight here = light.at_point(on_facet(result, p, facet, way), normal_of(result, facet));
      mean.E += here.E;
      for (int k = 0; k < kMaxChannels; ++k) {
        bounds.low[k] = i == 0 ? here.low[k] : std::min(bounds.low[k], here.low[k]);
        bounds.high[k] = std::max(bounds.high[k], here.high[k]);
      }
    }
    const double share = 1.0 / static_cast<double>(facings.size());
    all.E += mean.E * (share / count), all.low += bounds.low * share, all.high += bounds.high * share;
  }
  return all;
}

double way_to_facet(bool is_outline) {
  return is_outline ? VertexLightmap::kWayFromOutline : VertexLightmap::kWayToCentroid;
}

/// Of E at each point what its facets have of caustics, as the result had them: as wide a line, in the same place.
void take_off_caustics(const WrittenResult& result, const FineLight& light, const TrianglesOfPoints& at,
                       const std::vector<bool>& is_outline, Field& E) {
  std::vector<SensorPoint> places;
  std::vector<std::size_t> begin{0};
  for (std::size_t p = 0; p < E.size(); ++p) {
    for (const FacetsAlike& facing : facings_of(result, at.of(p)))
      places.push_back({on_facet(result, p, facing.facets.front(), way_to_facet(is_outline[p])), facing.normal});
    begin.push_back(places.size());
  }
  const Field caustics = light.caustics_at(places);
  if (caustics.value.empty()) return;
  for (std::size_t p = 0; p < E.size(); ++p)
    for (std::size_t i = begin[p]; i < begin[p + 1]; ++i)
      E.add(p, caustics[i] * (-1 / static_cast<double>(begin[p + 1] - begin[p])));
}

}  // namespace

Field rest_of_light(const WrittenResult& result, const FineLight& light, const Monitor& monitor) {
  const WrittenArray& written = result.of_points.at("irradiance");
  const std::size_t count = result.points.size();
  Field E(count, written.components), rest;
  std::ranges::copy(written.value, E.value.begin());
  if (light.empty()) return E;
  const TrianglesOfPoints at = triangles_of_points(result);
  const std::vector<bool> is_outline = outline_points(result, at);
  std::vector<StraightLight> straight(count);
  const Blocks blocks = parallel_blocks(count, std::max<std::size_t>(count / 16, 1024), 64, "direct light", monitor,
                                        [&](std::size_t begin, std::size_t end) {
                                          for (std::size_t p = begin; p < end; ++p)
                                            straight[p] =
                                                at_facets(result, light, p, at.of(p), way_to_facet(is_outline[p]));
                                          return 0ull;
                                        });
  if (blocks.done < count) return {};
  take_off_caustics(result, light, at, is_outline, E);

  const auto less = [&](std::size_t p, const Spectrum& D) {
    Spectrum left = E[p] - D;
    for (int k = 0; k < kMaxChannels; ++k) left[k] = std::max(0.0, left[k]);
    return left;
  };
  rest = Field(count, E.channels);
  std::vector<bool> known(count);
  std::vector<std::uint32_t> open;
  for (std::uint32_t p = 0; p < count; ++p) {
    const StraightLight& s = straight[p];
    rest.set(p, less(p, s.E));
    if (!(known[p] = luminous_mean(s.high - s.low) <= kSure * luminous_mean(s.high))) open.push_back(p);
  }
  for (int sweep = 0; sweep < kMostSweeps && !open.empty(); ++sweep) {
    std::vector<std::pair<std::uint32_t, Spectrum>> found;
    for (const std::uint32_t p : open) {
      Spectrum sum(0.0);
      double neighbours = 0;
      for (const std::uint32_t t : at.of(p))
        for (const std::uint32_t q : result.triangles[t])
          if (known[q]) sum += rest[q], ++neighbours;
      if (neighbours == 0) continue;
      const Spectrum least = less(p, straight[p].high), most = less(p, straight[p].low);
      Spectrum as_there = sum / neighbours;
      for (int k = 0; k < kMaxChannels; ++k) as_there[k] = std::clamp(as_there[k], least[k], most[k]);
      found.emplace_back(p, as_there);
    }
    if (found.empty()) break;
    for (const auto& [p, as_there] : found) rest.set(p, as_there), known[p] = true;
    std::erase_if(open, [&](std::uint32_t p) { return known[p]; });
  }
  return rest;
}

Field light_by_gloss(const WrittenResult& result, const FineLight& light, const Monitor& monitor) {
  constexpr int kPairs = 128;
  const std::size_t count = result.points.size();
  Field E(count, result.channels());
  if (!light.has_gloss()) return E;
  const TrianglesOfPoints at = triangles_of_points(result);
  const std::vector<bool> is_outline = outline_points(result, at);
  const Blocks blocks = parallel_blocks(
      count, std::max<std::size_t>(count / 16, 1024), 64, "light by gloss", monitor,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p) {
          const std::vector<FacetsAlike> facings = facings_of(result, at.of(p));
          const double way = is_outline[p] ? VertexLightmap::kWayFromOutline : VertexLightmap::kWayToCentroid;
          for (const FacetsAlike& f : facings)
            E.add(p, light.by_gloss(on_facet(result, p, f.facets.front(), way), f.normal, kPairs,
                                    stream_key(kLightsOfPoints, p)) /
                         static_cast<double>(facings.size()));
        }
        return 0ull;
      });
  return blocks.done == count ? E : Field{};
}

}  // namespace clerestory
