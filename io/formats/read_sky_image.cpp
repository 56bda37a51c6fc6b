#include "io/formats/read_sky_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/formats/decode_image.h"
#include "io/formats/image_module.h"
#include "io/formats/run_apart.h"
#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 2ull << 30;

/// What DecodeImage hands over, as one string.
std::string decode(const std::string& file, const std::string& format) {
  void* function = image_function(kDecodeImageSymbol);
  if (!function) return 'e' + no_image_module();
  std::string answer;
  reinterpret_cast<DecodeImage*>(function)(file.c_str(), format.c_str(), &answer, append_bytes);
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
    const ApartLimits limits{.time = std::chrono::seconds(60), .memory_bytes = std::uint64_t{4} << 30};
    answer = run_apart([&] { return decode(file.string(), extension == ".hdr" ? "hdr" : "openexr"); }, limits);
  } catch (const ApartFailure& failure) {
    throw InputError(text(name, ": reading it ", failure.what(), "; the file is damaged, save or download it again"));
  }
  if (answer.empty() || answer[0] != 'i') {
    throw InputError(text(name, ": ", answer.empty() ? "cannot be read" : answer.substr(1)));
  }

  SkyImage image;
  std::string_view rest = std::string_view(answer).substr(1);
  const auto take = [&](void* to, std::size_t bytes) {
    if (bytes > rest.size())
      throw InputError(text(name, ": reading it breaks off; the file is damaged, save or download it again"));
    std::memcpy(to, rest.data(), bytes), rest.remove_prefix(bytes);
  };
  take(&image.width, sizeof image.width), take(&image.height, sizeof image.height);
  const std::size_t most = rest.size() / (3 * sizeof(float));  // pixels that are there, whatever the child says
  if (image.height == 0 || image.width > most / image.height)
    throw InputError(text(name, ": reading it breaks off; the file is damaged, save or download it again"));
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
