// A small scene made of any bytes, meshed: patches that hold together, or refused because nothing of it has an area.

#include <cmath>

#include "meshing/build_patches.h"
#include "meshing/make_lightmap.h"
#include "solver/model/parallel.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/soup_from_bytes.h"
#include "tests/meshing/patch_mesh_checks.h"

namespace clerestory {
namespace {

void check(const PatchSet& p, const MeshReport& report) {
  require(p.triangle_count() > 0 && report.triangles == p.triangle_count(), "there are no triangles");
  for (const Vec3& v : p.vertices) require(is_finite(v), "a vertex is not finite");
  for (const auto& c : p.corners)
    require(c[0] != c[1] && c[1] != c[2] && c[2] != c[0] && c[0] < p.vertices.size() && c[1] < p.vertices.size() &&
                c[2] < p.vertices.size(),
            "a triangle has a corner twice, or one that is not there");
  for (std::size_t i = 0; i < p.patch_count(); ++i)
    require(p.area[i] > 0 && std::isfinite(p.area[i]) && std::abs(length(p.normal[i]) - 1) < 1e-6,
            "a patch has no area, or no normal");

  const VertexLightmap map = make_lightmap(p);
  require(map.sample_begin.size() == map.position.size() + 1, "points have no samples");
  for (const Vec3& x : map.sample_position) require(is_finite(x), "a sample is not finite");
  const PatchMesh joined = join_patches(p, map.neighbour);
  const std::string wrong = testing::wrong_links(joined);
  require(wrong.empty(), wrong);
  require(testing::lost_neighbours(joined, map) == 0, "patches joined at their edges are not as the lightmap says");
  require(testing::torn_corners(p, joined) == 0, "corners of a fan lie apart");
}

}  // namespace
}  // namespace clerestory

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace clerestory;
  static const bool ready = (set_thread_count(1), true);  // coverage is told from run to run
  static_cast<void>(ready);
  Bytes bytes(data, size);
  // Coarse, for speed: halving triangles is much the same for all; or by the number of triangles.
  const std::size_t detail = bytes.below(4);
  const Scene scene = soup_from(bytes);
  MeshOptions options;
  if (detail == 0) options.target_triangles = 100;
  if (detail > 0) options.max_element = detail == 1 ? 0.7 : detail == 2 ? 2 : 1e4;
  if (detail > 0) options.fit_triangles = 200;
  read_or_refuse([&] {
    const MeshedScene meshed = build_patches(scene, options);
    check(meshed.patches, meshed.report);
  });
  return 0;
}
