#include "io/formats/add_mesh.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {

double as_written(float x) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof(digits), x);  // as few digits as tell it from others
  double value = double{x};
  if (error == std::errc{}) std::from_chars(digits, end, value);
  return value;
}

void add_mesh(Model& model, const LocalMesh& mesh, const Affine& place, SurfaceId surface, const std::string& name) {
  constexpr std::uint32_t kUnused = 0xffffffff;
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
  PolygonSoup& soup = model.polygons;
  if (soup.vertices.size() + mesh.vertices.size() >= kMost || soup.corner.size() + mesh.corner.size() >= kMost) {
    throw InputError(text(name, ": more than 4 billion corners; leave out what light does not need"));
  }
  std::vector<std::uint32_t> place_of(mesh.vertices.size(), kUnused);
  const bool mirrors = place.mirrors();
  for (std::size_t f = 0; f + 1 < mesh.face_begin.size(); ++f) {
    const std::uint32_t begin = mesh.face_begin[f], end = mesh.face_begin[f + 1];
    if (end - begin < 3) continue;
    for (std::uint32_t k = begin; k < end; ++k) {
      const std::uint32_t v = mesh.corner[mirrors ? end - 1 - (k - begin) : k];
      if (v >= mesh.vertices.size()) {
        throw InputError(text(name, ": face ", f + 1, " of '", quotable(model.surfaces[surface]), "' uses vertex ", v,
                              " (from 0), but there are ", mesh.vertices.size()));
      }
      if (place_of[v] == kUnused) {
        const Vec3 p = place.point(mesh.vertices[v]);
        if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargestCoordinate) {
          throw InputError(text(name, ": vertex ", mesh.number.empty() ? v : mesh.number[v], " (from 0) of '",
                                quotable(model.surfaces[surface]), "' is at (", p.x, ", ", p.y, ", ", p.z,
                                "), outside [-1e12, 1e12]; is the file damaged, or drawn far from its origin?"));
        }
        place_of[v] = static_cast<std::uint32_t>(soup.vertices.size());
        soup.add_vertex(p);
      }
      soup.add_corner(place_of[v]);
    }
    soup.end_face(mesh.material, surface);
  }
}

std::string UniqueNames::take(const std::string& wanted) {
  if (taken_.try_emplace(wanted, 1).second) return wanted;
  for (;;) {
    std::string candidate = text(wanted, " ", ++taken_[wanted]);
    if (taken_.try_emplace(candidate, 1).second) return candidate;
  }
}

}  // namespace clerestory
