#include "io/formats/model_bytes.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace clerestory {
namespace {

/// One walk over all parts of a Model serves writing and reading, so that they cannot differ.
class Writer {
 public:
  template <class T>
  void plain(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  template <class T>
  void array(const std::vector<T>& values) {
    size(values);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
  void string(const std::string& s) {
    size(s);
    bytes += s;
  }
  void path(const std::filesystem::path& file) { string(file.string()); }
  template <class Container>
  void size(const Container& container) {
    plain(std::uint64_t{container.size()});
  }
  template <class T>
  void maybe(const std::optional<T>& value) {
    plain(value.has_value());
    if (value) plain(*value);
  }
  std::string bytes;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  void plain(T& value) {
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
  }
  void plain(bool& value) { value = below<std::uint8_t>(2) == 1; }
  void plain(Up& value) { value = Up{below<int>(2)}; }
  void plain(MaterialKind& value) { value = MaterialKind{below<int>(std::size(kMaterialKindNames))}; }
  template <class T>
  void array(std::vector<T>& values) {
    const std::uint64_t n = count(sizeof(T));
    values.resize(n);
    const std::string_view from = take(n * sizeof(T));
    if (n > 0) std::memcpy(static_cast<void*>(values.data()), from.data(), from.size());
  }
  void string(std::string& s) { s = take(count(1)); }
  void path(std::filesystem::path& file) { file = take(count(1)); }
  template <class Container>
  void size(Container& container) {
    container.resize(count(1));
  }
  template <class T>
  void maybe(std::optional<T>& value) {
    bool there = false;
    plain(there);
    if (there) plain(value.emplace());
  }
  bool at_end() const { return rest_.empty(); }

 private:
  template <class Number>
  Number below(Number end) {
    Number n{};
    plain(n);
    if (n < 0 || n >= end) throw std::runtime_error("model bytes hold a value that there is not");
    return n;
  }
  std::uint64_t count(std::size_t bytes_each) {
    std::uint64_t n = 0;
    plain(n);
    if (n > rest_.size() / bytes_each) throw std::runtime_error("model bytes are cut off");
    return n;
  }
  std::string_view take(std::uint64_t n) {
    if (n > rest_.size()) throw std::runtime_error("model bytes are cut off");
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }
  std::string_view rest_;
};

template <class Walker, class Values, class Visit>
void each(Walker& walker, Values& values, const Visit& visit) {
  walker.size(values);
  for (auto& value : values) visit(value);
}

/// AnyModel is const for a Writer.
template <class Walker, class AnyModel>
void walk(Walker& walker, AnyModel& model) {
  walker.array(model.polygons.vertices);
  walker.array(model.polygons.corner);
  walker.array(model.polygons.face_begin);
  walker.array(model.polygons.material);
  walker.array(model.polygons.surface);
  each(walker, model.materials, [&](auto& m) {
    walker.string(m.material.name);
    walker.plain(m.material.kind);
    walker.plain(m.material.reflectance);
    walker.plain(m.material.transmittance);
    walker.plain(m.material.exitance);
    walker.maybe(m.material.total_power);
    walker.plain(m.material.sides);
    walker.plain(m.described);
    walker.maybe(m.texture);
    walker.maybe(m.glow_texture);
    walker.plain(m.unitless_glow);
  });
  each(walker, model.textures, [&](auto& texture) {
    walker.string(texture.name);
    walker.path(texture.file);
    walker.string(texture.bytes);
  });
  each(walker, model.surfaces, [&](auto& name) { walker.string(name); });
  each(walker, model.warnings, [&](auto& warning) { walker.string(warning); });
  each(walker, model.files, [&](auto& file) { walker.path(file); });
  walker.maybe(model.metres_per_unit);
  walker.maybe(model.up);
}

bool is_consistent(const Model& model) {
  const PolygonSoup& soup = model.polygons;
  const std::size_t faces = soup.material.size();
  const auto has = [&](const std::optional<std::size_t>& texture) {
    return !texture || *texture < model.textures.size();
  };
  return soup.surface.size() == faces && soup.face_begin.size() == faces + 1 && soup.face_begin.front() == 0 &&
         soup.face_begin.back() == soup.corner.size() &&
         std::is_sorted(soup.face_begin.begin(), soup.face_begin.end()) &&
         std::all_of(soup.corner.begin(), soup.corner.end(), [&](auto c) { return c < soup.vertices.size(); }) &&
         std::all_of(soup.material.begin(), soup.material.end(), [&](auto m) { return m < model.materials.size(); }) &&
         std::all_of(soup.surface.begin(), soup.surface.end(), [&](auto s) { return s < model.surfaces.size(); }) &&
         std::all_of(model.materials.begin(), model.materials.end(),
                     [&](const ModelMaterial& m) { return has(m.texture) && has(m.glow_texture); });
}

}  // namespace

std::string to_bytes(const Model& model) {
  Writer writer;
  walk(writer, model);
  return std::move(writer.bytes);
}

Model from_bytes(std::string_view bytes) {
  Reader reader(bytes);
  Model model;
  walk(reader, model);
  if (!reader.at_end() || !is_consistent(model)) throw std::runtime_error("model bytes do not fit together");
  return model;
}

}  // namespace clerestory
