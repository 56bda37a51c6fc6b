// Writes a result of as many points as asked for, without solving anything, and the floor that it lies on as OBJ of as
// many vertices: write_large_result N FLOOR.vtp FLOOR.obj [LAYERS CHANNELS]. For timing what is made of results:
//   clerestory bake FLOOR.vtp -o floor.glb; clerestory bake FLOOR.vtp -o floor.glb --detail model
//   clerestory mix FLOOR.vtp -o mixed.vtp --set 'layer 1=0.5'

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "io/atomic_file.h"
#include "io/write_result.h"
#include "solver/model/patch_set.h"

namespace clerestory {
namespace {

void write_large_result(std::size_t points, const char* file, const char* model, std::size_t layers, int channels) {
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
  patches.channels = channels;
  make_patches(patches, wanted);

  Solution solution;
  solution.E = solution.B = Field(count, channels);
  VertexLightmap lightmap;
  lightmap.position = patches.vertices;
  lightmap.patch_of_point.resize(n * n);
  lightmap.E = Field(n * n, channels);
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
  SceneAround around;
  LayeredLight light;
  const int lanes = static_cast<int>(layers) * channels;
  if (layers > 0) light.E = Field(n * n, lanes), light.E_elements = Field(count, lanes);
  for (std::size_t s = 0; s < layers; ++s) around.layers.push_back({"layer " + std::to_string(s + 1), {}});
  for (std::size_t i = 0; i < light.E.size(); ++i)
    for (int l = 0; l < lanes; ++l) {
      const double share = 1 + std::sin(0.1 * (l + 1) * patches.vertices[i].x + l);
      light.E.at(i, l) = share * lightmap.E.at(i, l % channels) / static_cast<double>(layers);
    }
  for (std::size_t i = 0; i < light.E_elements.size(); ++i)
    for (int l = 0; l < lanes; ++l) light.E_elements.at(i, l) = light.E.at(lightmap.corners[i][0], l);
  AtomicFile whole(file);
  write_result(whole, patches, lightmap, solution, around, new_report(model), light);
  whole.commit();
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  if (argc != 4 && argc != 6) {
    std::fprintf(stderr, "usage: write_large_result N FLOOR.vtp FLOOR.obj [LAYERS CHANNELS]\n");
    return 2;
  }
  const std::size_t layers = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 0;
  clerestory::write_large_result(std::strtoull(argv[1], nullptr, 10), argv[2], argv[3], layers,
                                 argc > 5 ? std::atoi(argv[5]) : 3);
}
