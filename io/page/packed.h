#pragma once
// Bytes -> text that a page carries: deflated, in base 64. VTK stays inside.

#include <cstdint>
#include <span>
#include <string>

namespace clerestory {

std::string base64(std::span<const std::uint8_t> bytes);

/// base64 of a zlib stream, which DecompressionStream('deflate') of a browser takes.
std::string packed(std::span<const std::uint8_t> bytes);

/// The same of numbers in the machine's order of bytes, those of equal weight together, which deflate better: all
/// first bytes, all second bytes, ...
template <class Number>
std::string packed_by_bytes(std::span<const Number> numbers) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(numbers.data());
  const std::size_t n = numbers.size();
  std::string planes(n * sizeof(Number), '\0');
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < sizeof(Number); ++k)
      planes[k * n + i] = static_cast<char>(bytes[i * sizeof(Number) + k]);
  return packed({reinterpret_cast<const std::uint8_t*>(planes.data()), planes.size()});
}

}  // namespace clerestory
