// Part of the module that OpenImageIO is behind: pictures out.

#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "io/formats/decode_image.h"

namespace {

bool encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels, void* to, clerestory::PutBytes* put) {
  OIIO::attribute("threads", 1), OIIO::attribute("exr_threads", -1);  // none, so that later forks are safe
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(format);
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!out || !out->supports("ioproxy") || !out->set_ioproxy(&memory)) return false;
  if (!out->open(std::string("picture.") + format, spec)) return false;
  if (!out->write_image(spec.format, pixels) || !out->close()) return false;
  put(to, bytes.data(), bytes.size());
  return true;
}

}  // namespace

extern "C" [[gnu::visibility("default")]] bool clerestory_encode_png(int width, int height, const std::uint8_t* rgb,
                                                                     void* to, clerestory::PutBytes* put) {
  return encode("png", OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8), rgb, to, put);
}

extern "C" [[gnu::visibility("default")]] bool clerestory_encode_exr(int width, int height, const char* const* channels,
                                                                     std::size_t n, const float* value, void* to,
                                                                     clerestory::PutBytes* put) {
  OIIO::ImageSpec spec(width, height, static_cast<int>(n), OIIO::TypeDesc::FLOAT);
  spec.channelnames.assign(channels, channels + n);
  spec.attribute("compression", "zip");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // else it is now, and no two files are the same
  return encode("exr", spec, value, to, put);
}
