#include "io/formats/decode_image.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include <OpenImageIO/filesystem.h>
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

using Sums = std::array<double, 3>;

double linear_of_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

/// What each value of a whole-number type is in linear light.
template <class T>
std::vector<double> linear_values(bool is_srgb) {
  constexpr double kMost = std::numeric_limits<T>::max();
  std::vector<double> linear(std::size_t{std::numeric_limits<T>::max()} + 1);
  for (std::size_t i = 0; i < linear.size(); ++i) {
    const double v = static_cast<double>(i) / kMost;
    linear[i] = is_srgb ? linear_of_srgb(v) : v;
  }
  return linear;
}

/// Sums over all pixels; false when the file breaks off.
template <class T>
bool add_up(OIIO::ImageInput& in, std::size_t pixels, int channels, bool is_srgb, Sums& sums) {
  const auto n = static_cast<std::size_t>(channels);
  std::vector<T> values(n * pixels);
  if (!in.read_image(0, 0, 0, channels, OIIO::BaseTypeFromC<T>::value, values.data())) return false;
  if constexpr (std::is_integral_v<T>) {
    const std::vector<double> linear = linear_values<T>(is_srgb);
    for (std::size_t i = 0; i < values.size(); ++i) sums[i % n] += linear[values[i]];
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) sums[i % n] += double{values[i]};
  }
  return true;
}

/// What is wrong, or nothing and the mean.
std::string mean_colour(const std::string& file, const void* bytes, std::size_t size, const std::string& format,
                        Sums& mean) {
  OIIO::attribute("threads", 1);
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
  if (!in) return "is a " + format + " image, which is not read";
  OIIO::Filesystem::IOMemReader memory(bytes, size);
  OIIO::ImageSpec spec, wishes;
  wishes.attribute("oiio:UnassociatedAlpha", 1);  // colours as they are stored, and not darkened by their alpha
  if (size > 0 && !in->set_ioproxy(&memory)) return "is a " + format + " image inside of the model, which is not read";
  if (!in->open(file.empty() ? "image." + format : file, spec, wishes)) return "is damaged";
  if (spec.width <= 0 || spec.height <= 0 || spec.depth != 1 || spec.nchannels < 1) return "has no pixels";
  const auto width = static_cast<std::size_t>(spec.width), height = static_cast<std::size_t>(spec.height);
  const std::size_t pixels = width * height;
  if (pixels > kMostPixels) return dimensions(width, height) + "at most 33554432 are read";
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  const bool is_srgb =
      std::string(spec.get_string_attribute("oiio:ColorSpace", "sRGB")).find("inear") == std::string::npos;
  Sums sums{};
  const bool is_whole =
      spec.format == OIIO::TypeDesc::UINT8    ? add_up<std::uint8_t>(*in, pixels, channels, is_srgb, sums)
      : spec.format == OIIO::TypeDesc::UINT16 ? add_up<std::uint16_t>(*in, pixels, channels, is_srgb, sums)
                                              : add_up<float>(*in, pixels, channels, false, sums);
  if (!is_whole) return "is damaged or cut short";
  for (std::size_t k = 0; k < 3; ++k) mean[k] = sums[channels == 1 ? 0 : k] / static_cast<double>(pixels);
  return "";
}

}  // namespace
}  // namespace clerestory

extern "C" [[gnu::visibility("default")]] void clerestory_image_mean(const char* file, const void* bytes,
                                                                     std::size_t size, const char* format, void* to,
                                                                     clerestory::PutBytes* put) {
  clerestory::Sums mean{};
  const std::string problem = clerestory::mean_colour(file, bytes, size, format, mean);
  put(to, problem.empty() ? "m" : "e", 1);
  if (problem.empty())
    put(to, mean.data(), sizeof mean);
  else
    put(to, problem.data(), problem.size());
}

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
