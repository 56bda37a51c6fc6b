// Writes a result of as many points as asked for, without solving anything, and the floor that it lies on as OBJ of as
// many vertices: write_large_result N FLOOR.vtp FLOOR.obj. For timing what is made of results:
//   clerestory bake FLOOR.vtp -o floor.glb; clerestory bake FLOOR.vtp -o floor.glb --detail model

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "io/write_result.h"
#include "solver/model/patch_set.h"

namespace clerestory {
namespace {

void write_large_result(std::size_t points, const char* file, const char* model) {
  const auto n = static_cast<std::size_t>(std::sqrt(static_cast<double>(points)));  // a side
  PatchSet patches;
  std::ofstream obj(model);
  for (std::size_t i = 0; i < n * n; ++i) {
    const Vec3 p{0.01 * static_cast<double>(i % n), 0.01 * static_cast<double>(i / n), 0};
    patches.vertices.push_back(p);
    obj << "v " << p.x << " " << p.y << " 0\n";
  }
  obj << "o floor\n";
  for (std::size_t y = 0; y + 1 < n; ++y)
    for (std::size_t x = 0; x + 1 < n; ++x) {
      const std::size_t a = y * n + x;
      patches.corners.push_back({VertexId{a}, VertexId{a + 1}, VertexId{a + n}});
      patches.corners.push_back({VertexId{a + 1}, VertexId{a + n + 1}, VertexId{a + n}});
      obj << "f " << a + 1 << " " << a + 2 << " " << a + n + 2 << " " << a + n + 1 << "\n";
    }
  const std::size_t count = patches.corners.size();
  patches.side_material.assign(count, {MaterialId{std::size_t{0}}, MaterialId{std::size_t{0}}});
  patches.side_surface.assign(count, {SurfaceId{std::size_t{0}}, SurfaceId{std::size_t{0}}});
  patches.materials.resize(1);
  patches.surfaces = {"floor"};
  std::vector<bool> wanted(2 * count, false);
  for (std::size_t i = 0; i < count; ++i) wanted[2 * i] = true;
  patches.channels = 3;
  make_patches(patches, wanted);

  Solution solution;
  solution.E = solution.B = Field(count, 3);
  VertexLightmap lightmap;
  lightmap.position = patches.vertices;
  lightmap.patch_of_point.resize(n * n);
  lightmap.E = Field(n * n, 3);
  for (std::size_t i = 0; i < count; ++i) {
    auto& corners = lightmap.corners.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = static_cast<std::uint32_t>(patches.corners[TriangleId{i}][k]);
      lightmap.patch_of_point[corners[k]] = static_cast<std::uint32_t>(i);
    }
  }
  for (std::size_t i = 0; i < n * n; ++i) {
    const Vec3& p = patches.vertices[i];
    lightmap.E.set(i, {1 + p.x, 1 + p.y, 2 + std::sin(p.x)});
  }
  write_result(file, patches, lightmap, solution, {}, new_report(model));
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: write_large_result N FLOOR.vtp FLOOR.obj\n");
    return 2;
  }
  clerestory::write_large_result(std::strtoull(argv[1], nullptr, 10), argv[2], argv[3]);
}
