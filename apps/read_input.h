#pragma once
// The input of every command, read until Ctrl-C.

#include "apps/console.h"
#include "io/read_scene.h"

namespace clerestory {

/// As read_scene().
/// throws  Interrupted after Ctrl-C, where reading takes long.
Scene read_input(const std::string& input, ReadOptions options, const Console& console);

}  // namespace clerestory
