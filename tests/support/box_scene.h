#pragma once
// Closed rooms whose answer is known: every surface alike, so B = M / (1 - rho) everywhere.

#include <string>

#include "solver/model/vec.h"
#include "tests/support/temp_folder.h"

namespace clerestory {

struct BoxScene {
  Vec3 size{4, 3, 2.5};
  Vec3 offset{};  ///< of the lowest corner [m]
  double rho = 0.5, M = 100;

  /// Writes room.obj and room.json; returns the path of the scene.
  std::string write(const TempFolder& folder) const;
  double radiosity() const { return M / (1 - rho); }
  double area() const { return 2 * (size.x * size.y + size.y * size.z + size.z * size.x); }
};

}  // namespace clerestory
