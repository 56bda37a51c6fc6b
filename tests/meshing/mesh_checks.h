#pragma once
// What must hold for every mesh, and scenes made by hand.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "meshing/build_patches.h"
#include "solver/model/box_tree.h"

namespace clerestory::testing {

/// A scene of polygons written down in a test.
class SceneMaker {
 public:
  SceneMaker() {
    scene_.file = "hand-made";
    material("grey");
  }
  MaterialId material(const std::string& name, double reflectance = 0.5) {
    Material m;
    m.name = name;
    m.reflectance = Spectrum(reflectance);
    scene_.materials.push_back(m);
    scene_.surfaces.push_back(name + " surface");
    return MaterialId{scene_.materials.size() - 1};
  }
  Material& edit(MaterialId m) { return scene_.materials[m]; }
  void polygon(const std::vector<Vec3>& corners, MaterialId m = MaterialId{std::size_t{0}}) {
    for (const Vec3& p : corners) {
      scene_.polygons.add_corner(static_cast<std::uint32_t>(scene_.polygons.vertices.size()));
      scene_.polygons.add_vertex(p);
    }
    scene_.polygons.end_face(m, SurfaceId{std::size_t{m.value}});
  }
  /// Axis-parallel box, faces outward.
  void box(const Vec3& a, const Vec3& b, MaterialId m = MaterialId{std::size_t{0}}) {
    polygon({{a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z}}, m);
    polygon({{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}, m);
    polygon({{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}}, m);
    polygon({{b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}}, m);
    polygon({{b.x, b.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}}, m);
    polygon({{a.x, b.y, a.z}, {a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}}, m);
  }
  Scene& scene() { return scene_; }

 private:
  Scene scene_;
};

inline double triangle_area(const PatchSet& p, std::size_t t) {
  const Vec3 a = p.vertices[p.corners[t][0]];
  return length(cross(p.vertices[p.corners[t][1]] - a, p.vertices[p.corners[t][2]] - a)) / 2;
}
inline double surface_area(const PatchSet& p) {
  double area = 0;
  for (std::size_t t = 0; t < p.triangle_count(); ++t) area += triangle_area(p, t);
  return area;
}
inline double diagonal(const PatchSet& p) {
  Box box;
  for (const Vec3& v : p.vertices) box.add(v);
  return length(box.upper - box.lower);
}

/// Vertices that lie inside an edge of a triangle that does not have them; `share` of the model's diagonal is "on".
inline std::size_t t_vertices(const PatchSet& p, double share = 1e-9) {
  const double near = share * diagonal(p);
  std::vector<Box> boxes(p.vertices.size());
  for (std::size_t v = 0; v < boxes.size(); ++v) {
    boxes[v].add(p.vertices[v]);
    boxes[v] = boxes[v].grown(near);
  }
  const BoxTree tree(boxes.size(), StoredBoxes{boxes});
  std::size_t count = 0;
  for (const auto& c : p.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId i = c[k], j = c[(k + 1) % 3];
      const Vec3 a = p.vertices[i], b = p.vertices[j], d = b - a;
      tree.visit_if([&](const Box& box) { return box.touches_segment(a, b); },
                    [&](std::uint32_t v) {
                      if (v == i.value || v == j.value) return;
                      const double t = dot(p.vertices[v] - a, d) / dot(d, d);
                      if (t > 0 && t < 1 && length(p.vertices[v] - a - d * t) <= near) ++count;
                    });
    }
  return count;
}

/// Edges by the number of triangles that share them.
inline std::map<std::size_t, std::size_t> edges_by_valence(const PatchSet& p) {
  std::map<std::array<std::uint32_t, 2>, std::size_t> edges;
  for (const auto& c : p.corners)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(c[k].value, c[(k + 1) % 3].value);
      ++edges[{a, b}];
    }
  std::map<std::size_t, std::size_t> count;
  for (const auto& [edge, times] : edges) ++count[times];
  return count;
}

/// Pairs of triangles that cover each other in part: coplanar, and the centre of one lies inside of the other.
inline std::size_t coincident_triangles(const PatchSet& p) {
  const double near = 1e-7 * diagonal(p);
  std::vector<Box> boxes(p.triangle_count());
  for (std::size_t t = 0; t < boxes.size(); ++t) {
    for (const VertexId v : p.corners[t]) boxes[t].add(p.vertices[v]);
    boxes[t] = boxes[t].grown(near);
  }
  const BoxTree tree(boxes.size(), StoredBoxes{boxes});
  std::size_t count = 0;
  for (std::uint32_t t = 0; t < p.triangle_count(); ++t) {
    Vec3 centre;
    for (const VertexId v : p.corners[t]) centre += p.vertices[v] / 3;
    Box point;
    point.add(centre);
    tree.visit(point, [&](std::uint32_t u) {
      if (u == t) return;
      std::array<Vec3, 3> x;
      for (std::size_t k = 0; k < 3; ++k) x[k] = p.vertices[p.corners[u][k]];
      const Vec3 n = normalized(cross(x[1] - x[0], x[2] - x[0]));
      if (std::abs(dot(centre - x[0], n)) > near) return;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 e = x[(k + 1) % 3] - x[k];
        if (dot(cross(e, centre - x[k]), n) <= near * length(e)) return;
      }
      const Vec3 y0 = p.vertices[p.corners[t][0]], y1 = p.vertices[p.corners[t][1]], y2 = p.vertices[p.corners[t][2]];
      if (length(cross(n, normalized(cross(y1 - y0, y2 - y0)))) > 0.01) return;
      ++count;
    });
  }
  return count;
}

}  // namespace clerestory::testing
