// Part of the module that OpenImageIO is behind: pictures out.

#include <memory>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "io/formats/decode_image.h"

extern "C" [[gnu::visibility("default")]] bool clerestory_encode_png(int width, int height, const std::uint8_t* rgb,
                                                                     void* to, clerestory::PutBytes* put) {
  OIIO::attribute("threads", 1);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create("png");
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  if (!out || !out->supports("ioproxy") || !out->set_ioproxy(&memory)) return false;
  if (!out->open("chart.png", OIIO::ImageSpec(width, height, 3, OIIO::TypeDesc::UINT8))) return false;
  if (!out->write_image(OIIO::TypeDesc::UINT8, rgb) || !out->close()) return false;
  put(to, bytes.data(), bytes.size());
  return true;
}
