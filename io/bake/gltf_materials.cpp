#include "io/bake/gltf_materials.h"

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// What people put on a thing for their own use, and its name.
void copy_name_and_extras(const Json& from, Json& to) {
  if (const auto name = from.find("name"); name != from.end() && name->is_string() && !name->empty() && *name != "")
    to["name"] = *name;
  if (const auto extras = from.find("extras"); extras != from.end() && extras->is_object()) to["extras"] = *extras;
}

std::string mime_type_of(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return "image/png";
  if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
  if (bytes.starts_with("RIFF") && bytes.substr(0, 16).substr(8).starts_with("WEBP")) return "image/webp";
  return {};
}

constexpr const char* kTransform = "KHR_texture_transform";
constexpr const char* kWebp = "EXT_texture_webp";

}  // namespace

std::size_t GltfMaterials::operator()(std::optional<std::size_t> index, std::size_t uv_sets,
                                      const std::optional<std::uint32_t>& of_result) {
  constexpr auto kNone = static_cast<std::size_t>(-1);
  const auto [at, is_new] = materials_.try_emplace({index.value_or(kNone), uv_sets, of_result.value_or(0xffffffff)});
  if (is_new)
    at->second =
        add_unlit(glb_, material(index ? file_.element("materials", *index) : Json::object(), uv_sets, of_result));
  return at->second;
}

Json GltfMaterials::material(const Json& from, std::size_t uv_sets, const std::optional<std::uint32_t>& of_result) {
  static const Json kEmpty = Json::object();
  Json to = Json::object();
  copy_name_and_extras(from, to);
  const auto pbr = from.find("pbrMetallicRoughness");
  const Json& base_from = pbr != from.end() && pbr->is_object() ? *pbr : kEmpty;
  std::vector<double> colour = finite_numbers(file_, base_from, "baseColorFactor", {1, 1, 1, 1}, "materials");
  Json base = {{"metallicFactor", 0}};
  const bool glows = of_result && names_.glows[*of_result];
  if (!glows) copy_texture(base_from, "baseColorTexture", uv_sets, base);
  if (of_result && !base.contains("baseColorTexture")) {
    const Spectrum rho = glows ? Spectrum(1.0) : names_.materials[*of_result].reflectance;
    for (int k = 0; k < 3; ++k) colour[static_cast<std::size_t>(k)] = rho[k];
  }
  for (double& c : colour) c = std::clamp(c, 0.0, 1.0);
  base["baseColorFactor"] = colour;
  to["pbrMetallicRoughness"] = std::move(base);
  const std::string alpha = text_member(file_, from, "alphaMode", "materials");
  if (alpha == "BLEND" || alpha == "MASK") to["alphaMode"] = alpha;
  if (alpha == "MASK" && from.contains("alphaCutoff"))
    to["alphaCutoff"] = std::max(0.0, finite_number(file_, from, "alphaCutoff", 0.5, "materials"));
  return to;
}

void GltfMaterials::copy_texture(const Json& from, const char* key, std::size_t uv_sets, Json& to) {
  const auto info = from.find(key);
  if (info == from.end() || !info->is_object()) return;
  const std::size_t set = whole_number(file_, *info, "texCoord", 0, key);
  const Json& transform = extension(*info, kTransform);
  if (std::max(set, whole_number(file_, transform, "texCoord", 0, key)) >= uv_sets) return;
  const auto index = texture(whole_number(file_, *info, "index", 0, key));
  if (!index) return;
  Json copy = {{"index", *index}};
  if (set > 0) copy["texCoord"] = set;
  if (!transform.empty()) {
    glb_.use(kTransform);
    copy["extensions"][kTransform] = without_extensions(transform);
  }
  to[key] = std::move(copy);
}

std::optional<std::size_t> GltfMaterials::texture(std::size_t index) {
  const auto [at, is_new] = textures_.try_emplace(index);
  if (!is_new) return at->second;
  const Json& from = file_.element("textures", index);
  const Json& webp = extension(from, kWebp);
  const std::size_t source = from.contains("source") ? whole_number(file_, from, "source", 0, "textures")
                                                     : whole_number(file_, webp, "source", 0, "textures");
  std::string type;
  const auto shown = image(source, type);
  if (!shown) return {};
  Json to = Json::object();
  copy_name_and_extras(from, to);
  if (type == "image/webp") {
    glb_.use(kWebp);
    glb_.root()["extensionsRequired"] = {kWebp};
    to["extensions"][kWebp]["source"] = *shown;
  } else {
    to["source"] = *shown;
  }
  if (from.contains("sampler")) {
    const std::size_t sampler = whole_number(file_, from, "sampler", 0, "textures");
    const auto [known, unknown] = samplers_.try_emplace(sampler);
    if (unknown) known->second = glb_.add("samplers", without_extensions(file_.element("samplers", sampler)));
    to["sampler"] = known->second;
  }
  return at->second = glb_.add("textures", std::move(to));
}

std::optional<std::size_t> GltfMaterials::image(std::size_t index, std::string& mime_type) {
  const auto [at, is_new] = images_.try_emplace(index);
  auto& [number, type] = at->second;
  if (is_new) {
    const Json& from = file_.element("images", index);
    const std::string where = text("images[", index, "]"), uri = text_member(file_, from, "uri", where);
    std::string name = text_member(file_, from, "name", where);
    if (name.empty() && !uri.starts_with("data:")) name = percent_decoded(uri);
    try {
      const std::string_view bytes = uri.empty() ? file_.view_bytes(whole_number(file_, from, "bufferView", 0, where))
                                                 : file_.uri_bytes(from["uri"].get_ref<const std::string&>(), where);
      type = mime_type_of(bytes);
      if (!type.empty()) {
        Json to = {{"bufferView", glb_.add_bytes(bytes)}, {"mimeType", type}};
        if (!name.empty()) to["name"] = clean_text(name);
        number = glb_.add("images", std::move(to));
      }
    } catch (const InputError&) {  // as if it were not there
    }
    if (!number) left_out_.push_back(name.empty() ? where : name);
  }
  mime_type = type;
  return number;
}

}  // namespace clerestory
