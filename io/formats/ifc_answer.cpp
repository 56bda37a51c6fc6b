#include "io/formats/ifc_answer.h"

#include <cstring>

#include <nlohmann/json.hpp>

#include "io/formats/add_mesh.h"
#include "io/formats/ifc_lights.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kStart = "CLIFC001";
enum Tag : std::uint32_t { kProgress = 1, kMesh = 2, kSpace = 3, kEnd = 4 };

struct Record {
  std::uint32_t tag = 0;
  std::string_view bytes;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  std::string_view take(std::uint64_t n) {
    if (n > rest_.size()) throw std::runtime_error("the answer is cut off");
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }
  template <class T>
  T number() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> numbers(std::uint64_t n) {
    if (n > rest_.size() / sizeof(T)) throw std::runtime_error("the answer is cut off");
    std::vector<T> values(n);
    const std::string_view from = take(n * sizeof(T));
    if (n > 0) std::memcpy(values.data(), from.data(), from.size());
    return values;
  }
  Record record() {
    Record record;
    record.tag = number<std::uint32_t>();
    number<std::uint32_t>();
    record.bytes = take(number<std::uint64_t>());
    return record;
  }
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

struct PlacedMesh {
  std::uint32_t owner = 0, material = 0;
  Affine place;
  LocalMesh mesh;
};

/// web-ifc computes in double and hands out floats around the middle of each shape; of round sizes nothing is lost by
/// that.
PlacedMesh read_mesh(std::string_view bytes) {
  Reader reader(bytes);
  PlacedMesh read;
  read.owner = reader.number<std::uint32_t>();
  read.material = reader.number<std::uint32_t>();
  const auto vertices = reader.number<std::uint32_t>(), corners = reader.number<std::uint32_t>();
  const std::vector<double> m = reader.numbers<double>(12);
  for (std::size_t r = 0; r < 3; ++r) read.place.A[r] = {m[4 * r], m[4 * r + 1], m[4 * r + 2]};
  read.place.b = {m[3], m[7], m[11]};
  const std::vector<float> xyz = reader.numbers<float>(3 * std::uint64_t{vertices});
  LocalMesh& mesh = read.mesh;
  mesh.corner = reader.numbers<std::uint32_t>(corners);
  if (!reader.at_end()) throw std::runtime_error("a mesh of the answer is too long");
  mesh.vertices.reserve(vertices);
  for (std::size_t v = 0; v < vertices; ++v)
    mesh.vertices.push_back({as_written(xyz[3 * v]), as_written(xyz[3 * v + 1]), as_written(xyz[3 * v + 2])});
  mesh.corner.resize(corners - corners % 3);
  for (std::uint32_t end = 3; end <= mesh.corner.size(); end += 3) mesh.face_begin.push_back(end);
  return read;
}

/// A member of `of`, or nothing when it is missing or null.
const Json* member(const Json& of, const char* key) {
  const auto found = of.is_object() ? of.find(key) : of.end();
  return of.is_object() && found != of.end() && !found->is_null() ? &*found : nullptr;
}

std::string word(const Json& of, const char* key) {
  const Json* value = member(of, key);
  return value && value->is_string() ? clean_text(value->get<std::string>()) : "";
}

std::optional<Spectrum> shares(const Json& of, const char* key) {
  const Json* value = member(of, key);
  if (!value) return std::nullopt;
  const auto share = [](const Json& x) { return std::clamp(x.get<double>(), 0.0, 1.0); };
  if (value->is_number()) return Spectrum(share(*value));
  if (!value->is_array() || value->size() != 3) throw std::runtime_error(text(key, " of a material is no colour"));
  return Spectrum{share((*value)[0]), share((*value)[1]), share((*value)[2])};
}

ModelMaterial read_material(const Json& json) {
  ModelMaterial to;
  to.material.name = word(json, "name");
  if (to.material.name.empty()) to.material.name = kDefaultMaterial;
  const auto reflectance = shares(json, "reflectance"), colour = shares(json, "colour");
  if (reflectance || colour) to.material.reflectance = reflectance ? *reflectance : *colour;
  const auto glass = shares(json, "glass"), passes = shares(json, "transmittance");
  to.described = reflectance || colour || glass;
  if (glass) {
    to.material.kind = MaterialKind::glass;
    to.material.transmittance = *glass;
  } else {
    apply_opacity(to.material, 1 - json.value("transparency", 0.0));
  }
  if (passes && to.material.kind == MaterialKind::glass && passes->max() > 0) to.material.transmittance = *passes;
  if (const Json* gloss = member(json, "gloss")) {
    to.gloss.emplace().of_all = shares(*gloss, "specular").value_or(Spectrum(0.0));
    if (gloss->contains("exponent")) to.gloss->exponent = gloss->at("exponent").get<double>();
    to.gloss->roughness = gloss->value("roughness", 1.0);
  }
  return to;
}

std::vector<NotRead> read_notes(const Json& json, const char* key) {
  std::vector<NotRead> notes;
  if (const Json* list = member(json, key))
    for (const Json& note : *list)
      notes.push_back({word(note, "what"), note.value("count", std::size_t{0}), word(note, "first")});
  return notes;
}

std::string line_of(const NotRead& note) {
  const std::string others = note.count > 1 ? text(" (and ", note.count - 1, " more)") : "";
  return text(note.first.empty() ? "" : text("'", quotable(note.first), "'", others, " "), note.what);
}

/// All but the meshes, which come before it in the answer and need it.
void read_end(const Json& json, const std::filesystem::path& file, Model& model) {
  UniqueNames surfaces, spaces;
  for (const Json& name : json.at("surfaces")) model.surfaces.push_back(surfaces.take(name.get<std::string>()));
  for (const Json& material : json.at("materials")) {
    model.materials.push_back(read_material(material));
    if (!material.value("textured", false)) continue;
    if (model.textures.empty()) model.textures.push_back({"a texture of IFC", {}, {}});
    model.materials.back().texture = 0;
  }
  for (const Json& space : json.at("spaces"))
    model.spaces.push_back({spaces.take(word(space, "name")), word(space, "long_name"), {}, {}});
  IfcLights lights(file, model);
  for (const Json& fixture : json.at("fixtures")) model.fixtures.push_back(lights.fixture(fixture));
  if (const Json* north = member(json, "north")) model.north_deg = north->get<double>();
  for (const NotRead& note : read_notes(json, "warnings")) model.warnings.push_back(line_of(note));
  for (const NotRead& note : read_notes(json, "complaints"))
    model.warnings.push_back(text(line_of(note), note.first.empty() ? "" : ", says web-ifc"));
  for (const char* key : {"complaints", "left_out"})
    for (NotRead& note : read_notes(json, key)) model.not_read.push_back(std::move(note));
}

void add_space(Model& model, PlacedMesh& read) {
  NamedSpace& space = model.spaces[read.owner];
  const auto first = static_cast<std::uint32_t>(space.vertices.size());
  for (const Vec3& p : read.mesh.vertices) {
    const Vec3 q = read.place.point(p);
    if (!is_finite(q) || std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) > kLargestCoordinate)
      throw std::runtime_error("a space has a corner out of range");
    space.vertices.push_back(q);
  }
  for (const std::uint32_t c : read.mesh.corner) {
    if (c >= read.mesh.vertices.size()) throw std::runtime_error("a space has a corner without a vertex");
    space.corner.push_back(first + c);
  }
}

}  // namespace

Model model_of_ifc_answer(std::string_view answer, const std::filesystem::path& file) {
  const std::string name = short_name(file);
  Reader reader(answer);
  if (reader.take(kStart.size()) != kStart) throw std::runtime_error("the answer begins with something else");
  std::vector<Record> meshes;
  Record end;
  while (end.tag != kEnd) {
    end = reader.record();
    if (end.tag == kMesh || end.tag == kSpace) meshes.push_back(end);
  }
  Model model;
  model.metres_per_unit = 1.0;
  model.up = Up::z;
  try {
    const Json json = Json::parse(end.bytes);
    if (const std::string why = word(json, "refused"); !why.empty()) throw InputError(text(name, ": ", why));
    read_end(json, file, model);
  } catch (const Json::exception& error) {
    throw std::runtime_error(error.what());
  }
  std::size_t faces = 0;
  for (const Record& record : meshes) {
    PlacedMesh read = read_mesh(record.bytes);
    if (record.tag == kSpace) {
      if (read.owner >= model.spaces.size()) throw std::runtime_error("a mesh belongs to no space");
      add_space(model, read);
      continue;
    }
    if (read.owner >= model.surfaces.size() || read.material >= model.materials.size())
      throw std::runtime_error("a mesh belongs to no surface or material");
    faces += read.mesh.corner.size() / 3;
    if (faces > kMaxFaces)
      throw InputError(text(name, ": more than ", kMaxFaces, " faces; leave out what light does not need"));
    read.mesh.material = MaterialId(read.material);
    add_mesh(model, read.mesh, read.place, SurfaceId(read.owner), name);
  }
  if (model.polygons.face_count() == 0)
    throw InputError(text(name, ": ", kNoFaces, model.warnings.empty() ? "" : text("; ", model.warnings.front())));
  return model;
}

std::string last_ifc_product(std::string_view answer) {
  std::string last;
  try {
    Reader reader(answer);
    reader.take(kStart.size());
    while (!reader.at_end()) {
      const Record record = reader.record();
      if (record.tag == kProgress) last = record.bytes;
    }
  } catch (const std::runtime_error&) {  // cut off where the program ended
  }
  return last;
}

}  // namespace clerestory
