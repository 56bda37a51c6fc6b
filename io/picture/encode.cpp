#include "io/picture/encode.h"

#include <stdexcept>

#include "io/formats/decode_image.h"
#include "io/formats/image_module.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

template <class Function>
Function* encoder(const char* symbol) {
  void* function = image_function(symbol);
  if (!function)
    throw InputError(text("a picture cannot be written: ", kDecodeImageModule,
                          " or what it needs is not installed; install Clerestory with OpenImageIO."));
  return reinterpret_cast<Function*>(function);
}

}  // namespace

void require_picture_files() { encoder<EncodePng>(kEncodePngSymbol); }

std::string png_bytes(int width, int height, std::span<const std::uint8_t> rgb) {
  std::string bytes;
  if (!encoder<EncodePng>(kEncodePngSymbol)(width, height, rgb.data(), &bytes, append_bytes))
    throw std::runtime_error("OpenImageIO could not write a PNG");
  return bytes;
}

std::string exr_bytes(int width, int height, const std::vector<std::string>& channels, std::span<const float> value) {
  std::vector<const char*> names;
  for (const std::string& name : channels) names.push_back(name.c_str());
  std::string bytes;
  if (!encoder<EncodeExr>(kEncodeExrSymbol)(width, height, names.data(), names.size(), value.data(), &bytes,
                                            append_bytes))
    throw std::runtime_error("OpenImageIO could not write an EXR");
  return bytes;
}

}  // namespace clerestory
