#include "tests/support/solved_box.h"

#include "io/write_result.h"
#include "solver/model/patch_set.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {
namespace {

/// Adds n x n squares from `corner` along u and v, whose front is that of cross(u, v).
void add_wall(PatchSet& patches, VertexLightmap& lightmap, const Vec3& corner, const Vec3& u, const Vec3& v,
              std::size_t n) {
  const std::size_t first = patches.vertices.size();
  for (std::size_t y = 0; y <= n; ++y)
    for (std::size_t x = 0; x <= n; ++x) {
      const auto share = [&](std::size_t k) { return static_cast<double>(k) / static_cast<double>(n); };
      patches.vertices.push_back(corner + u * share(x) + v * share(y));
      lightmap.patch_of_point.push_back(0);
    }
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) {
      const std::size_t a = first + y * (n + 1) + x, b = a + n + 1;
      for (const auto& t : {std::array{a, a + 1, b + 1}, std::array{a, b + 1, b}}) {
        auto& corners = lightmap.corners.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
          corners[k] = static_cast<std::uint32_t>(t[k]);
          lightmap.patch_of_point[t[k]] = static_cast<std::uint32_t>(patches.corners.size());
        }
        patches.corners.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
      }
    }
}

}  // namespace

std::string SolvedBox::write(const TempFolder& folder) const {
  const std::string scene = box.write(folder), file = folder / "room.vtp";
  const Vec3 a = box.offset, x{box.size.x, 0, 0}, y{0, box.size.y, 0}, z{0, 0, box.size.z}, b = a + x + y + z;
  PatchSet patches;
  VertexLightmap lightmap;
  add_wall(patches, lightmap, a, x, y, squares), add_wall(patches, lightmap, b, -y, -x, squares);
  add_wall(patches, lightmap, a, y, z, squares), add_wall(patches, lightmap, b, -z, -y, squares);
  add_wall(patches, lightmap, a, z, x, squares), add_wall(patches, lightmap, b, -x, -z, squares);
  const std::size_t count = patches.corners.size();
  patches.side_material.assign(count, {MaterialId{std::size_t{0}}, MaterialId{std::size_t{0}}});
  patches.side_surface.assign(count, {SurfaceId{std::size_t{0}}, SurfaceId{std::size_t{0}}});
  patches.surfaces = {"room"};
  Material wall;
  wall.name = "wall", wall.reflectance = Spectrum(box.rho), wall.exitance = Spectrum(box.M), wall.sides = 1;
  patches.materials = {wall};
  patches.materials.insert(patches.materials.end(), more_materials.begin(), more_materials.end());
  std::vector<bool> fronts(2 * count);
  for (std::size_t i = 0; i < count; ++i) fronts[2 * i] = true;
  make_patches(patches, fronts);

  const auto irradiance = [&](const Vec3& p) { return E ? E(p) : box.radiosity(); };
  lightmap.position = patches.vertices;
  lightmap.E = Field(lightmap.position.size(), 1);
  for (std::size_t i = 0; i < lightmap.E.size(); ++i) lightmap.E.set(i, Spectrum(irradiance(lightmap.position[i])));
  Solution solution;
  solution.E = solution.B = Field(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const auto p = patches.corner_positions(PatchId{i});
    solution.E.set(i, Spectrum(irradiance((p[0] + p[1] + p[2]) / 3)));
    solution.B.set(i, Spectrum(box.M) + Spectrum(box.rho) * solution.E[i]);
  }
  SceneAround all = around;
  all.files = {scene, folder / "room.obj"};
  RunReport report = new_report(scene);
  report.warnings = warnings;
  write_result(file, patches, lightmap, solution, all, report);
  return file;
}

}  // namespace clerestory
