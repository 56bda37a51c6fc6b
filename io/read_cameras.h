#pragma once
// Cameras that the models of a scene carry.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory {

/// In the scene's frame, z up, metres.
struct SceneCamera {
  std::vector<std::string> names;        ///< what it may be called by
  Vec3 eye, forward, up;                 ///< [m]; unit
  std::optional<double> vertical_angle;  ///< of a perspective [rad]
  double half_height = 0;                ///< of an orthographic picture [m]
};

/// Of a glTF file, or of all glTF files that a scene file names, each put where the scene puts it.
///
/// throws  InputError as read_scene(), and when a file is not there.
std::vector<SceneCamera> read_cameras(const std::filesystem::path& scene);

}  // namespace clerestory
