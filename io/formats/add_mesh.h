#pragma once
// Puts a mesh of a file into a Model through the transform of the node that shows it.

#include <span>
#include <string>
#include <unordered_map>

#include "io/affine.h"
#include "io/formats/model.h"

namespace clerestory {

/// Vertices and faces of one mesh, in its own frame; faces with fewer than three corners (lines, points) do not count.
struct LocalMesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corner;
  std::vector<std::uint32_t> face_begin{0};
  MaterialId material;
  std::vector<std::uint32_t> number{};  ///< of each vertex in the file, where that is another than here
};

/// The number that its writer meant: 0.001f as 0.001, and not as 0.00100000005.
double as_written(float x);

/// Each call adds the mesh once more; a mirroring transform turns the corners round, so that fronts stay fronts.
///
/// throws  InputError starting with `name` when a coordinate is not finite or beyond 1e12, or a corner has no vertex.
void add_mesh(Model& model, const LocalMesh& mesh, const Affine& place, SurfaceId surface, const std::string& name);

/// Names in use, and a free one near any other: "chair", "chair 2", "chair 3".
class UniqueNames {
 public:
  std::string take(const std::string& wanted);

 private:
  std::unordered_map<std::string, int> taken_;
};

}  // namespace clerestory
