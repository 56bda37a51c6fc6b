#pragma once
// Random numbers keyed by what is estimated, never by the thread: the same key gives the same numbers.

#include <array>
#include <cstdint>

namespace clerestory {

/// 64-bit finaliser of good avalanche. Source: Stafford's variant 13 of the MurmurHash3 mixer.
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9ULL;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}
constexpr std::uint64_t stream_key(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0) {
  return mix_bits(mix_bits(mix_bits(seed + 0x9e3779b97f4a7c15ULL) ^ a) + 0x9e3779b97f4a7c15ULL * (b + 1));
}

/// Independent uniform numbers: splitmix64, period 2^64.
class RandomStream {
 public:
  explicit constexpr RandomStream(std::uint64_t key) : state_(key) {}
  constexpr RandomStream(std::uint64_t seed, std::uint64_t a, std::uint64_t b = 0) : state_(stream_key(seed, a, b)) {}
  constexpr std::uint64_t bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15ULL); }
  /// Uniform in [0, 1).
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

 private:
  std::uint64_t state_;
};

/// Point `index` of a Sobol sequence in four dimensions, Owen-scrambled by `key`: stratified over every prefix of 2^k
/// points, and may be continued. Each coordinate is in [0, 1), uniform over keys.
/// Source: Joe & Kuo direction numbers; Burley, "Practical hash-based Owen scrambling", JCGT 2020.
std::array<double, 4> sobol4(std::uint32_t index, std::uint64_t key);

}  // namespace clerestory
