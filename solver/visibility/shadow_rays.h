#pragma once
// Shadow rays in packets of sixteen.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Segments wait until there are sixteen; then those that nothing opaque blocks arrive, in the order in which they were
/// sent: arrive(load, passes), with what glass lets pass.
///
/// Load    what a segment carries.
template <class Load, class Arrive>
class ShadowRays {
 public:
  ShadowRays(const RayScene& rays, Arrive arrive) : rays_(rays), arrive_(std::move(arrive)) {}

  /// Both ends are off their surfaces.
  void send(const Vec3& from, const Vec3& to, const Load& load) {
    packet_.set(static_cast<int>(count_), from, to);
    loads_[count_++] = load;
    if (count_ == kLanes) trace();
  }
  /// Lets the rest arrive; call it at the end, and wherever a coherent group ends.
  void trace() {
    unsigned visible = 0;
    if (count_ < kFewest)
      for (std::size_t k = 0; k < count_; ++k)
        visible |= (rays_.visible(packet_.from[k], packet_.to[k]) ? 1u : 0u) << k;
    else
      visible = rays_.visible16(packet_, static_cast<std::uint16_t>((1u << count_) - 1));
    const unsigned by_glass = rays_.meets_glass(packet_, static_cast<std::uint16_t>(visible));
    for (; visible; visible &= visible - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(visible));
      arrive_(loads_[k],
              (by_glass >> k) & 1 ? rays_.glass_transmittance(packet_.from[k], packet_.to[k]) : Spectrum(1.0));
    }
    count_ = 0;
  }

 private:
  static constexpr std::size_t kLanes = 16, kFewest = 3;  ///< fewer cost less as single rays
  const RayScene& rays_;
  Arrive arrive_;
  SegmentPacket packet_;
  std::array<Load, kLanes> loads_;
  std::size_t count_ = 0;
};

template <class Load, class Arrive>
ShadowRays<Load, Arrive> shadow_rays(const RayScene& rays, Arrive arrive) {
  return {rays, std::move(arrive)};
}

/// Whether any of the segments that segment_of(k, from, to) gives for k < count is free, glass apart; it returns false
/// where there is none.
template <class SegmentOf>
bool any_visible(const RayScene& rays, std::uint32_t count, const SegmentOf& segment_of) {
  for (std::uint32_t first = 0; first < count; first += 16) {
    SegmentPacket packet;
    unsigned active = 0;
    for (std::uint32_t lane = 0; lane < 16 && first + lane < count; ++lane) {
      Vec3 from, to;
      if (!segment_of(first + lane, from, to)) continue;
      packet.set(static_cast<int>(lane), from, to);
      active |= 1u << lane;
    }
    if (active && rays.visible16(packet, static_cast<std::uint16_t>(active))) return true;
  }
  return false;
}

}  // namespace clerestory
