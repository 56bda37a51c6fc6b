#pragma once
// Where the rays of a bundle leave, and which way.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/random_stream.h"

namespace clerestory {

/// Points of a bundle, of place and direction: a net in four dimensions, made once. Each receiver shifts it by its own
/// random digits, which keeps its strata. Points are in the order of 2 x 2, 4 x 4, ... cells of direction; the shift
/// only swaps cells, so sixteen in a row still go about the same way.
class BundleNet {
 public:
  explicit BundleNet(int count, std::uint64_t seed) {
    for (int k = 0; k < count; ++k) {
      const auto u = sobol4(static_cast<std::uint32_t>(k), seed);
      Point& x = points_.emplace_back();
      for (std::size_t d = 0; d < 4; ++d) x[d] = static_cast<std::uint32_t>(u[d] * 0x1p32);
    }
    std::sort(points_.begin(), points_.end(), [](const Point& a, const Point& b) { return cell(a) < cell(b); });
  }
  std::array<double, 4> operator()(std::size_t k, std::uint64_t key) const {
    const std::uint64_t a = mix_bits(key), b = mix_bits(key + 0x9e3779b97f4a7c15ULL);
    const Point& x = points_[k];
    return {unit(x[0] ^ low(a)), unit(x[1] ^ high(a)), unit(x[2] ^ low(b)), unit(x[3] ^ high(b))};
  }

 private:
  using Point = std::array<std::uint32_t, 4>;
  static constexpr std::uint32_t low(std::uint64_t x) { return static_cast<std::uint32_t>(x); }
  static constexpr std::uint32_t high(std::uint64_t x) { return static_cast<std::uint32_t>(x >> 32); }
  static constexpr double unit(std::uint32_t x) { return static_cast<double>(x) * 0x1p-32; }
  static std::uint64_t cell(const Point& x) {
    std::uint64_t code = 0;
    for (int bit = 31; bit >= 0; --bit) code = code << 2 | (x[0] >> bit & 1u) << 1 | (x[1] >> bit & 1u);
    return code;
  }
  std::vector<Point> points_;
};

}  // namespace clerestory
