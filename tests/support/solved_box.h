#pragma once
// A room as it is after its solve, without one: for what is made of results.

#include <functional>
#include <string>

#include "solver/model/material.h"
#include "solver/model/scene_around.h"
#include "tests/support/box_scene.h"

namespace clerestory {

struct SolvedBox {
  BoxScene box{};
  /// Irradiance [W/m2] at a point of the walls; empty: what the solution has, the same everywhere. Needs: linear, where
  /// values between points are asked for.
  std::function<double(const Vec3&)> E{};
  SceneAround around{};
  std::vector<Material> more_materials{};  ///< from 1 on, of panes
  std::vector<std::string> warnings{};     ///< of its solve
  std::size_t squares = 4;                 ///< a side of each wall, of two triangles each

  /// Writes room.obj, room.json and room.vtp; returns the path of the last.
  std::string write(const TempFolder& folder) const;
};

}  // namespace clerestory
