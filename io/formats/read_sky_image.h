#pragma once
// Pictures of the whole sphere of directions, as cameras and renderers write them.

#include <filesystem>
#include <string>
#include <vector>

#include "solver/model/sky_image.h"

namespace clerestory {

/// Reads an equirectangular .hdr or .exr in cd/m2: the top row looks up, the middle column north, the columns to its
/// right east. middle_deg is left at 0.
///
/// throws  InputError: another format, not twice as wide as high, more than 8192 x 4096 pixels, pixels that are not
///         finite, a damaged file. Negative pixels count as dark, with a warning.
/// The file is read in a child process (see run_apart.h): a damaged one may crash what decodes it.
SkyImage read_sky_image(const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace clerestory
