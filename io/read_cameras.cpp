#include "io/read_cameras.h"

#include "io/formats/gltf_cameras.h"
#include "io/input_file.h"
#include "io/scene_file/geometry_entries.h"
#include "io/text.h"

namespace clerestory {
namespace {

void add_cameras(const std::filesystem::path& file, const std::optional<std::array<double, 16>>& transform,
                 std::vector<SceneCamera>& to) {
  const std::string extension = to_lower(file.extension().string());
  if (extension != ".glb" && extension != ".gltf") return;
  const Affine in_scene = to_scene(1.0, Up::y, transform);  // as read_gltf() says
  for (const ModelCamera& camera : read_gltf_cameras(file)) {
    const Affine place = in_scene * camera.place;
    const Vec3 up = place.direction({0, 1, 0});
    to.push_back({camera.names, place.b, normalized(place.direction({0, 0, -1})), normalized(up), camera.yfov,
                  camera.ymag * length(up)});
  }
}

}  // namespace

std::vector<SceneCamera> read_cameras(const std::filesystem::path& scene) {
  std::vector<SceneCamera> cameras;
  if (to_lower(scene.extension().string()) != ".json") {
    check_input_file(scene, std::uintmax_t{4} << 30);
    add_cameras(scene, {}, cameras);
    return cameras;
  }
  for (const GeometryEntry& entry : read_geometry_entries(scene))
    add_cameras(entry.file, entry.placement.transform, cameras);
  return cameras;
}

}  // namespace clerestory
