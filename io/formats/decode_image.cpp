#include "io/formats/decode_image.h"

#include <memory>
#include <string>
#include <vector>

#include <OpenImageIO/imageio.h>

namespace clerestory {
namespace {

constexpr std::size_t kMostPixels = 32u << 20;

std::string dimensions(std::size_t width, std::size_t height) {
  return "has " + std::to_string(width) + " x " + std::to_string(height) + " pixels; ";
}

/// What is wrong, or nothing and the pixels.
std::string decode(const std::string& file, const std::string& format, std::size_t& width, std::size_t& height,
                   std::vector<float>& pixels) {
  OIIO::attribute("threads", 1);
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!in || !in->open(file, spec)) return "is damaged or no " + format + " image";
  if (spec.width <= 0 || spec.height <= 0 || spec.depth != 1 || spec.nchannels < 1) return "has no pixels";
  width = static_cast<std::size_t>(spec.width), height = static_cast<std::size_t>(spec.height);
  if (width * height > kMostPixels) return dimensions(width, height) + "at most 8192 x 4096 are read";
  if (width != 2 * height) return dimensions(width, height) + "a sky is equirectangular, twice as wide as high";
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  pixels.resize(3 * width * height);
  // A grey image goes into the first of three channels.
  const OIIO::stride_t stride = 3 * sizeof(float);
  if (!in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels.data(), stride))
    return "is damaged or cut short";
  for (std::size_t i = 0; channels == 1 && i < pixels.size(); i += 3) pixels[i + 1] = pixels[i + 2] = pixels[i];
  return "";
}

}  // namespace
}  // namespace clerestory

extern "C" [[gnu::visibility("default")]] void clerestory_decode_image(const char* file, const char* format, void* to,
                                                                       void (*put)(void*, const void*, std::size_t)) {
  std::size_t width = 0, height = 0;
  std::vector<float> pixels;
  const std::string problem = clerestory::decode(file, format, width, height, pixels);
  put(to, problem.empty() ? "i" : "e", 1);
  if (!problem.empty()) {
    put(to, problem.data(), problem.size());
    return;
  }
  put(to, &width, sizeof width), put(to, &height, sizeof height);
  put(to, pixels.data(), pixels.size() * sizeof(float));
}
