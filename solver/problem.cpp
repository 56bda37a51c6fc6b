#include "solver/problem.h"

namespace clerestory {

Lights to_local_frame(const Lights& lights, const Vec3& origin) {
  Lights local = lights;
  for (auto& lamp : local.points) lamp.position -= origin;
  for (auto& lamp : local.spots) lamp.position -= origin;
  return local;
}

}  // namespace clerestory
