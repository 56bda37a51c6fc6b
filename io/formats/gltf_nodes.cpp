#include "io/formats/gltf_nodes.h"

#include <cmath>

#include "io/text.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

/// p -> T R S p, or the matrix, which glTF stores column by column.
Affine read_transform(const GltfFile& file, const Json& node, const std::string& where) {
  Affine a;
  if (node.contains("matrix")) {
    const std::vector<double> m = finite_numbers(file, node, "matrix", std::vector<double>(16), where);
    for (std::size_t r = 0; r < 3; ++r) a.A[r] = {m[r], m[4 + r], m[8 + r]};
    a.b = {m[12], m[13], m[14]};
    return a;
  }
  const auto t = finite_numbers(file, node, "translation", {0, 0, 0}, where);
  auto q = finite_numbers(file, node, "rotation", {0, 0, 0, 1}, where);
  const auto s = finite_numbers(file, node, "scale", {1, 1, 1}, where);
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(norm > 1e-6 && norm < 1e6)) file.refuse(where + ".rotation is no unit quaternion");
  const double x = q[0] / norm, y = q[1] / norm, z = q[2] / norm, w = q[3] / norm;
  a.A = {Vec3{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
         Vec3{2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
         Vec3{2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  for (Vec3& row : a.A) row = {row.x * s[0], row.y * s[1], row.z * s[2]};
  a.b = {t[0], t[1], t[2]};
  return a;
}

/// Corners of the triangles of a strip or fan, in order, as a list.
std::vector<std::uint32_t> as_triangles(const std::vector<std::uint32_t>& in, std::size_t mode) {
  if (mode == 4) return in;
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < in.size(); ++i) {
    if (mode == 5) out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
    if (mode == 6) out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
  }
  return out;
}

std::vector<std::size_t> index_list(const GltfFile& file, const Json& object, const char* key,
                                    const std::string& where) {
  std::vector<std::size_t> list;
  const auto found = object.find(key);
  if (found == object.end()) return list;
  if (!found->is_array()) file.refuse(text(where, ".", key, " must be an array"));
  for (const Json& index : *found) {
    if (!index.is_number_unsigned()) file.refuse(text(where, ".", key, " must hold whole numbers"));
    list.push_back(index.get<std::size_t>());
  }
  return list;
}

std::vector<std::size_t> root_nodes(const GltfFile& file) {
  if (!file.list("scenes").empty()) {
    const std::size_t scene = whole_number(file, file.root(), "scene", 0, file.name());
    return index_list(file, file.element("scenes", scene), "nodes", text("scenes[", scene, "]"));
  }
  const std::size_t count = file.list("nodes").size();
  std::vector<bool> has_parent(count, false);
  for (std::size_t n = 0; n < count; ++n) {
    for (const std::size_t child : index_list(file, file.element("nodes", n), "children", text("nodes[", n, "]"))) {
      if (child < count) has_parent[child] = true;
    }
  }
  std::vector<std::size_t> roots;
  for (std::size_t n = 0; n < count; ++n) {
    if (!has_parent[n]) roots.push_back(n);
  }
  return roots;
}

}  // namespace

void visit_shown_nodes(const GltfFile& file, const std::function<void(const GltfNode&)>& visit) {
  std::vector<bool> seen(file.list("nodes").size(), false);
  std::vector<GltfNode> open;  // the place is the parent's
  const std::vector<std::size_t> roots = root_nodes(file);
  for (auto root = roots.rbegin(); root != roots.rend(); ++root) open.push_back({*root});
  while (!open.empty()) {
    GltfNode at = open.back();
    open.pop_back();
    const Json& node = file.element("nodes", at.index);
    const std::string where = text("nodes[", at.index, "]");
    if (seen[at.index]) file.refuse(where + " has two parents, or holds itself; nodes must form a tree");
    seen[at.index] = true;
    at.place = at.place * read_transform(file, node, where);
    const std::vector<std::size_t> children = index_list(file, node, "children", where);
    for (auto child = children.rbegin(); child != children.rend(); ++child)
      open.push_back({*child, at.index, at.place});
    visit(at);
  }
}

std::vector<std::uint32_t> triangle_corners(GltfFile& file, const Json& primitive, std::size_t mode, std::size_t n,
                                            const std::string& where) {
  std::vector<std::uint32_t> order;
  if (primitive.contains("indices")) {
    order = file.indices(whole_number(file, primitive, "indices", 0, where));
  } else {
    order.resize(n);
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  }
  file.spend((mode == 4 ? 1 : 3) * order.size(), where);
  std::vector<std::uint32_t> corners = as_triangles(order, mode);
  corners.resize(corners.size() / 3 * 3);
  return corners;
}

}  // namespace clerestory
