#include "io/bake/gltf_model.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr double kSmoothIfSaid = 0.5;  ///< where a vertex has one normal its facets are one up to 60 degrees

Affine affine_of(const std::array<double, 12>& rows) {
  Affine a;
  for (std::size_t r = 0; r < 3; ++r) a.A[r] = {rows[4 * r], rows[4 * r + 1], rows[4 * r + 2]};
  a.b = {rows[3], rows[7], rows[11]};
  return a;
}

/// Translation, rotation and scale make it, in this order: its columns are at right angles.
bool is_for_node(const Affine& a) {
  constexpr double kRight = 1e-7;
  for (int j = 0; j < 3; ++j) {
    const Vec3 u{a.A[0][j], a.A[1][j], a.A[2][j]};
    const int k = (j + 1) % 3;
    const Vec3 v{a.A[0][k], a.A[1][k], a.A[2][k]};
    if (!(std::abs(dot(u, v)) < kRight * length(u) * length(v))) return false;
  }
  return true;
}

/// The vertices that corners use, in their order; corners become places in those. Of a few corners among many vertices,
/// which a thousand primitives may share, only the few are looked at.
std::vector<std::uint32_t> take_vertices_of(std::vector<std::uint32_t>& corners, std::size_t n) {
  std::vector<std::uint32_t> used;
  if (corners.size() < n / 8) {
    used = corners;
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& c : corners) c = static_cast<std::uint32_t>(std::ranges::lower_bound(used, c) - used.begin());
    return used;
  }
  std::vector<std::uint32_t> place(n, 0);
  for (const std::uint32_t c : corners) place[c] = 1;
  for (std::uint32_t v = 0; v < n; ++v)
    if (place[v]) {
      place[v] = static_cast<std::uint32_t>(used.size());
      used.push_back(v);
    }
  for (std::uint32_t& c : corners) c = place[c];
  return used;
}

}  // namespace

GltfModel::GltfModel(const std::filesystem::path& path, const Affine& of_file) : file(path), place(of_file) {
  visit_shown_nodes(file, [&](const GltfNode& node) {
    nodes.push_back(node);
    add_parts(node);
  });
}

void GltfModel::add_parts(const GltfNode& node) {
  const Json& json = file.element("nodes", node.index);
  const std::string where = text("nodes[", node.index, "]");
  if (!json.contains("mesh")) return;
  const std::size_t mesh = whole_number(file, json, "mesh", 0, where);
  const Json& shape = file.element("meshes", mesh);
  const Affine to_scene = place * node.place;
  std::string name = text_member(file, json, "name", where);
  if (name.empty()) name = text_member(file, shape, "name", text("meshes[", mesh, "]"));
  const Json& primitives = shape.at("primitives");
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    const Json& primitive = primitives[p];
    const std::string place_of = text("meshes[", mesh, "].primitives[", p, "]");
    const std::size_t mode = whole_number(file, primitive, "mode", 4, place_of);
    const auto attributes = primitive.find("attributes");
    if (mode < 4 || attributes == primitive.end() || !attributes->contains("POSITION")) continue;
    const std::vector<Vec3>& positions = file.positions(whole_number(file, *attributes, "POSITION", 0, place_of));
    std::vector<std::uint32_t> corners = triangle_corners(file, primitive, mode, positions.size(), place_of);
    if (corners.empty()) continue;

    for (const std::uint32_t c : corners)
      if (c >= positions.size()) file.refuse(text(place_of, ": vertex ", c, " is not there"));
    Source source{node.index, mesh, p, take_vertices_of(corners, positions.size()), to_scene};
    ModelPart part;
    part.name = name;
    part.sharp_cosine = attributes->contains("NORMAL") ? kSmoothIfSaid : part.sharp_cosine;
    for (const std::uint32_t v : source.vertex) part.position.push_back(to_scene.point(positions[v]));
    file.spend(part.position.size() + corners.size(), place_of);
    for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
      std::array<std::uint32_t, 3> triangle{corners[c], corners[c + 1], corners[c + 2]};
      if (to_scene.mirrors()) std::swap(triangle[0], triangle[2]);  // fronts stay fronts
      part.triangles.push_back(triangle);
    }
    parts.push_back(std::move(part));
    sources.push_back(std::move(source));
  }
}

std::shared_ptr<const GltfModel> read_gltf_again(const PlacedModel& model) {
  const std::string extension = to_lower(model.file.extension().string());
  const Affine place = affine_of(model.place);
  if ((extension != ".gltf" && extension != ".glb") || !is_for_node(place)) return {};
  return std::make_shared<GltfModel>(model.file, place);
}

const std::vector<ModelPart>& parts_of(const GltfModel& model) { return model.parts; }

}  // namespace clerestory
