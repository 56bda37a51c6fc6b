// Polygon File Format, text and binary of both byte orders: vertices and polygons; other elements are skipped.
// Source: Turk, "The PLY polygon file format", 1994.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "io/formats/one_mesh.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 8ull << 30;

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

std::optional<Type> type_of(std::string_view word) {
  struct Named {
    std::string_view name, other_name;
    Type type;
  };
  constexpr Named kTypes[] = {{"char", "int8", Type::i8},      {"uchar", "uint8", Type::u8},
                              {"short", "int16", Type::i16},   {"ushort", "uint16", Type::u16},
                              {"int", "int32", Type::i32},     {"uint", "uint32", Type::u32},
                              {"float", "float32", Type::f32}, {"double", "float64", Type::f64}};
  for (const Named& named : kTypes) {
    if (word == named.name || word == named.other_name) return named.type;
  }
  return std::nullopt;
}

std::size_t size_of(Type type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

template <class T>
double as_double(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

struct Property {
  std::string name;
  Type type = Type::f32;
  std::optional<Type> count_type;  ///< of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  explicit PlyReader(const std::filesystem::path& file)
      : name_(short_name(file)),
        stem_(file.stem().string()),
        bytes_(read_input_file(file, kMaxBytes)),
        rest_(text_bytes(bytes_, name_)) {}

  Model read() {
    read_header();
    mesh_.material = MaterialId(std::size_t{0});
    for (const Element& element : elements_) {
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        throw InputError(name_ + ": holds triangle strips, which are not read; export it with faces");
      } else {
        read_rows(
            element, [](std::size_t, std::size_t, double) {}, [](std::size_t, std::size_t, std::size_t) {});
      }
    }
    Model model = model_without_materials();
    model.surfaces.push_back(stem_);
    add_mesh(model, mesh_, {}, SurfaceId(std::size_t{0}), name_);
    require_faces(model, name_);
    return model;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(text(name_, ":", line_, ": ", what)); }

  std::string_view next_line() {
    if (rest_.empty()) refuse("the header ends without 'end_header'; is the file cut off?");
    // Lines end as the first one does: after a CR alone, a binary body may begin with the byte LF.
    if (line_ == 0) ends_in_cr_ = rest_.starts_with("ply\r") && !rest_.starts_with("ply\r\n");
    const std::size_t end = std::min(rest_.find(ends_in_cr_ ? '\r' : '\n'), rest_.size());
    const std::string_view line = rest_.substr(0, std::min<std::size_t>(end, 4096));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    return trimmed(line);
  }

  void read_header() {
    if (next_line() != "ply") refuse("does not start with 'ply'; is it damaged, or another format?");
    for (std::string_view line = next_line(); line != "end_header"; line = next_line()) {
      const std::string_view key = next_word(line);
      if (key == "format") {
        const std::string_view format = next_word(line);
        if (format != "ascii" && format != "binary_little_endian" && format != "binary_big_endian") {
          refuse(text("format '", quotable(format), "' is not ascii, binary_little_endian or binary_big_endian"));
        }
        is_text_ = format == "ascii";
        swaps_ = (format == "binary_big_endian") == (std::endian::native == std::endian::little);
      } else if (key == "element") {
        Element element{std::string(next_word(line)), 0, {}};
        const double count = to_number(next_word(line)).value_or(-1);
        if (!(count >= 0 && count == std::floor(count)))
          refuse(text("element '", quotable(element.name), "' needs its count"));
        // No row is shorter than a byte.
        if (count > static_cast<double>(bytes_.size())) {
          refuse(text(count, " of element '", quotable(element.name), "' in a file of ", bytes_.size(), " bytes"));
        }
        element.count = static_cast<std::size_t>(count);
        elements_.push_back(std::move(element));
      } else if (key == "property") {
        read_property(line);
      } else if (!key.empty() && key != "comment" && key != "obj_info") {
        refuse(text("'", quotable(key), "' is not a word of a PLY header"));
      }
      if (elements_.size() > 1000) refuse("more than 1000 elements");
    }
  }

  void read_property(std::string_view line) {
    if (elements_.empty()) refuse("a property stands before the first element");
    Property property;
    std::string_view word = next_word(line);
    if (word == "list") {
      property.count_type = type_of(next_word(line));
      if (!property.count_type || *property.count_type >= Type::f32)
        refuse("a list needs a whole-number type for its length");
      word = next_word(line);
    }
    const std::optional<Type> type = type_of(word);
    if (!type) refuse(text("'", quotable(word), "' is not a type of a PLY property"));
    property.type = *type;
    property.name = next_word(line);
    elements_.back().properties.push_back(std::move(property));
    if (elements_.back().properties.size() > 1000) refuse("more than 1000 properties");
  }

  /// number(row, property, value) for each plain value and list entry, length(row, property, n) before each list.
  template <class Number, class Length>
  void read_rows(const Element& element, const Number& number, const Length& length) {
    if (element.properties.empty()) return;
    for (std::size_t row = 0; row < element.count; ++row) {
      row_ = row;
      element_ = &element;
      for (std::size_t p = 0; p < element.properties.size(); ++p) {
        const Property& property = element.properties[p];
        std::size_t entries = 1;
        if (property.count_type) {
          const double n = next_number(*property.count_type);
          if (!(n >= 0 && n <= static_cast<double>(rest_.size()))) refuse_row(text("a list of ", n, " entries"));
          entries = static_cast<std::size_t>(n);
          length(row, p, entries);
        }
        for (std::size_t e = 0; e < entries; ++e) number(row, p, next_number(property.type));
      }
    }
  }

  [[noreturn]] void refuse_row(const std::string& what) const {
    throw InputError(
        text(name_, ": ", quotable(element_->name), " ", row_, " (from 0) of ", element_->count, ": ", what));
  }

  double next_number(Type type) {
    if (is_text_) {
      const std::string_view word = next_word(rest_);
      if (word.empty()) refuse_row("the file ends before it; is it cut off?");
      const std::optional<double> value = to_number(word);
      if (!value) refuse_row(text("'", quotable(word), "' is not a number"));
      return *value;
    }
    const std::size_t size = size_of(type);
    if (rest_.size() < size) refuse_row("the file ends before it; is it cut off?");
    char bytes[8];
    std::memcpy(bytes, rest_.data(), size);
    rest_.remove_prefix(size);
    if (swaps_) std::reverse(bytes, bytes + size);
    switch (type) {
      case Type::i8:
        return as_double<std::int8_t>(bytes);
      case Type::u8:
        return as_double<std::uint8_t>(bytes);
      case Type::i16:
        return as_double<std::int16_t>(bytes);
      case Type::u16:
        return as_double<std::uint16_t>(bytes);
      case Type::i32:
        return as_double<std::int32_t>(bytes);
      case Type::u32:
        return as_double<std::uint32_t>(bytes);
      case Type::f32:
        return as_double<float>(bytes);
      default:
        return as_double<double>(bytes);
    }
  }

  void read_vertices(const Element& element) {
    if (!mesh_.vertices.empty()) throw InputError(name_ + ": has two elements 'vertex'");
    std::vector<int> axis(element.properties.size(), -1);
    int found = 0;
    for (std::size_t p = 0; p < axis.size(); ++p) {
      const std::string& name = element.properties[p].name;
      if (element.properties[p].count_type || name.size() != 1 || name[0] < 'x' || name[0] > 'z') continue;
      axis[p] = name[0] - 'x';
      found |= 1 << axis[p];
    }
    if (found != 7) throw InputError(name_ + ": its vertices lack x, y or z");
    mesh_.vertices.resize(element.count);
    read_rows(
        element,
        [&](std::size_t row, std::size_t p, double value) {
          Vec3& v = mesh_.vertices[row];
          if (axis[p] >= 0) (axis[p] == 0 ? v.x : axis[p] == 1 ? v.y : v.z) = value;
        },
        [](std::size_t, std::size_t, std::size_t) {});
  }

  void read_faces(const Element& element) {
    const auto is_corners = [](const Property& property) {
      return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
    };
    const auto found = std::find_if(element.properties.begin(), element.properties.end(), is_corners);
    if (found == element.properties.end()) throw InputError(name_ + ": its faces lack the list vertex_indices");
    const auto corners = static_cast<std::size_t>(found - element.properties.begin());
    read_rows(
        element,
        [&](std::size_t, std::size_t p, double value) {
          if (p != corners) return;
          if (!(value >= 0 && value < 4294967295.0)) refuse_row(text(value, " is no vertex"));
          mesh_.corner.push_back(static_cast<std::uint32_t>(value));
          mesh_.face_begin.back() = static_cast<std::uint32_t>(mesh_.corner.size());
        },
        [&](std::size_t, std::size_t p, std::size_t) {
          if (p == corners) mesh_.face_begin.push_back(static_cast<std::uint32_t>(mesh_.corner.size()));
        });
  }

  std::string name_, stem_, bytes_;
  std::string_view rest_;
  std::size_t line_ = 0;
  bool ends_in_cr_ = false, is_text_ = true, swaps_ = false;
  std::vector<Element> elements_;
  const Element* element_ = nullptr;
  std::size_t row_ = 0;
  LocalMesh mesh_;
};

}  // namespace

Model read_ply(const std::filesystem::path& file) { return PlyReader(file).read(); }

}  // namespace clerestory
