#pragma once
// Model <-> bytes, to hand it from one process to another.

#include <string>
#include <string_view>

#include "io/formats/model.h"

namespace clerestory {

std::string to_bytes(const Model& model);

/// throws  std::runtime_error when the bytes are not what to_bytes made, or an index in them is out of range.
Model from_bytes(std::string_view bytes);

}  // namespace clerestory
