#include "io/bake/model_glb.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <utility>

#include "io/bake/gltf_materials.h"
#include "io/bake/gltf_model.h"
#include "io/text.h"
#include "solver/model/bake_points.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr const char* kLamps = "KHR_lights_punctual";

/// A glTF file in another, with light on it.
class Graft {
 public:
  Graft(GlbBuilder& glb, const GltfModel& model, std::span<const LitPart> parts, const BakedNames& names,
        double exposure)
      : glb_(glb), model_(model), parts_(parts), exposure_(exposure), materials_(glb, model.file, names) {}

  /// The nodes that have no parent.
  std::vector<std::size_t> add() {
    std::vector<std::size_t> top;
    std::size_t part = 0;
    for (const GltfNode& node : model_.nodes) {
      Json json = node_of(node);
      if (auto mesh = mesh_of(node, part)) json["mesh"] = glb_.add("meshes", std::move(*mesh));
      const std::size_t index = glb_.add("nodes", std::move(json));
      index_[node.index] = index;
      if (node.parent)
        glb_.element("nodes", index_.at(*node.parent))["children"].push_back(index);
      else
        top.push_back(index);
    }
    return top;
  }
  const std::vector<std::string>& left_out() const { return materials_.left_out(); }

 private:
  Json node_of(const GltfNode& node) {
    const Json& from = model_.file.element("nodes", node.index);
    const std::string where = text("nodes[", node.index, "]");
    Json to = Json::object();
    if (const std::string name = text_member(model_.file, from, "name", where); !name.empty()) to["name"] = name;
    for (const char* key : {"matrix", "translation", "scale", "extras"})
      if (from.contains(key)) to[key] = from[key];
    if (from.contains("rotation")) {
      std::vector<double> q = finite_numbers(model_.file, from, "rotation", {0, 0, 0, 1}, where);
      const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      for (double& x : q) x /= norm;
      to["rotation"] = q;
    }
    if (from.contains("camera")) {
      const std::size_t camera = whole_number(model_.file, from, "camera", 0, where);
      const auto [at, is_new] = cameras_.try_emplace(camera);
      if (is_new) at->second = glb_.add("cameras", without_extensions(model_.file.element("cameras", camera)));
      to["camera"] = at->second;
    }
    if (const Json& lamp = extension(from, kLamps); lamp.contains("light")) {
      const Json& all = extension(model_.file.root(), kLamps);
      const std::size_t light = whole_number(model_.file, lamp, "light", 0, where);
      const auto [at, is_new] = lamps_.try_emplace(light);
      if (is_new) {
        glb_.use(kLamps);
        Json& lamps = glb_.root()["extensions"][kLamps]["lights"];
        lamps.push_back(without_extensions(all.at("lights").at(light)));
        at->second = lamps.size() - 1;
      }
      to["extensions"][kLamps]["light"] = at->second;
    }
    return to;
  }

  /// The node's own copy of its mesh; nothing when nothing of it is shown. part: the first of its parts, moved on.
  std::optional<Json> mesh_of(const GltfNode& node, std::size_t& part) {
    std::size_t mesh = 0;
    Json primitives = Json::array();
    for (; part < parts_.size() && model_.sources[part].node == node.index; ++part) {
      mesh = model_.sources[part].mesh;
      if (!parts_[part].triangles.empty()) primitives.push_back(primitive_of(model_.sources[part], parts_[part]));
    }
    if (primitives.empty()) return {};
    const Json& from = model_.file.element("meshes", mesh);
    Json to = {{"primitives", std::move(primitives)}};
    if (const std::string name = text_member(model_.file, from, "name", "meshes"); !name.empty()) to["name"] = name;
    if (from.contains("extras") && from["extras"].is_object()) to["extras"] = from["extras"];
    to["extras"]["exposure"] = exposure_;
    return to;
  }

  Json primitive_of(const GltfModel::Source& source, const LitPart& lit) {
    const Json& from = model_.file.element("meshes", source.mesh)["primitives"][source.primitive];
    const Json& attributes = from["attributes"];
    Json to = Json::object();
    std::vector<std::uint32_t> at;  // of each vertex in the accessors
    for (const std::uint32_t v : lit.vertex) at.push_back(source.vertex[v]);

    std::vector<Vec3> position, E;
    const auto& all = model_.file.positions(accessor_of(attributes, "POSITION"));
    for (const std::uint32_t v : at) position.push_back(all[v]);
    to["POSITION"] = glb_.add_positions(position);
    to["NORMAL"] = glb_.add_vectors(normals_of(source, lit, attributes, at));
    const std::size_t uv_sets = copy_attributes(attributes, at, to);
    for (std::size_t i = 0; i < lit.E.size(); ++i) E.push_back({lit.E[i][0], lit.E[i][1], lit.E[i][2]});
    to["COLOR_0"] = glb_.add_floats(shown_colours(lit.shown, exposure_), 3);
    to["_ILLUMINANCE"] = glb_.add_floats(lit.illuminance, 1);
    to["_IRRADIANCE"] = glb_.add_vectors(E);

    std::vector<std::uint32_t> corners;
    for (auto [a, b, c] : lit.triangles) {
      if (source.place.mirrors()) std::swap(a, c);
      corners.insert(corners.end(), {a, b, c});
    }
    std::optional<std::size_t> material;
    if (from.contains("material")) material = whole_number(model_.file, from, "material", 0, "primitives");
    return {{"attributes", std::move(to)},
            {"indices", glb_.add_indices(corners, at.size())},
            {"material", materials_(material, uv_sets, lit.material)}};
  }

  std::size_t accessor_of(const Json& attributes, const std::string& name) {
    return whole_number(model_.file, attributes, name.c_str(), 0, "attributes");
  }

  /// Of the file, turned round on backs; where it has none, those of the facets.
  std::vector<Vec3> normals_of(const GltfModel::Source& source, const LitPart& lit, const Json& attributes,
                               const std::vector<std::uint32_t>& at) {
    const std::vector<Vec3>* own = nullptr;
    if (attributes.contains("NORMAL")) own = &model_.file.positions(accessor_of(attributes, "NORMAL"));
    const auto& A = source.place.A;
    std::vector<Vec3> normals;
    for (std::size_t i = 0; i < at.size(); ++i) {
      Vec3 n = own && at[i] < own->size() ? normalized((*own)[at[i]]) : Vec3{};
      if (lit.is_back[i]) n = -n;
      if (!(length(n) > 0.5)) n = normalized(A[0] * lit.normal[i].x + A[1] * lit.normal[i].y + A[2] * lit.normal[i].z);
      normals.push_back(length(n) > 0.5 ? n : Vec3{0, 0, 1});
    }
    return normals;
  }

  /// Texture coordinates, colours (one number higher: COLOR_0 is the light) and what has names of its own. Returns how
  /// many sets of texture coordinates there are.
  std::size_t copy_attributes(const Json& attributes, const std::vector<std::uint32_t>& at, Json& to) {
    static const std::regex own_name("_[A-Z0-9_]+");
    const auto copy = [&](const std::string& name, const std::string& as, bool is_colour) {
      if (const auto accessor = values_of(accessor_of(attributes, name), at, is_colour)) to[as] = *accessor;
      return to.contains(as);
    };
    std::size_t sets = 0;
    while (attributes.contains(text("TEXCOORD_", sets)) &&
           copy(text("TEXCOORD_", sets), text("TEXCOORD_", sets), false))
      ++sets;
    for (std::size_t n = 0; attributes.contains(text("COLOR_", n)); ++n)
      if (!copy(text("COLOR_", n), text("COLOR_", n + 1), true)) break;
    for (const auto& [name, accessor] : attributes.items())
      if (std::regex_match(name, own_name) && name != "_ILLUMINANCE" && name != "_IRRADIANCE") copy(name, name, false);
    return sets;
  }

  std::optional<std::size_t> values_of(std::size_t accessor, const std::vector<std::uint32_t>& at, bool is_colour) {
    const Json& json = model_.file.element("accessors", accessor);
    const std::string type = text_member(model_.file, json, "type", "accessors");
    const std::size_t n = type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 0;
    if (n == 0) return {};
    auto& values = decoded_[accessor];
    if (values.empty()) values = model_.file.numbers(accessor, type.c_str(), n);
    std::vector<float> chosen;
    chosen.reserve(n * at.size());
    for (const std::uint32_t v : at)
      for (std::size_t k = 0; k < n; ++k) {
        const double x = n * v + k < values.size() ? values[n * v + k] : 0;
        chosen.push_back(static_cast<float>(!std::isfinite(x) ? 0 : is_colour ? std::clamp(x, 0.0, 1.0) : x));
      }
    return glb_.add_floats(chosen, n);
  }

  GlbBuilder& glb_;
  const GltfModel& model_;
  std::span<const LitPart> parts_;
  double exposure_;
  GltfMaterials materials_;
  std::map<std::size_t, std::size_t> index_, cameras_, lamps_;  ///< there, by those of the file
  std::map<std::size_t, std::vector<double>> decoded_;          ///< by accessor
};

/// A node over those of a file, that puts them where the scene has them; none where that is nowhere else.
std::vector<std::size_t> placed(GlbBuilder& glb, std::vector<std::size_t> nodes, const Affine& place,
                                const std::string& name, bool is_alone) {
  const Affine up_again{{Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, -1, 0}}, {}};
  const Affine all = up_again * place;
  const bool stays = all.A == Affine{}.A && all.b == Vec3{};
  if (stays && is_alone) return nodes;
  const std::size_t over = glb.add_over(nodes, name, {});
  if (!stays) {
    std::vector<double> matrix;
    for (int c = 0; c < 3; ++c) matrix.insert(matrix.end(), {all.A[0][c], all.A[1][c], all.A[2][c], 0.0});
    matrix.insert(matrix.end(), {all.b.x, all.b.y, all.b.z, 1.0});
    for (double& x : matrix) x += 0.0;  // no -0
    glb.element("nodes", over)["matrix"] = matrix;
  }
  return {over};
}

}  // namespace

std::vector<std::string> write_model_glb(AtomicFile& file, std::span<const LitModelFile> models,
                                         const BakedNames& names, double exposure) {
  GlbBuilder glb;
  std::vector<std::size_t> top;
  std::vector<std::string> left_out;
  const bool is_alone = models.size() == 1;
  for (const LitModelFile& model : models) {
    std::vector<std::size_t> nodes;
    if (model.gltf) {
      Graft graft(glb, *model.gltf, model.parts, names, exposure);
      nodes = placed(glb, graft.add(), model.gltf->place, model.name, is_alone);
      left_out.insert(left_out.end(), graft.left_out().begin(), graft.left_out().end());
    } else {
      const Vec3 origin = near_origin(model.mesh.position);
      nodes = add_baked_nodes(glb, model.mesh, names, {exposure, {}}, origin);
      if (!is_alone || origin != Vec3{}) nodes = {glb.add_over(nodes, model.name, y_up(origin))};
    }
    top.insert(top.end(), nodes.begin(), nodes.end());
  }
  glb.show(top);
  glb.write(file);
  return left_out;
}

}  // namespace clerestory
