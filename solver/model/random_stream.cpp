#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

using Lanes [[gnu::vector_size(16)]] = std::uint32_t;  ///< by dimension

template <class Bits>
constexpr Bits reverse_bits(Bits x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
  return (x >> 16) | (x << 16);
}

/// Scrambles bit k by a hash of the bits below it: an Owen scramble of the reversed number.
template <class Bits>
constexpr Bits scramble_reversed(Bits x, Bits seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

template <class Bits>
constexpr Bits owen_scramble(Bits x, Bits seed) {
  return reverse_bits(scramble_reversed(reverse_bits(x), seed));
}

/// Sobol points for each value of each byte of the index; a point is the exclusive or over its bytes. Dimension 0 is
/// the bit reversal, the others are from primitive polynomials of degree 1, 2, 3 with initial numbers {1}, {1, 3}, {1,
/// 3, 1} of the new-joe-kuo-6 table.
struct SobolTable {
  Lanes x[4][256];  ///< by byte, its value
};

SobolTable make_table() {
  struct Polynomial {
    int degree;
    std::uint32_t coefficients, first[3];
  };
  constexpr Polynomial polynomials[3] = {{1, 0, {1, 0, 0}}, {2, 1, {1, 3, 0}}, {3, 1, {1, 3, 1}}};
  SobolTable table{};
  for (int dim = 0; dim < 3; ++dim) {
    const auto& [s, a, m] = polynomials[dim];
    std::uint32_t v[32];
    for (int i = 0; i < 32; ++i) {
      if (i < s) {
        v[i] = m[i] << (31 - i);
        continue;
      }
      v[i] = v[i - s] ^ (v[i - s] >> s);
      for (int k = 1; k < s; ++k) v[i] ^= ((a >> (s - 1 - k)) & 1u) * v[i - k];
    }
    for (int byte = 0; byte < 4; ++byte)
      for (int value = 0; value < 256; ++value)
        for (int bit = 0; bit < 8; ++bit)
          if (value >> bit & 1) table.x[byte][value][dim + 1] ^= v[8 * byte + bit];
  }
  for (std::uint32_t byte = 0; byte < 4; ++byte)
    for (std::uint32_t value = 0; value < 256; ++value) table.x[byte][value][0] = reverse_bits(value << 8 * byte);
  return table;
}

const SobolTable kTable = make_table();

}  // namespace

std::array<double, 4> sobol4(std::uint32_t index, std::uint64_t key) {
  const auto key_low = static_cast<std::uint32_t>(key), key_high = static_cast<std::uint32_t>(key >> 32);
  const std::uint32_t i = owen_scramble(index, key_low);  // shuffles the order within every power of two
  const Lanes x = kTable.x[0][i & 255] ^ kTable.x[1][i >> 8 & 255] ^ kTable.x[2][i >> 16 & 255] ^ kTable.x[3][i >> 24];
  Lanes seed;
  for (std::uint32_t dim = 0; dim < 4; ++dim)
    seed[dim] = static_cast<std::uint32_t>(mix_bits(key + 0x9e3779b97f4a7c15ULL * (dim + 1)) ^ key_high);
  const Lanes scrambled = owen_scramble(x, seed);
  std::array<double, 4> u;
  for (std::uint32_t dim = 0; dim < 4; ++dim) u[dim] = static_cast<double>(scrambled[dim]) * 0x1p-32;
  return u;
}

}  // namespace clerestory
