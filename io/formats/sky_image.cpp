#include "io/formats/sky_image.h"

#include <cmath>
#include <cstring>

#include <OpenImageIO/imageio.h>

#include "io/formats/run_apart.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 2ull << 30;
constexpr std::size_t kMostPixels = 64u << 20;

/// 'e' and a message; or 'i', width, height and three floats a pixel.
std::string decode(const std::string& file, const std::string& format) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::create(format);
  OIIO::ImageSpec spec;
  if (!in || !in->open(file, spec)) return "eis damaged or no " + format + " image";
  if (spec.width <= 0 || spec.height <= 0 || spec.depth != 1 || spec.nchannels < 1) return "ehas no pixels";
  const auto width = static_cast<std::size_t>(spec.width), height = static_cast<std::size_t>(spec.height);
  if (width * height > kMostPixels) return text("ehas ", width, " x ", height, " pixels; at most 64 million are read");
  if (width != 2 * height) {
    return text("ehas ", width, " x ", height, " pixels; a sky is equirectangular, twice as wide as high");
  }
  const int channels = spec.nchannels >= 3 ? 3 : 1;
  std::vector<float> pixels(width * height * static_cast<std::size_t>(channels));
  if (!in->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, pixels.data())) return "eis damaged or cut short";
  std::string answer = "i";
  const auto put = [&](const void* from, std::size_t bytes) { answer.append(static_cast<const char*>(from), bytes); };
  put(&width, sizeof width), put(&height, sizeof height);
  for (std::size_t i = 0; i < pixels.size(); i += static_cast<std::size_t>(channels))
    for (std::size_t k = 0; k < 3; ++k) put(&pixels[i + (channels == 3 ? k : 0)], sizeof(float));
  return answer;
}

}  // namespace

SkyImage read_sky_image(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  check_input_file(file, kMaxBytes);
  const std::string name = short_name(file), extension = to_lower(file.extension().string());
  if (extension != ".hdr" && extension != ".exr")
    throw InputError(text(name, ": '", quotable(extension), "' is not read as a sky; known are .hdr and .exr"));
  std::string answer;
  try {
    const ApartLimits limits{.time = std::chrono::seconds(60), .memory_bytes = std::uint64_t{6} << 30};
    answer = run_apart([&] { return decode(file.string(), extension == ".hdr" ? "hdr" : "openexr"); }, limits);
  } catch (const ApartFailure& failure) {
    throw InputError(text(name, ": reading it ", failure.what(), "; the file is damaged"));
  }
  if (answer.empty() || answer[0] != 'i') throw InputError(text(name, ": ", answer.empty() ? "" : answer.substr(1)));

  SkyImage image;
  const char* from = answer.data() + 1;
  const auto take = [&](void* to, std::size_t bytes) { std::memcpy(to, from, bytes), from += bytes; };
  take(&image.width, sizeof image.width), take(&image.height, sizeof image.height);
  image.value.resize(3 * image.width * image.height);
  take(image.value.data(), image.value.size() * sizeof(float));
  std::size_t negative = 0;
  for (std::size_t i = 0; i < image.value.size(); ++i) {
    float& L = image.value[i];
    if (!std::isfinite(L) || L > 1e15f) {
      throw InputError(text(name, ": the pixel in column ", i / 3 % image.width + 1, ", row ", i / 3 / image.width + 1,
                            " has luminance ", L, "; it must be in [0, 1e15] cd/m2"));
    }
    negative += L < 0;
    L = std::max(L, 0.0f) / static_cast<float>(kWhiteEfficacy);
  }
  if (negative > 0) warnings.push_back(text(name, ": ", negative, " negative values count as 0"));
  return image;
}

}  // namespace clerestory
