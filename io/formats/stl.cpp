// Stereolithography: triangles as text or binary. Source: 3D Systems, "StereoLithography interface specification",
// 1989.

#include <cstring>

#include "io/formats/one_mesh.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 4ull << 30;
constexpr std::size_t kHeader = 84, kTriangle = 50;

struct StlText {
  std::string_view rest;
  std::size_t line = 1;

  std::string_view word() {
    while (!rest.empty() &&
           (rest.front() == ' ' || rest.front() == '\t' || rest.front() == '\r' || rest.front() == '\n')) {
      if (rest.front() == '\n' || (rest.front() == '\r' && !rest.starts_with("\r\n"))) ++line;
      rest.remove_prefix(1);
    }
    const std::size_t n = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    const std::string_view found = rest.substr(0, n);
    rest.remove_prefix(n);
    return found;
  }
  std::string_view to_line_end() {
    const std::size_t n = std::min(rest.find_first_of("\r\n"), rest.size());
    const std::string_view found = rest.substr(0, n);
    rest.remove_prefix(n);
    return trimmed(found);
  }
};

/// solid NAME { facet normal x y z  outer loop  3 x (vertex x y z)  endloop  endfacet } endsolid NAME, any number of
/// times
void read_text(std::string_view bytes, const std::string& name, const std::string& stem, Model& model) {
  StlText in{bytes};
  UniqueNames names;
  LocalMesh mesh;
  mesh.material = MaterialId(std::size_t{0});
  std::size_t in_loop = 0;
  const auto refuse = [&](const std::string& what) { throw InputError(text(name, ":", in.line, ": ", what)); };
  bool is_open = false;
  for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
    const std::string key = to_lower(word.substr(0, 16));
    if (key == "solid") {
      const std::string_view solid = in.to_line_end();
      model.surfaces.push_back(names.take(solid.empty() ? stem : std::string(solid)));
      is_open = true;
    } else if (!is_open) {
      refuse(text("'", quotable(word), "' where 'solid' should stand"));
    } else if (key == "vertex") {
      double x[3];
      for (double& coordinate : x) {
        const std::string_view digits = in.word();
        const std::optional<double> value = to_number(digits);
        if (!value) refuse(text("'", quotable(digits), "' is not a number"));
        coordinate = *value;
      }
      mesh.corner.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back({x[0], x[1], x[2]});
      ++in_loop;
    } else if (key == "endloop") {
      if (in_loop != 3) refuse(text("a loop of ", in_loop, " vertices; STL has triangles only"));
      mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corner.size()));
      in_loop = 0;
    } else if (key == "endsolid") {
      in.to_line_end();
      add_mesh(model, mesh, {}, SurfaceId(model.surfaces.size() - 1), name);
      mesh.vertices.clear();
      mesh.corner.clear();
      mesh.face_begin.assign(1, 0);
      is_open = false;
    } else if (key == "facet") {
      in.to_line_end();  // the normal follows from the corners
    } else if (key != "outer" && key != "loop" && key != "endfacet") {
      refuse(text("'", quotable(word), "' is not a word of an STL file"));
    }
  }
  if (is_open) refuse("the file ends before 'endsolid'; is it cut off?");
}

/// As the header of a binary file says; 0 when there is none.
std::uint32_t count_of_triangles(std::string_view bytes) {
  std::uint32_t triangles = 0;
  if (bytes.size() >= kHeader) std::memcpy(&triangles, bytes.data() + 80, sizeof(triangles));
  return triangles;
}

bool is_binary(std::string_view bytes) {
  return bytes.size() >= kHeader && bytes.size() == kHeader + std::uint64_t{count_of_triangles(bytes)} * kTriangle;
}

void read_binary(std::string_view bytes, std::size_t triangles, const std::string& name, const std::string& stem,
                 Model& model) {
  model.surfaces.push_back(stem);
  LocalMesh mesh;
  mesh.material = MaterialId(std::size_t{0});
  for (std::size_t t = 0; t < triangles; ++t) {
    float x[9];
    std::memcpy(x, bytes.data() + kHeader + t * kTriangle + 12, sizeof(x));
    for (std::size_t k = 0; k < 9; k += 3) {
      mesh.corner.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back({double{x[k]}, double{x[k + 1]}, double{x[k + 2]}});
    }
    mesh.face_begin.push_back(static_cast<std::uint32_t>(mesh.corner.size()));
  }
  add_mesh(model, mesh, {}, SurfaceId(std::size_t{0}), name);
}

}  // namespace

Model read_stl(const std::filesystem::path& file) {
  const std::string whole = read_input_file(file, kMaxBytes);
  const std::string name = short_name(file), stem = file.stem().string();
  Model model = model_without_materials();
  std::string_view bytes = whole;
  // Binary files may start with "solid", or with what looks like a mark; their size gives them away.
  if (!is_binary(bytes)) bytes = text_bytes(bytes, name);
  const std::uint32_t triangles = count_of_triangles(bytes);
  const std::uint64_t binary_size = kHeader + std::uint64_t{triangles} * kTriangle;
  const std::string_view start = trimmed(bytes.substr(0, 256));
  if (is_binary(bytes)) {
    read_binary(bytes, triangles, name, stem, model);
  } else if (to_lower(start.substr(0, 5)) == "solid") {
    read_text(bytes, name, stem, model);
  } else if (bytes.size() < kHeader) {
    throw InputError(
        text(name, ": is neither text that starts with 'solid' nor a binary STL file of at least 84 bytes"));
  } else if (bytes.size() < binary_size) {
    throw InputError(text(name, ": is cut off, or no STL file: ", triangles, " triangles need ", binary_size,
                          " bytes, and it has ", bytes.size()));
  } else {
    read_binary(bytes, triangles, name, stem, model);
    model.warnings.push_back(text(bytes.size() - binary_size, " bytes behind the last triangle are left out"));
  }
  require_faces(model, name);
  return model;
}

}  // namespace clerestory
