#include <algorithm>
#include <cctype>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "io/bake/baked_nodes.h"
#include "solver/model/bake_points.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// The triangles of one surface and one material.
class Primitives {
 public:
  Primitives(GlbBuilder& glb, const BakedMesh& mesh, const GlbLook& look, const Vec3& origin)
      : glb_(glb), mesh_(mesh), look_(look), origin_(origin), place_(mesh.position.size(), kNone) {}

  Json add(std::span<const std::uint32_t> triangles, std::size_t material) {
    std::vector<std::uint32_t> vertices, corners;
    for (const std::uint32_t t : triangles)
      for (const std::uint32_t v : mesh_.triangles[t]) {
        if (place_[v] == kNone) place_[v] = static_cast<std::uint32_t>(vertices.size()), vertices.push_back(v);
        corners.push_back(place_[v]);
      }
    for (const std::uint32_t v : vertices) place_[v] = kNone;
    return {{"attributes", attributes(vertices)},
            {"indices", glb_.add_indices(corners, vertices.size())},
            {"material", material}};
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff;

  Json attributes(const std::vector<std::uint32_t>& vertices) {
    std::vector<Vec3> position, normal, irradiance;
    std::vector<float> colour, lux, uv;
    for (const std::uint32_t v : vertices) {
      position.push_back(y_up(mesh_.position[v] - origin_));
      normal.push_back(y_up(mesh_.normal[v]));
      const Spectrum E = mesh_.E[v], shown = mesh_.shown[v] * look_.exposure;
      irradiance.push_back({E[0], E[1], E[2]});
      lux.push_back(mesh_.illuminance[v]);
      for (int k = 0; k < 3; ++k) colour.push_back(static_cast<float>(std::clamp(shown[k], 0.0, 1.0)));
      if (!mesh_.atlas_uv.empty()) uv.insert(uv.end(), mesh_.atlas_uv[v].begin(), mesh_.atlas_uv[v].end());
    }
    Json all = {{"POSITION", glb_.add_positions(position)},
                {"NORMAL", glb_.add_vectors(normal)},
                {"_ILLUMINANCE", glb_.add_floats(lux, 1)},
                {"_IRRADIANCE", glb_.add_vectors(irradiance)}};
    if (look_.lightmap.empty()) all["COLOR_0"] = glb_.add_floats(colour, 3);
    // glTF counts texture coordinates from 0: both sets are the atlas.
    if (!uv.empty()) all["TEXCOORD_0"] = all["TEXCOORD_1"] = glb_.add_floats(uv, 2);
    return all;
  }

  GlbBuilder& glb_;
  const BakedMesh& mesh_;
  const GlbLook& look_;
  Vec3 origin_;
  std::vector<std::uint32_t> place_;  ///< of each vertex in the primitive under way
};

/// A file's name as a URI.
std::string percent_encoded(std::string_view name) {
  constexpr std::string_view kPlain = "-._~", kDigits = "0123456789ABCDEF";
  std::string uri;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < 128 && std::isalnum(byte)) || kPlain.find(c) != kPlain.npos)
      uri += c;
    else
      uri += {'%', kDigits[byte / 16], kDigits[byte % 16]};
  }
  return uri;
}

/// Materials of the file by those of the result, added when they are first used.
class Materials {
 public:
  Materials(GlbBuilder& glb, const BakedNames& names, const GlbLook& look)
      : glb_(glb), names_(names), index_(names.materials.size()), as_extension_(look.lightmap_extension) {
    if (look.lightmap.empty()) return;
    // No smaller copies: charts are but a texel apart in them.
    const std::size_t sampler = glb.add(
        "samplers", {{"magFilter", kLinear}, {"minFilter", kLinear}, {"wrapS", kClampToEdge}, {"wrapT", kClampToEdge}});
    const std::size_t image = glb.add("images", {{"uri", percent_encoded(look.lightmap)}});
    const std::size_t texture = glb.add("textures", {{"sampler", sampler}, {"source", image}});
    texture_ = {{"index", texture}, {"texCoord", 1}};
  }
  std::size_t operator()(std::uint32_t material) {
    std::optional<std::size_t>& index = index_[material];
    if (!index) index = add(names_.materials[material], names_.glows[material]);
    return *index;
  }

 private:
  std::size_t add(const Material& material, bool glows) {
    Json base = {{"metallicFactor", 0}};
    const Spectrum rho = glows ? Spectrum(1.0) : material.reflectance;
    base["baseColorFactor"] = {rho[0], rho[1], rho[2], 1};
    if (!texture_.empty() && !as_extension_) base["baseColorTexture"] = texture_;
    Json json = {{"pbrMetallicRoughness", std::move(base)}};
    if (!material.name.empty()) json["name"] = material.name;
    // Not both: a viewer that knows lightmaps lights the material by it alone, in a scene without lights.
    if (!as_extension_) return add_unlit(glb_, std::move(json));
    json["extensions"][kLightmap] = texture_;
    json["extensions"][kLightmap]["intensity"] = 1;
    glb_.use(kLightmap);
    return glb_.add("materials", std::move(json));
  }

  static constexpr const char* kLightmap = "MOZ_lightmap";
  static constexpr int kLinear = 9729, kClampToEdge = 33071;
  GlbBuilder& glb_;
  const BakedNames& names_;
  std::vector<std::optional<std::size_t>> index_;
  bool as_extension_;
  Json texture_;  ///< empty: none
};

}  // namespace

BakedNames names_of(const WrittenResult& result) {
  return {result.surfaces, result.materials, glowing_materials(result)};
}

std::size_t add_unlit(GlbBuilder& glb, Json material) {
  constexpr const char* kUnlit = "KHR_materials_unlit";
  glb.use(kUnlit);
  material["extensions"][kUnlit] = Json::object();
  return glb.add("materials", std::move(material));
}

std::vector<float> shown_colours(const Field& shown, double exposure) {
  std::vector<float> colours;
  colours.reserve(3 * shown.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const Spectrum colour = shown[i] * exposure;
    for (int k = 0; k < 3; ++k) colours.push_back(static_cast<float>(std::clamp(colour[k], 0.0, 1.0)));
  }
  return colours;
}

std::vector<std::size_t> add_baked_nodes(GlbBuilder& glb, const BakedMesh& mesh, const BakedNames& names,
                                         const GlbLook& look, const Vec3& origin) {
  Materials materials(glb, names, look);
  Primitives primitives(glb, mesh, look, origin);
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t t) { return std::pair(mesh.surface[t], mesh.material[t]); };
  std::ranges::stable_sort(order, {}, key);
  std::vector<std::size_t> nodes;
  for (std::size_t begin = 0; begin < order.size();) {
    const std::uint32_t surface = mesh.surface[order[begin]];
    Json list = Json::array();
    for (std::size_t end = begin; begin < order.size() && mesh.surface[order[begin]] == surface; begin = end) {
      while (end < order.size() && key(order[end]) == key(order[begin])) ++end;
      list.push_back(
          primitives.add(std::span(order).subspan(begin, end - begin), materials(mesh.material[order[begin]])));
    }
    Json shape = {{"primitives", std::move(list)}, {"extras", {{"exposure", look.exposure}}}}, node = Json::object();
    if (const std::string& name = names.surfaces[surface]; !name.empty()) shape["name"] = node["name"] = name;
    node["mesh"] = glb.add("meshes", std::move(shape));
    nodes.push_back(glb.add("nodes", std::move(node)));
  }
  return nodes;
}

void write_baked_glb(AtomicFile& file, const BakedMesh& mesh, const BakedNames& names, const GlbLook& look) {
  GlbBuilder glb;
  const Vec3 origin = near_origin(mesh.position);
  std::vector<std::size_t> nodes = add_baked_nodes(glb, mesh, names, look, origin);
  if (origin != Vec3{}) nodes = {glb.add_over(nodes, "origin", y_up(origin))};
  glb.show(nodes);
  glb.write(file);
}

}  // namespace clerestory
