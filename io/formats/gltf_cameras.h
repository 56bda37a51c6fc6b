#pragma once
// Cameras of a glTF file. JSON stays inside.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/affine.h"

namespace clerestory {

/// It looks along -z of its place, +y up.
struct ModelCamera {
  std::vector<std::string> names;  ///< of its node and its own; empty ones are left out
  Affine place;
  std::optional<double> yfov;  ///< full vertical angle of a perspective [rad]
  double ymag = 0;             ///< half of the height of an orthographic picture, in units of the node
};

/// throws  InputError naming the element.
std::vector<ModelCamera> read_gltf_cameras(const std::filesystem::path& file);

}  // namespace clerestory
