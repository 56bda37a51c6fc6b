#include "meshing/surface_complex.h"

#include "solver/model/error.h"

namespace clerestory {

void CrowdLimit::check(std::size_t count, const FaceComplex& complex) const {
  if (count <= most) return;
  throw InputError(complex.file + ": of its " + std::to_string(complex.faces.size()) + " faces more than " +
                   std::to_string(most) + " " + std::string(what) +
                   ", the most for a model of that size; remove copies that lie in each other, or give the model in "
                   "parts that do not cross.");
}

}  // namespace clerestory
