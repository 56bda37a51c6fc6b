#include "io/formats/gltf_cameras.h"

#include <numbers>

#include "io/formats/gltf_nodes.h"
#include "io/text.h"

namespace clerestory {
namespace {

using Json = GltfFile::Json;

const Json& member(const GltfFile& file, const Json& camera, const std::string& key, const std::string& where) {
  const auto found = camera.find(key);
  if (found == camera.end() || !found->is_object()) file.refuse(text(where, " has no \"", quotable(key), "\""));
  return *found;
}

}  // namespace

std::vector<ModelCamera> read_gltf_cameras(const std::filesystem::path& path) {
  const GltfFile file(path);
  std::vector<ModelCamera> cameras;
  visit_shown_nodes(file, [&](const GltfNode& at) {
    const Json& node = file.element("nodes", at.index);
    const std::string node_place = text("nodes[", at.index, "]");
    if (!node.contains("camera")) return;
    const std::size_t index = whole_number(file, node, "camera", 0, node_place);
    const Json& json = file.element("cameras", index);
    const std::string where = text("cameras[", index, "]");
    ModelCamera& camera = cameras.emplace_back();
    camera.place = at.place;
    for (const std::string& name :
         {text_member(file, node, "name", node_place), text_member(file, json, "name", where)})
      if (!name.empty()) camera.names.push_back(clean_text(name));
    if (camera.names.empty()) camera.names.push_back(text("camera ", cameras.size()));
    const std::string type = text_member(file, json, "type", where);
    if (type == "perspective") {
      camera.yfov = finite_number(file, member(file, json, type, where), "yfov", 0, where);
      if (!(*camera.yfov > 0 && *camera.yfov < std::numbers::pi))
        file.refuse(text(where, ".yfov = ", *camera.yfov, " is outside (0, pi)"));
    } else if (type == "orthographic") {
      camera.ymag = finite_number(file, member(file, json, type, where), "ymag", 0, where);
      if (!(camera.ymag > 0)) file.refuse(text(where, ".ymag = ", camera.ymag, " is not above 0"));
    } else {
      file.refuse(text(where, ".type '", quotable(type), "' is not known; known are perspective, orthographic"));
    }
  });
  return cameras;
}

}  // namespace clerestory
