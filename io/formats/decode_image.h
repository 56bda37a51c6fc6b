#pragma once
// The door to OpenImageIO: a module of its own, loaded when a scene has a sky image. OpenImageIO brings some 250
// libraries along; linked into the program they would cost every start half a second.

#include <cstddef>

namespace clerestory {

/// Pixels of a file as the module hands them over: 'i', width and height (std::size_t), and three floats a pixel, row
/// by row from the top; or 'e' and what is wrong.
///
/// format  "hdr" or "openexr".  put(to, bytes, n) is called for each piece.
using DecodeImage = void(const char* file, const char* format, void* to,
                         void (*put)(void* to, const void* bytes, std::size_t n));

inline constexpr const char* kDecodeImageModule = "clerestory_images.so";
inline constexpr const char* kDecodeImageSymbol = "clerestory_decode_image";

}  // namespace clerestory
