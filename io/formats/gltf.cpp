// glTF 2.0: nodes, meshes, materials, lights (KHR_lights_punctual, EXT_lights_ies, KHR_materials_emissive_strength), in
// double where the file is. Read here and not by Assimp 5.2, which knows no emissive strength and keeps one node a
// light.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "io/find_file.h"
#include "io/formats/add_mesh.h"
#include "io/formats/gltf_file.h"
#include "io/formats/gltf_nodes.h"
#include "io/formats/ies.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr double kBrightest = 1e15;  // intensities beyond are mistakes

Spectrum to_spectrum(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

void check_range(const GltfFile& file, const Spectrum& s, double most, const std::string& where) {
  if (s.min() < 0 || s.max() > most) {
    file.refuse(text(where, " = [", s[0], ", ", s[1], ", ", s[2], "] is outside [0, ", most, "]"));
  }
}

/// The diffuse reflectance is the base colour; a metal reflects as much, only not diffusely.
///
/// texture(object, "baseColorTexture")  index in Model::textures of what a member of that name shows, if there is one
template <class TextureOf>
ModelMaterial read_material(const GltfFile& file, const Json& json, std::size_t index, const TextureOf& texture) {
  const std::string where = text("materials[", index, "]");
  ModelMaterial to;
  to.material.name = text_member(file, json, "name", where);
  if (to.material.name.empty()) to.material.name = text("material ", index);

  static const Json kEmpty = Json::object();
  const auto pbr = json.find("pbrMetallicRoughness");
  const Json& base = pbr != json.end() && pbr->is_object() ? *pbr : kEmpty;
  std::vector<double> colour =
      finite_numbers(file, base, "baseColorFactor", {1, 1, 1, 1}, where + ".pbrMetallicRoughness");
  to.texture = texture(base, "baseColorTexture");
  to.glow_texture = texture(json, "emissiveTexture");
  to.described = to.texture || base.contains("baseColorFactor");
  const Json& old_style = extension(json, "KHR_materials_pbrSpecularGlossiness");
  if (!old_style.empty() && base.empty()) {
    colour = finite_numbers(file, old_style, "diffuseFactor", {1, 1, 1, 1}, where);
    to.texture = texture(old_style, "diffuseTexture");
    to.described = to.texture || old_style.contains("diffuseFactor");
  }
  to.material.reflectance = to_spectrum(colour);
  check_range(file, to.material.reflectance, kBrightest, where + ".baseColorFactor");

  // emissiveFactor x emissiveStrength is a luminance [cd/m2]; of each channel's share, as of grey, 179 lm make a watt.
  const Spectrum glow = to_spectrum(finite_numbers(file, json, "emissiveFactor", {0, 0, 0}, where));
  const double strength =
      finite_number(file, extension(json, "KHR_materials_emissive_strength"), "emissiveStrength", 1, where);
  const Spectrum luminance = glow * strength;
  check_range(file, luminance, kBrightest, where + ": emissiveFactor x emissiveStrength");
  to.material.exitance = luminance * (std::numbers::pi / kWhiteEfficacy);

  const double passes =
      finite_number(file, extension(json, "KHR_materials_transmission"), "transmissionFactor", 0, where);
  if (text_member(file, json, "alphaMode", where) == "BLEND") {
    apply_opacity(to.material, colour[3]);
  } else if (passes > 0.5) {
    to.material.kind = MaterialKind::glass;
    for (int k = 0; k < kMaxChannels; ++k)
      to.material.transmittance[k] = std::min(1.0, passes * to.material.reflectance[k]);
    to.material.exitance = Spectrum(0.0);
  }
  // Where neither is said glTF means a rough metal, and nobody does; what a texture says of them is not read.
  if (old_style.empty() && (base.contains("metallicFactor") || base.contains("roughnessFactor")) &&
      !base.contains("metallicRoughnessTexture")) {
    // 0.04 is what glTF takes for all that is no metal; its roughness is that of a lobe.
    constexpr double kDielectric = 0.04;
    const auto share = [&](const char* key) { return std::clamp(finite_number(file, base, key, 1, where), 0.0, 1.0); };
    const double metal = share("metallicFactor");
    to.gloss = ModelGloss{Spectrum(kDielectric * (1 - metal)), metal, {}, share("roughnessFactor")};
  }
  // Where the file says nothing, glTF's default is white, which no surface is.
  to.described = to.described || !to.material.receives();
  if (!to.described) to.material.reflectance = Spectrum(0.5);
  return to;
}

/// Of vertices that primitives share, each takes its own when they are few: a node that shows a triangle then costs
/// three vertices, and not all there are. Corners without a vertex stay so.
void take_vertices(const std::vector<Vec3>& shared, LocalMesh& mesh) {
  const auto is_there = [&](std::uint32_t v) { return v < shared.size(); };
  if (mesh.corner.size() >= shared.size() / 8 || !std::all_of(mesh.corner.begin(), mesh.corner.end(), is_there)) {
    mesh.vertices = shared;
    return;
  }
  std::unordered_map<std::uint32_t, std::uint32_t> place;
  for (std::uint32_t& corner : mesh.corner) {
    const auto [at, is_new] = place.try_emplace(corner, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) {
      mesh.vertices.push_back(shared[corner]);
      mesh.number.push_back(corner);
    }
    corner = at->second;
  }
}

class GltfReader {
 public:
  explicit GltfReader(const std::filesystem::path& path)
      : file_(path), folder_(path.parent_path()), stem_(path.stem().string()) {}

  Model read() {
    model_.metres_per_unit = 1.0;
    model_.up = Up::y;
    for (const std::string& name : file_.file_names())
      model_.files.push_back(finder_.file(folder_, name).value_or(folder_ / name));
    check_extensions();
    for (std::size_t m = 0; m < file_.list("materials").size(); ++m) {
      model_.materials.push_back(
          read_material(file_, file_.element("materials", m), m,
                        [&](const Json& object, const char* key) { return texture_of(object, key); }));
    }
    no_material_ = MaterialId(model_.materials.size());
    ModelMaterial& none = model_.materials.emplace_back();
    none.material.name = kDefaultMaterial;
    none.described = false;
    read_nodes();
    if (left_out_ > 0) model_.warnings.push_back(text(left_out_, " primitives of points or lines are left out"));
    if (skinned_) model_.warnings.push_back("skinned meshes are taken as they are stored, without their skeleton");
    if (model_.polygons.face_count() == 0) file_.refuse(std::string(kNoFaces));
    return std::move(model_);
  }

 private:
  void check_extensions() {
    for (const Json& name : file_.list("extensionsRequired")) {
      if (!name.is_string()) continue;
      if (name == "KHR_draco_mesh_compression" || name == "EXT_meshopt_compression") {
        file_.refuse(text("is compressed (", name.get<std::string>(), "); export it without mesh compression"));
      }
      if (name == "EXT_mesh_gpu_instancing") {
        file_.refuse("uses EXT_mesh_gpu_instancing, which is not read; export the instances as nodes");
      }
    }
  }

  /// Index in Model::textures of what the member `key` shows; nothing where there is no such member.
  std::optional<std::size_t> texture_of(const Json& object, const char* key) {
    const auto info = object.find(key);
    if (info == object.end()) return std::nullopt;
    const std::size_t image = image_of(*info);
    const auto [at, is_new] = texture_by_image_.try_emplace(image, model_.textures.size());
    if (is_new) model_.textures.push_back(read_image(image));
    return at->second;
  }

  /// Of what is there of images, the one that a texture shows; a number that none has when that is damaged.
  std::size_t image_of(const Json& info) const {
    constexpr auto kNone = static_cast<std::size_t>(-1);
    const auto index = [](const Json& object, const char* key) {
      return object.is_object() && object.contains(key) && object[key].is_number_unsigned()
                 ? object[key].get<std::size_t>()
                 : kNone;
    };
    const Json& textures = file_.list("textures");
    const std::size_t texture = index(info, "index");
    if (texture >= textures.size()) return kNone;
    // In a newer form that is read perhaps, else in the one that all programs know.
    const std::size_t webp = index(extension(textures[texture], "EXT_texture_webp"), "source");
    return webp < file_.list("images").size() ? webp : index(textures[texture], "source");
  }

  ModelTexture read_image(std::size_t index) {
    const Json& images = file_.list("images");
    const std::string where = text("images[", index, "]");
    if (index >= images.size() || !images[index].is_object()) return {"a texture that the file does not hold", {}, {}};
    const Json& image = images[index];
    ModelTexture texture{text_member(file_, image, "name", where), {}, {}};
    const std::string uri = text_member(file_, image, "uri", where);
    const bool is_inside = uri.empty() || uri.starts_with("data:");
    if (!is_inside) texture.name = percent_decoded(uri.substr(uri.find_last_of("/\\") + 1));
    if (texture.name.empty()) texture.name = where;
    try {
      if (!is_inside) {
        auto found = finder_.file(folder_, uri);
        if (!found) found = finder_.file(folder_, percent_decoded(uri));
        if (found) texture.file = *found, model_.files.push_back(*found);
      } else if (!uri.empty()) {
        texture.bytes = file_.uri_bytes(image["uri"].get_ref<const std::string&>(), where);
      } else if (image.contains("bufferView")) {
        texture.bytes = file_.view_bytes(whole_number(file_, image, "bufferView", 0, where));
      }
    } catch (const InputError&) {  // damaged: as if it were not there
    }
    return texture;
  }

  void read_nodes() {
    visit_shown_nodes(file_, [&](const GltfNode& at) {
      const Json& node = file_.element("nodes", at.index);
      const std::string where = text("nodes[", at.index, "]");
      if (node.contains("mesh")) show_mesh(node, whole_number(file_, node, "mesh", 0, where), at.place, where);
      const Json& light = extension(node, "KHR_lights_punctual");
      if (light.contains("light")) add_light(whole_number(file_, light, "light", 0, where), at.place, node, where);
      const Json& profile = extension(node, "EXT_lights_ies");
      if (profile.contains("light")) add_light_profile(profile, at.place, node, where);
    });
  }

  void show_mesh(const Json& node, std::size_t index, const Affine& place, const std::string& where) {
    const Json& mesh = file_.element("meshes", index);
    const std::string mesh_place = text("meshes[", index, "]");
    std::string name = text_member(file_, node, "name", where);
    if (name.empty()) name = text_member(file_, mesh, "name", mesh_place);
    const SurfaceId surface(model_.surfaces.size());
    model_.surfaces.push_back(names_.take(name.empty() ? stem_ : name));
    skinned_ = skinned_ || node.contains("skin");
    for (const LocalMesh& part : primitives(mesh, index, mesh_place)) {
      // Vertices cost as well, even where few of them carry faces.
      faces_ += std::max(part.face_begin.size() - 1, part.vertices.size() / 8);
      if (faces_ > kMaxFaces) file_.refuse(text("more than ", kMaxFaces, " faces; leave out what light does not need"));
      file_.spend(part.vertices.size() + part.corner.size(), where);
      add_mesh(model_, part, place, surface, file_.name());
    }
  }

  /// The mesh decoded, once however often it is shown.
  const std::vector<LocalMesh>& primitives(const Json& mesh, std::size_t index, const std::string& mesh_place) {
    const auto [at, is_new] = decoded_.try_emplace(index);
    if (!is_new) return at->second;
    const auto list = mesh.find("primitives");
    if (list == mesh.end() || !list->is_array()) file_.refuse(mesh_place + " has no primitives");
    for (std::size_t p = 0; p < list->size(); ++p) {
      const Json& primitive = (*list)[p];
      const std::string where = text(mesh_place, ".primitives[", p, "]");
      if (!primitive.is_object()) file_.refuse(where + " must be an object");
      if (!extension(primitive, "KHR_draco_mesh_compression").empty()) {
        file_.refuse(where + " is compressed (Draco); export it without mesh compression");
      }
      const std::size_t mode = whole_number(file_, primitive, "mode", 4, where);
      if (mode < 4) {
        ++left_out_;
        continue;
      }
      if (mode > 6) file_.refuse(text(where, ".mode = ", mode, " is outside [0, 6]"));
      if (auto part = decode(primitive, mode, where)) at->second.push_back(std::move(*part));
    }
    return at->second;
  }

  std::optional<LocalMesh> decode(const Json& primitive, std::size_t mode, const std::string& where) {
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object() || !attributes->contains("POSITION"))
      return std::nullopt;
    LocalMesh mesh;
    const std::vector<Vec3>& vertices =
        file_.positions(whole_number(file_, *attributes, "POSITION", 0, where + ".attributes"));
    mesh.corner = triangle_corners(file_, primitive, mode, vertices.size(), where);
    take_vertices(vertices, mesh);
    file_.spend(mesh.vertices.size(), where);
    for (std::size_t c = 3; c <= mesh.corner.size(); c += 3) mesh.face_begin.push_back(static_cast<std::uint32_t>(c));
    mesh.material = no_material_;
    if (primitive.contains("material")) {
      const std::size_t material = whole_number(file_, primitive, "material", 0, where);
      file_.element("materials", material);
      mesh.material = MaterialId(material);
    }
    return mesh;
  }

  /// Intensities are in candela, of a directional light in lux.
  void add_light(std::size_t index, const Affine& place, const Json& node, const std::string& where) {
    const Json& all = extension(file_.root(), "KHR_lights_punctual");
    const auto list = all.find("lights");
    if (list == all.end() || !list->is_array() || index >= list->size() || !(*list)[index].is_object()) {
      file_.refuse(text(where, " uses light ", index, ", which is not there"));
    }
    const Json& light = (*list)[index];
    const std::string of_light = text("lights[", index, "]");
    const Spectrum colour = to_spectrum(finite_numbers(file_, light, "color", {1, 1, 1}, of_light));
    const Spectrum photometric_intensity = colour * finite_number(file_, light, "intensity", 1, of_light);
    check_range(file_, photometric_intensity, kBrightest, of_light + ": color x intensity");
    const Spectrum intensity = photometric_intensity / kWhiteEfficacy;
    std::string name = text_member(file_, node, "name", where);
    if (name.empty()) name = text_member(file_, light, "name", of_light);
    if (!is_finite(place.b) ||
        std::max({std::abs(place.b.x), std::abs(place.b.y), std::abs(place.b.z)}) > kLargestCoordinate) {
      file_.refuse(where + ": its light stands outside [-1e12, 1e12]");
    }
    const Vec3 aim = place.direction({0, 0, -1});
    const std::string type = text_member(file_, light, "type", of_light);
    if (type != "point" && !(length(aim) > 0 && std::isfinite(length(aim))))
      file_.refuse(where + ": its light has no direction");
    if (type == "point") {
      model_.lights.luminaires.push_back({name, place.b, {}, PointLuminaire{intensity * (4 * std::numbers::pi)}});
    } else if (type == "spot") {
      const auto cone = light.find("spot");
      static const Json kEmpty = Json::object();
      const Json& spot = cone != light.end() && cone->is_object() ? *cone : kEmpty;
      const double inner = finite_number(file_, spot, "innerConeAngle", 0, of_light);
      const double outer = finite_number(file_, spot, "outerConeAngle", std::numbers::pi / 4, of_light);
      if (!(inner >= 0 && inner < outer && outer <= std::numbers::pi / 2 + 1e-6)) {
        file_.refuse(
            text(of_light, ": cone angles ", inner, " and ", outer, " are outside 0 <= inner < outer <= pi/2"));
      }
      model_.lights.luminaires.push_back({name, place.b, {}, SpotLuminaire{normalized(aim), intensity, inner, outer}});
    } else if (type == "directional") {
      model_.lights.suns.push_back({-normalized(aim), intensity});
    } else {
      file_.refuse(text(of_light, ".type '", quotable(type), "' is not known; known are point, spot, directional"));
    }
  }

  /// EXT_lights_ies: V = H = 0 of the file along -z of the node, its photometric plane H = 0 through x. The profile's
  /// opening counts as in a scene file; the extension speaks of points.
  void add_light_profile(const Json& instance, const Affine& place, const Json& node, const std::string& where) {
    const std::string of_light = where + ".extensions.EXT_lights_ies";
    const auto web = light_profile(whole_number(file_, instance, "light", 0, of_light), of_light);
    const double multiplier = finite_number(file_, instance, "multiplier", 1, of_light);
    const Spectrum colour = to_spectrum(finite_numbers(file_, instance, "color", {1, 1, 1}, of_light));
    check_range(file_, colour * (multiplier * peak_candela(*web)), kBrightest, of_light + ": color x multiplier");
    if (!is_finite(place.b) ||
        std::max({std::abs(place.b.x), std::abs(place.b.y), std::abs(place.b.z)}) > kLargestCoordinate) {
      file_.refuse(where + ": its light stands outside [-1e12, 1e12]");
    }
    const Vec3 back = normalized(place.direction({0, 0, 1})), side = place.direction({1, 0, 0});
    const Vec3 x = normalized(side - back * dot(side, back));
    if (!(length(back) > 0 && length(x) > 0)) file_.refuse(where + ": its light has no direction");
    WebLuminaire luminaire{web, {x, cross(back, x), back}, {}};
    if (web->type == WebType::A)
      luminaire.axes = {-back, luminaire.axes.y, x};  // the beam is x then, and V goes up to z
    luminaire.scale = colour * (multiplier / kWhiteEfficacy);
    model_.lights.luminaires.push_back({text_member(file_, node, "name", where), place.b, {}, std::move(luminaire)});
  }

  std::shared_ptr<const PhotometricWeb> light_profile(std::size_t index, const std::string& where) {
    auto& web = profiles_[index];
    if (web) return web;
    const Json& all = extension(file_.root(), "EXT_lights_ies");
    const auto list = all.find("lights");
    if (list == all.end() || !list->is_array() || index >= list->size() || !(*list)[index].is_object())
      file_.refuse(text(where, " uses light ", index, ", which is not there"));
    const Json& light = (*list)[index];
    const std::string of_light = text("EXT_lights_ies.lights[", index, "]");
    const bool has_uri = !text_member(file_, light, "uri", of_light).empty();
    if (!has_uri && !light.contains("bufferView")) file_.refuse(of_light + " has neither a uri nor a bufferView");
    const std::string_view bytes = has_uri ? file_.uri_bytes(light["uri"].get_ref<const std::string&>(), of_light)
                                           : file_.view_bytes(whole_number(file_, light, "bufferView", 0, of_light));
    auto& of_bytes = parsed_[bytes.data()];
    if (of_bytes.second && of_bytes.first == bytes.size()) return web = of_bytes.second;
    file_.spend(bytes.size(), of_light);
    try {
      web = std::make_shared<const PhotometricWeb>(parse_ies(bytes, of_light, folder_, model_.warnings, &model_.files));
      of_bytes = {bytes.size(), web};
    } catch (const InputError& error) {
      file_.refuse(error.what());
    }
    return web;
  }

  GltfFile file_;
  std::filesystem::path folder_;
  std::map<std::size_t, std::shared_ptr<const PhotometricWeb>> profiles_;                        // by light
  std::map<const char*, std::pair<std::size_t, std::shared_ptr<const PhotometricWeb>>> parsed_;  // by where they are
  std::map<std::size_t, std::size_t> texture_by_image_;
  FileFinder finder_;
  std::string stem_;
  Model model_;
  UniqueNames names_;
  std::unordered_map<std::size_t, std::vector<LocalMesh>> decoded_;
  MaterialId no_material_;
  std::size_t left_out_ = 0, faces_ = 0;
  bool skinned_ = false;
};

}  // namespace

Model read_gltf(const std::filesystem::path& file) { return GltfReader(file).read(); }

}  // namespace clerestory
