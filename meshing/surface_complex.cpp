#include "meshing/surface_complex.h"

#include "solver/model/error.h"

namespace clerestory {

bool FaceComplex::has_area(const std::array<std::uint32_t, 3>& c) const {
  if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) return false;
  const Vec3 a = vertices[c[0]], b = vertices[c[1]], d = vertices[c[2]];
  const double longest = std::max({length(b - a), length(d - b), length(a - d)});
  const double height = length(cross(b - a, d - a)) / longest;
  return height > std::min(allowed.contact, 0.1 * allowed.local_share * longest);
}

void CrowdLimit::check(std::size_t count, const FaceComplex& complex) const {
  if (count <= most) return;
  throw InputError(complex.file + ": of its " + std::to_string(complex.faces.size()) + " faces more than " +
                   std::to_string(most) + " " + std::string(what) +
                   ", the most for a model of that size; remove copies that lie in each other, or give the model in "
                   "parts that do not cross.");
}

}  // namespace clerestory
