#pragma once
// Pictures of the whole sphere of directions, as cameras and renderers write them.

#include <filesystem>
#include <string>
#include <vector>

#include "solver/model/sky_image.h"

namespace clerestory {

/// Reads an equirectangular .hdr or .exr in cd/m2. The middle of the picture looks north, its right edge of the middle
/// east, its top row up; middle_deg is left at 0.
///
/// throws  InputError: another format, not twice as wide as high, more than 64 million pixels, pixels that are not
///         finite, a damaged file. Negative pixels count as dark, with a warning.
/// The file is read in a child process (see run_apart.h): a damaged one may crash what decodes it.
SkyImage read_sky_image(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace clerestory
