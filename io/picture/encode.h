#pragma once
// Pixels -> the bytes of a picture file. OpenImageIO stays behind its module.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace clerestory {

/// throws  InputError when what writes pictures is not installed; call it before a long computation.
void require_picture_files();

/// PNG of three bytes a pixel, sRGB, row by row from the top.
///
/// throws  InputError as require_picture_files().
std::string png_bytes(int width, int height, std::span<const std::uint8_t> rgb);

/// OpenEXR of 32-bit floats, compressed without loss; one value for each channel a pixel, row by row from the top.
///
/// channels  "Y" of grey, "R", "G", "B" of colour, or names of their own.
/// throws    InputError as require_picture_files().
std::string exr_bytes(int width, int height, const std::vector<std::string>& channels, std::span<const float> value);

}  // namespace clerestory
