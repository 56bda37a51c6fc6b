#include "io/bake/glb_builder.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <set>

#include "solver/model/version.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF numbers are little-endian");

constexpr int kFloat = 5126, kUint16 = 5123, kUint32 = 5125;
constexpr int kVertices = 34962, kIndices = 34963;  // targets of views
constexpr const char* kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};

template <class Number>
std::string_view bytes_of(const std::vector<Number>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)};
}

std::vector<float> floats_of(const std::vector<Vec3>& vectors) {
  std::vector<float> values;
  values.reserve(3 * vectors.size());
  for (const Vec3& v : vectors)
    for (int k = 0; k < 3; ++k) values.push_back(static_cast<float>(v[k]));
  return values;
}

void append(std::string& bytes, std::uint32_t value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace

GlbBuilder::GlbBuilder() {
  root_["asset"] = {{"version", "2.0"}, {"generator", "Clerestory " + std::string(kVersion)}};
}

std::size_t GlbBuilder::add(const char* list, Json element) {
  Json& all = root_[list];
  all.push_back(std::move(element));
  return all.size() - 1;
}

void GlbBuilder::use(const std::string& extension) {
  Json& used = root_["extensionsUsed"];
  if (std::find(used.begin(), used.end(), extension) == used.end()) used.push_back(extension);
}

std::size_t GlbBuilder::add_view(std::string_view bytes, int target) {
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
  if (target) view["target"] = target;
  binary_ += bytes;
  return add("bufferViews", std::move(view));
}

std::size_t GlbBuilder::add_accessor(Json accessor, std::string_view bytes, int target) {
  accessor["bufferView"] = add_view(bytes, target);
  return add("accessors", std::move(accessor));
}

std::size_t GlbBuilder::add_floats(const std::vector<float>& values, std::size_t components) {
  return add_accessor({{"componentType", kFloat}, {"count", values.size() / components}, {"type", kTypes[components]}},
                      bytes_of(values), kVertices);
}

std::size_t GlbBuilder::add_vectors(const std::vector<Vec3>& vectors) { return add_floats(floats_of(vectors), 3); }

std::size_t GlbBuilder::add_positions(const std::vector<Vec3>& positions) {
  const std::vector<float> values = floats_of(positions);
  const std::size_t accessor = add_floats(values, 3);
  std::array<float, 3> least, most;
  least.fill(std::numeric_limits<float>::infinity());
  most.fill(-std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < values.size(); ++i) {
    least[i % 3] = std::min(least[i % 3], values[i]);
    most[i % 3] = std::max(most[i % 3], values[i]);
  }
  Json& json = element("accessors", accessor);
  json["min"] = least, json["max"] = most;
  return accessor;
}

std::size_t GlbBuilder::add_indices(const std::vector<std::uint32_t>& corners, std::size_t vertex_count) {
  Json accessor = {{"count", corners.size()}, {"type", "SCALAR"}};
  if (vertex_count < 65536) {  // the last number would restart a primitive
    const std::vector<std::uint16_t> small(corners.begin(), corners.end());
    accessor["componentType"] = kUint16;
    return add_accessor(std::move(accessor), bytes_of(small), kIndices);
  }
  accessor["componentType"] = kUint32;
  return add_accessor(std::move(accessor), bytes_of(corners), kIndices);
}

std::size_t GlbBuilder::add_bytes(std::string_view bytes) { return add_view(bytes, 0); }

std::size_t GlbBuilder::add_over(const std::vector<std::size_t>& nodes, const std::string& name, const Vec3& origin) {
  Json node = Json::object();
  if (!name.empty()) node["name"] = name;
  if (origin != Vec3{}) node["translation"] = {origin.x, origin.y, origin.z};
  if (!nodes.empty()) node["children"] = nodes;
  return add("nodes", std::move(node));
}

void GlbBuilder::show(const std::vector<std::size_t>& nodes) {
  Json scene = Json::object();
  if (!nodes.empty()) scene["nodes"] = nodes;
  root_["scene"] = add("scenes", std::move(scene));
}

void GlbBuilder::write(AtomicFile& file) {
  binary_.resize((binary_.size() + 3) / 4 * 4, '\0');
  if (!binary_.empty()) root_["buffers"] = {{{"byteLength", binary_.size()}}};
  std::string json = root_.dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint64_t size = 12 + 8 + json.size() + (binary_.empty() ? 0 : 8 + binary_.size());
  if (size > std::numeric_limits<std::uint32_t>::max())
    file.refuse("more than 4 GiB, which is all that a .glb can hold; write .ply");
  std::string head = "glTF";
  append(head, 2);
  append(head, static_cast<std::uint32_t>(size));
  append(head, static_cast<std::uint32_t>(json.size()));
  file.write(head + "JSON" + json);
  if (binary_.empty()) return;
  head.clear();
  append(head, static_cast<std::uint32_t>(binary_.size()));
  file.write(head + std::string("BIN\0", 4));
  file.write(binary_);
}

Json without_extensions(Json thing) {
  if (thing.is_object()) thing.erase("extensions");
  for (Json& part : thing)
    if (part.is_structured()) part = without_extensions(std::move(part));
  return thing;
}

}  // namespace clerestory
