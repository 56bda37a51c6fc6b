#pragma once
// The module that decodes and encodes images, from the side that loads it: to decode, in a child process, see
// run_apart.h.

#include <cstddef>
#include <string>

namespace clerestory {

/// A function of the module, null when it, or what it needs, is not installed.
void* image_function(const char* symbol);

/// For functions of the module that hand bytes over: appends them to the std::string at `to`.
void append_bytes(void* to, const void* bytes, std::size_t n);

/// What to say when image_function() finds nothing.
std::string no_image_module();

}  // namespace clerestory
