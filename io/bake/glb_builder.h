#pragma once
// A .glb file under construction: JSON, and one buffer that its accessors look into. JSON shows: for .cpp files of
// io/bake/ only. Source: Khronos, "glTF 2.0 specification", 2021.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/affine.h"
#include "io/atomic_file.h"
#include "solver/model/vec.h"

namespace clerestory {

class GlbBuilder {
 public:
  using Json = nlohmann::json;

  GlbBuilder();

  /// Adds to a list of the root ("nodes"), and returns its index there.
  std::size_t add(const char* list, Json element);
  Json& element(const char* list, std::size_t index) { return root_[list][index]; }
  Json& root() { return root_; }
  /// Names an extension that the file uses.
  void use(const std::string& extension);

  /// Accessors of float. Smallest and largest values are said of positions.
  std::size_t add_positions(const std::vector<Vec3>& positions);
  std::size_t add_vectors(const std::vector<Vec3>& vectors);
  /// n elements of 1 to 4 floats each: SCALAR, VEC2, VEC3, VEC4.
  std::size_t add_floats(const std::vector<float>& values, std::size_t components);
  /// Corners of triangles, as 16-bit numbers where all fit.
  std::size_t add_indices(const std::vector<std::uint32_t>& corners, std::size_t vertex_count);
  /// Bytes as they are, in a view of their own: of an image.
  std::size_t add_bytes(std::string_view bytes);
  /// The same as an accessor that is described already but for its view.
  std::size_t add_accessor(Json accessor, std::string_view bytes, int target);

  /// A node over others, that moves them by so much.
  std::size_t add_over(const std::vector<std::size_t>& nodes, const std::string& name, const Vec3& origin);
  /// The scene that is shown.
  void show(const std::vector<std::size_t>& nodes);

  /// throws  InputError when it is larger than 4 GiB.
  void write(AtomicFile& file);

 private:
  std::size_t add_view(std::string_view bytes, int target);

  Json root_;
  std::string binary_;
};

/// From the scene's frame to that of glTF, y up: the inverse of (x, y, z) -> (x, -z, y). No -0.
inline constexpr Vec3 y_up(const Vec3& p) { return {p.x, p.z, 0.0 - p.y}; }

/// A thing of another file as the core of glTF knows it: extensions in it would have to be declared.
nlohmann::json without_extensions(nlohmann::json thing);

}  // namespace clerestory
