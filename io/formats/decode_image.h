#pragma once
// The door to OpenImageIO: a module of its own, loaded when a scene has a sky image or textures, and when a picture is
// written. OpenImageIO brings some 250 libraries along; linked into the program they would cost every start half a
// second.

#include <cstddef>
#include <cstdint>

namespace clerestory {

/// Takes n bytes, in as many pieces as there are.
using PutBytes = void(void* to, const void* bytes, std::size_t n);

/// Pixels of a file as the module hands them over: 'i', width and height (std::size_t), and three floats a pixel, row
/// by row from the top; or 'e' and what is wrong.
///
/// format  "hdr" or "openexr".
using DecodeImage = void(const char* file, const char* format, void* to, PutBytes* put);

/// Mean colour of a file, or of `size` bytes of one: 'm' and three doubles, in linear light; or 'e' and what is wrong.
/// Whole numbers are taken as sRGB unless the file says that they are linear; alpha does not count.
///
/// format  as OpenImageIO calls it, "png".
using ImageMean = void(const char* file, const void* bytes, std::size_t size, const char* format, void* to,
                       PutBytes* put);

/// Bytes of a PNG file of three bytes a pixel, row by row from the top. False: it cannot be made.
using EncodePng = bool(int width, int height, const std::uint8_t* rgb, void* to, PutBytes* put);

/// Bytes of an OpenEXR file of `n` floats a pixel, row by row from the top. False: it cannot be made.
using EncodeExr = bool(int width, int height, const char* const* channels, std::size_t n, const float* value, void* to,
                       PutBytes* put);

inline constexpr const char* kDecodeImageModule = "clerestory_images.so";
inline constexpr const char* kDecodeImageSymbol = "clerestory_decode_image";
inline constexpr const char* kImageMeanSymbol = "clerestory_image_mean";
inline constexpr const char* kEncodePngSymbol = "clerestory_encode_png";
inline constexpr const char* kEncodeExrSymbol = "clerestory_encode_exr";

}  // namespace clerestory
