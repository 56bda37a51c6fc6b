#pragma once
// Scenes and settings made by a program are checked like those of files.

#include "pipeline/settings.h"
#include "solver/model/scene.h"

namespace clerestory {

/// throws  InputError that names what is wrong, its value and what is allowed: numbers that are none, reflectances that
///         a wall cannot have, faces without a vertex or material, luminaires without a web, directions of no length,
///         settings out of range.
void require_valid(const Scene& scene, const Settings& settings);

}  // namespace clerestory
