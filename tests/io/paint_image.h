#pragma once
// Image files for tests.

#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "io/formats/run_apart.h"

namespace clerestory {

/// Writes a picture, row by row from the top; the extension says the format. In a child, as the reader's child must not
/// inherit the threads of OpenEXR. pixels: width * height * channels numbers, encoded as the file shall hold them.
inline bool paint_image(const std::string& file, int width, int height, int channels, const std::vector<float>& pixels,
                        OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT) {
  return run_apart(
             [&] {
               const auto out = OIIO::ImageOutput::create(file);
               OIIO::ImageSpec spec(width, height, channels, type);
               spec.attribute("oiio:UnassociatedAlpha", 1);
               const bool written = out && out->open(file, spec) &&
                                    out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()) && out->close();
               return std::string(written ? "written" : "failed");
             },
             {}) == "written";
}

}  // namespace clerestory
