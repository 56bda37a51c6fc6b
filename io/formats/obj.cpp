// Wavefront OBJ: polygons with any number of corners, objects, groups and materials, in double precision, so that a
// georeferenced model keeps its detail. Source: Wavefront, "Object files (.obj)", 1995.

#include <algorithm>
#include <charconv>
#include <unordered_map>
#include <unordered_set>

#include "io/formats/mtl.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 8ull << 30;

/// Lines of a text, joined where one ends in a backslash.
class Lines {
 public:
  explicit Lines(std::string_view bytes) : rest_(bytes) {}
  bool next(std::string_view& line) {
    if (rest_.empty()) return false;
    ++number_;
    line = next_line(rest_);
    if (line.empty() || line.back() != '\\') return true;
    joined_.clear();
    while (!line.empty() && line.back() == '\\') {
      joined_ += line.substr(0, line.size() - 1);
      joined_ += ' ';
      if (rest_.empty()) break;
      ++number_;
      line = next_line(rest_);
    }
    if (line.empty() || line.back() != '\\') joined_ += line;
    line = joined_;
    return true;
  }
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::string joined_;
  std::size_t number_ = 0;
};

class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& file) : file_(file), name_(short_name(file)) {}

  Model read() {
    const std::string bytes = read_input_file(file_, kMaxBytes);
    Lines lines(text_bytes(bytes, name_));
    std::string_view line;
    while (lines.next(line)) {
      line_ = lines.number();
      read_statement(line);
    }
    if (model_.polygons.face_count() == 0) {
      throw InputError(text(name_,
                            ": has no faces (no 'f' statement with three corners or more); nothing to light. Export "
                            "its surfaces as polygons"));
    }
    finish();
    return std::move(model_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(text(name_, ":", line_, ": ", what)); }

  void read_statement(std::string_view line) {
    const std::string_view key = next_word(line);
    if (key.empty() || key[0] == '#') return;
    if (key == "v") return read_vertex(line);
    if (key == "f" || key == "fo") return read_face(line);
    if (key == "o" || key == "g") return start_surface(trimmed(line));
    if (key == "usemtl") return start_material(trimmed(line));
    if (key == "mtllib") return read_libraries(trimmed(line));
    if (key == "curv" || key == "curv2" || key == "surf") ++free_forms_;
    if (std::any_of(key.begin(), key.end(), [](char c) { return c < 0x20 || c > 0x7e; })) {
      refuse(text("'", quotable(key), "' is not text of an OBJ file; is it damaged, or another format?"));
    }
    // vt, vn, s, l, p and the like say nothing about surfaces that light falls on.
  }

  void read_vertex(std::string_view rest) {
    double x[3];
    for (int k = 0; k < 3; ++k) {
      const std::string_view word = next_word(rest);
      const std::optional<double> value = to_number(word);
      if (!value)
        refuse(text("vertex ", vertices_.size() + 1, ": '", quotable(word), "' is not a number; 'v' needs x y z"));
      if (!(std::abs(*value) <= kLargestCoordinate)) {
        refuse(text("vertex ", vertices_.size() + 1, ": ", "xyz"[k], " = ", word, " is outside [-1e12, 1e12]"));
      }
      x[k] = *value;
    }
    vertices_.push_back({x[0], x[1], x[2]});
    place_.push_back(kUnused);
  }

  /// A corner is v, v/vt, v//vn or v/vt/vn; v counts from 1, or backwards from the last vertex as -1.
  void read_face(std::string_view rest) {
    face_.clear();
    for (std::string_view word = next_word(rest); !word.empty(); word = next_word(rest)) {
      if (word[0] == '#') break;
      const std::string_view digits = word.substr(0, word.find('/'));
      long long index = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
      if (error != std::errc{} || end != digits.data() + digits.size()) {
        refuse(text("'", quotable(word), "' is not a corner of a face; expected v, v/vt, v//vn or v/vt/vn"));
      }
      const auto count = static_cast<long long>(vertices_.size());
      const long long vertex = index < 0 ? count + index : index - 1;
      if (index == 0 || vertex < 0 || vertex >= count) {
        refuse(text("a face uses vertex ", index, ", but ", count, " vertices stand before it"));
      }
      face_.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (face_.size() < 3) {
      ++short_faces_;
      return;
    }
    if (!surface_.valid()) start_surface({});
    if (!material_.valid()) material_ = material_named(kDefaultMaterial);
    PolygonSoup& soup = model_.polygons;
    for (const std::uint32_t vertex : face_) {
      if (place_[vertex] == kUnused) {
        place_[vertex] = static_cast<std::uint32_t>(soup.vertices.size());
        soup.add_vertex(vertices_[vertex]);
      }
      soup.add_corner(place_[vertex]);
    }
    soup.end_face(material_, surface_);
  }

  void start_surface(std::string_view name) {
    const std::string key(name.empty() ? file_.stem().string() : std::string(name));
    const auto [at, is_new] = surface_by_name_.try_emplace(key, SurfaceId(model_.surfaces.size()));
    if (is_new) model_.surfaces.push_back(key);
    surface_ = at->second;
  }

  MaterialId material_named(std::string_view name) {
    const auto [at, is_new] = material_by_name_.try_emplace(std::string(name), MaterialId(model_.materials.size()));
    if (is_new) {
      ModelMaterial& material = model_.materials.emplace_back();
      material.material.name = name;
      material.described = false;
    }
    return at->second;
  }

  void start_material(std::string_view name) { material_ = material_named(name.empty() ? kDefaultMaterial : name); }

  /// One name with blanks in it, or several names, perhaps in quotation marks.
  void read_libraries(std::string_view names) {
    if (!library_lines_.insert(std::string(names)).second) return;
    const std::filesystem::path folder = file_.parent_path();
    const std::string lower = to_lower(names);
    const bool is_one = lower.find(".mtl") == lower.rfind(".mtl");
    if (const auto library = is_one ? mtl_.files().file(folder, names) : mtl_.files().path(folder, names))
      return read_library(*library);
    while (!(names = trimmed(names)).empty()) {
      const std::size_t closing = names.front() == '"' ? names.find('"', 1) : names.npos;
      std::string_view name = closing == names.npos ? next_word(names) : names.substr(0, closing + 1);
      if (closing != names.npos) names.remove_prefix(closing + 1);
      if (const auto library = mtl_.files().file(folder, name))
        read_library(*library);
      else
        model_.warnings.push_back(
            text("material file '", quotable((folder / unquoted(name)).string()), "' is missing"));
    }
  }

  /// Once, however often and by whatever path it is named.
  void read_library(const std::filesystem::path& library) {
    std::error_code error;
    if (!libraries_.insert(std::filesystem::weakly_canonical(library, error).string()).second) return;
    model_.files.push_back(library);
    for (ModelMaterial& material : mtl_.read(library)) {
      described_.try_emplace(material.material.name, material);
    }
  }

  /// Materials get what the libraries say, wherever in the file those were named.
  void finish() {
    for (ModelMaterial& material : model_.materials) {
      const auto found = described_.find(material.material.name);
      if (found != described_.end()) material = found->second;
    }
    if (short_faces_ > 0)
      model_.warnings.push_back(text(short_faces_, " faces with fewer than three corners are left out"));
    if (free_forms_ > 0) model_.warnings.push_back(text(free_forms_, " free-form curves and surfaces are left out"));
  }

  static constexpr std::uint32_t kUnused = 0xffffffff;

  std::filesystem::path file_;
  std::string name_;
  Model model_;
  MtlReader mtl_{model_};
  std::vector<Vec3> vertices_;        // all of the file; the model takes those that faces use
  std::vector<std::uint32_t> place_;  // of each vertex in the model
  std::vector<std::uint32_t> face_;
  std::unordered_map<std::string, SurfaceId> surface_by_name_;
  std::unordered_map<std::string, MaterialId> material_by_name_;
  std::unordered_map<std::string, ModelMaterial> described_;
  std::unordered_set<std::string> library_lines_, libraries_;  // as they are written; by the one path each has
  SurfaceId surface_;
  MaterialId material_;
  std::size_t line_ = 0, short_faces_ = 0, free_forms_ = 0;
};

}  // namespace

Model read_obj(const std::filesystem::path& file) { return ObjReader(file).read(); }

}  // namespace clerestory
