#pragma once
// Unit directions in 30 bits, for lists of rays that are kept.

#include <cmath>
#include <cstdint>

#include "solver/model/vec.h"

namespace clerestory {

inline constexpr int kDirectionBits = 30;

/// A grid on the octahedron |x| + |y| + |z| = 1, its lower half folded out: 0.0001 rad apart. The axes are on it, and
/// what is above the horizon stays there.
/// Source: Cigolle et al., "A survey of efficient representations for independent unit vectors", JCGT 2014.
inline std::uint32_t pack_direction(const Vec3& d) {
  constexpr double kSteps = (1 << (kDirectionBits / 2 - 1)) - 1;
  const double scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
  double u = d.x * scale, v = d.y * scale;
  if (d.z < 0) {
    const double folded = (1 - std::abs(v)) * std::copysign(1.0, u);
    v = (1 - std::abs(u)) * std::copysign(1.0, v);
    u = folded;
  }
  const auto step = [](double x) { return static_cast<std::uint32_t>(x * kSteps + kSteps + 0.5); };
  return step(u) << (kDirectionBits / 2) | step(v);
}

inline Vec3 unpack_direction(std::uint32_t packed) {
  constexpr std::uint32_t kMask = (1u << (kDirectionBits / 2)) - 1;
  constexpr double kSteps = kMask / 2;
  double u = (packed >> (kDirectionBits / 2) & kMask) / kSteps - 1, v = (packed & kMask) / kSteps - 1;
  const double z = 1 - std::abs(u) - std::abs(v);
  if (z < 0) {
    const double folded = (1 - std::abs(v)) * std::copysign(1.0, u);
    v = (1 - std::abs(u)) * std::copysign(1.0, v);
    u = folded;
  }
  return normalized({u, v, z});
}

}  // namespace clerestory
