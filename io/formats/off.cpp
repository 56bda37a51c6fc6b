// Object File Format: polygons as text. Source: Geomview manual, "OFF files".

#include <algorithm>

#include "io/formats/one_mesh.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 4ull << 30;

class OffReader {
 public:
  explicit OffReader(const std::filesystem::path& file)
      : name_(short_name(file)),
        stem_(file.stem().string()),
        bytes_(read_input_file(file, kMaxBytes)),
        rest_(text_bytes(bytes_, name_)) {}

  Model read() {
    std::string_view line = next_line("the word OFF");
    const std::string_view kind = next_word(line);
    // ST, C and N before OFF add columns behind x y z, which are not needed here.
    if (kind != "OFF" && kind != "COFF" && kind != "NOFF" && kind != "CNOFF" && kind != "STOFF" && kind != "STCNOFF") {
      refuse(text("starts with '", quotable(kind), "'; an .off file in text form starts with OFF, COFF or NOFF"));
    }
    if (trimmed(line).starts_with("BINARY")) refuse("is a binary OFF file; only the text form is read");
    if (trimmed(line).empty()) line = next_line("the counts of vertices and faces");
    const std::size_t vertices = count(line, "vertices"), faces = count(line, "faces");

    Model model = model_without_materials();
    model.surfaces.push_back(stem_);
    LocalMesh mesh;
    mesh.material = MaterialId(std::size_t{0});
    mesh.vertices.reserve(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
      line = next_line(text("vertex ", v, " of ", vertices));
      double x[3];
      for (double& coordinate : x) coordinate = number(line);
      mesh.vertices.push_back({x[0], x[1], x[2]});
    }
    for (std::size_t f = 0; f < faces; ++f) {
      line = next_line(text("face ", f, " of ", faces));
      const double corners = number(line);
      if (!(corners >= 0 && corners <= static_cast<double>(line.size())))
        refuse(text("a face of ", corners, " corners"));
      for (double k = 0; k < corners; ++k) {
        const double v = number(line);
        if (!(v >= 0 && v < static_cast<double>(vertices))) {
          refuse(text("a face uses vertex ", v, ", but there are 0 to ", static_cast<double>(vertices) - 1));
        }
        mesh.corner.push_back(static_cast<std::uint32_t>(v));
      }
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corner.size()));
    }
    add_mesh(model, mesh, {}, SurfaceId(std::size_t{0}), name_);
    require_faces(model, name_);
    return model;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(text(name_, ":", line_, ": ", what)); }

  /// The next line that says something.
  std::string_view next_line(const std::string& wanted) {
    while (!rest_.empty()) {
      std::string_view line = clerestory::next_line(rest_);
      ++line_;
      line = trimmed(line.substr(0, line.find('#')));
      if (!line.empty()) return line;
    }
    refuse(text("the file ends where ", wanted, " should follow; is it cut off?"));
  }

  double number(std::string_view& line) const {
    const std::string_view word = next_word(line);
    const std::optional<double> value = to_number(word);
    if (!value) refuse(text("'", quotable(word), "' is not a number"));
    return *value;
  }

  /// How many lines of them follow; no more than there are bytes.
  std::size_t count(std::string_view& line, const char* what) const {
    const double n = number(line);
    if (!(n >= 0 && n <= static_cast<double>(rest_.size())))
      refuse(text(n, " ", what, " in a file of ", bytes_.size(), " bytes"));
    return static_cast<std::size_t>(n);
  }

  std::string name_, stem_, bytes_;
  std::string_view rest_;
  std::size_t line_ = 0;
};

}  // namespace

Model read_off(const std::filesystem::path& file) { return OffReader(file).read(); }

}  // namespace clerestory
