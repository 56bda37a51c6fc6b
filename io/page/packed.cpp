#include "io/page/packed.h"

#include <bit>

#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkZLibDataCompressor.h>

namespace clerestory {

static_assert(std::endian::native == std::endian::little, "pages are read in this order");

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) three = three << 8 | (k < n ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) out += k <= n ? kDigits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string packed(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return {};
  vtkNew<vtkZLibDataCompressor> zlib;
  zlib->SetCompressionLevel(6);
  const auto deflated = vtk::TakeSmartPointer(zlib->Compress(bytes.data(), bytes.size()));
  return base64({deflated->GetPointer(0), static_cast<std::size_t>(deflated->GetNumberOfValues())});
}

}  // namespace clerestory
