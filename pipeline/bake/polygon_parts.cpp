#include "pipeline/bake/polygon_parts.h"

#include <map>
#include <unordered_map>
#include <utility>

#include "meshing/triangulate_polygon.h"

namespace clerestory {
namespace {

/// A part under way, with the place of each vertex of the scene in it.
struct Open {
  ModelPart part;
  std::unordered_map<std::uint32_t, std::uint32_t> place;

  std::uint32_t vertex(const PolygonSoup& soup, std::uint32_t v) {
    const auto [at, is_new] = place.try_emplace(v, static_cast<std::uint32_t>(part.position.size()));
    if (is_new) part.position.push_back(soup.vertices[v]);
    return at->second;
  }
};

void add_face(Open& to, const PolygonSoup& soup, std::size_t face) {
  const std::size_t begin = soup.face_begin[face], n = soup.face_begin[face + 1] - begin;
  std::vector<std::uint32_t> at;
  std::vector<Vec3> polygon;
  for (std::size_t c = begin; c < begin + n; ++c) {
    at.push_back(to.vertex(soup, soup.corner[c]));
    polygon.push_back(soup.vertices[soup.corner[c]]);
  }
  if (n == 3) {
    to.part.triangles.push_back({at[0], at[1], at[2]});
    return;
  }
  const PolygonTriangles cut = triangulate_polygon(polygon);
  for (const Vec3& crossing : cut.crossings) {
    at.push_back(static_cast<std::uint32_t>(to.part.position.size()));
    to.part.position.push_back(crossing);
  }
  for (const auto& [a, b, c] : cut.triangles) to.part.triangles.push_back({at[a], at[b], at[c]});
}

}  // namespace

PolygonParts polygon_parts(const Scene& scene, const std::vector<bool>& wanted) {
  const PolygonSoup& soup = scene.polygons;
  std::map<std::pair<std::size_t, std::size_t>, Open> open;
  for (std::size_t f = 0; f < soup.face_count(); ++f) {
    const SurfaceId surface = soup.surface[f];
    if (wanted[surface]) add_face(open[{surface, soup.material[f]}], soup, f);
  }
  PolygonParts all;
  for (auto& [key, o] : open) {
    if (o.part.triangles.empty()) continue;
    o.part.name = scene.surfaces[key.first];
    all.parts.push_back(std::move(o.part));
    all.surface.push_back(SurfaceId(key.first));
    all.material.push_back(MaterialId(key.second));
  }
  return all;
}

}  // namespace clerestory
