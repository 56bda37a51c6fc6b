#include "solver/problem.h"

namespace clerestory {

Lights to_local_frame(const Lights& lights, const Vec3& origin) {
  Lights local = lights;
  for_each_lamp(local, [&](auto& lamp, std::size_t) { lamp.position -= origin; });
  return local;
}

}  // namespace clerestory
