#pragma once
// File -> Scene.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/model/scene.h"

namespace clerestory {

/// What the command line says about a model given directly; a scene file says it itself.
/// times: of a scene file, see Scene::times.
struct ReadOptions {
  std::optional<std::string> unit{};   ///< m | cm | mm | ft | in
  std::optional<std::string> up{};     ///< y | z
  std::optional<std::string> sky{};    ///< NAME[:LUX]
  std::vector<Moment> times{};         ///< in place of the scene file's own; empty: that
  std::optional<std::string> gloss{};  ///< model: of materials that the scene file does not describe
  bool for_a_year = false;  ///< of a scene file's daylight only what is there in any hour: place, north, and the ground
};

/// Reads a scene file (.json) or a model (.obj .glb .gltf .ply .stl .off .dae .fbx .ifc) into metres, z up.
///
/// throws  InputError naming file, place (line or element), value, what is allowed and what to do.
Scene read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace clerestory
