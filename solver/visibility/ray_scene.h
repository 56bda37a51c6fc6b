#pragma once
// Rays against the triangles of a PatchSet. Embree stays inside.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "solver/model/patch_set.h"

namespace clerestory {

/// What a ray met first.
struct Hit {
  PatchId patch;                ///< the side it met; invalid when it escaped, or met a side that takes no part
  TriangleId triangle;          ///< invalid when it escaped
  float distance = 0;           ///< along the unit direction [m]
  Spectrum transmittance{1.0};  ///< of the glass it passed on the way

  bool escaped() const { return !triangle.valid(); }
};

/// Where a ray starts: a point of a patch, or in free space when the triangle is invalid.
struct RayStart {
  Vec3 point;           ///< local frame [m]
  Vec3 normal;          ///< side the ray leaves from; zero in free space
  TriangleId triangle;  ///< never met by the ray
};

/// Sixteen segments for one packet, as separate coordinates. Ends are pulled in a little, so that the surfaces they
/// lie on do not block.
struct SegmentPacket {
  alignas(64) std::array<float, 16> from_x, from_y, from_z, to_x, to_y, to_z;
};

/// Read-only, thread safe. Opaque triangles block; glass takes its share.
class RayScene {
 public:
  explicit RayScene(const PatchSet& patches);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// First surface met from `start` along the unit `direction`.
  Hit first_hit(const PatchSet& patches, const RayStart& start, const Vec3& direction) const;

  /// First surfaces met by several rays from one start.
  void first_hits(const PatchSet& patches, const RayStart& start, std::span<const Vec3> directions,
                  std::span<Hit> hits) const;

  /// Share of light that passes from start to `end` (0 when something opaque blocks), per channel.
  Spectrum transmittance(const PatchSet& patches, const RayStart& start, const Vec3& end) const;
  /// The same to infinity along the unit `direction`.
  Spectrum transmittance_to_infinity(const PatchSet& patches, const RayStart& start, const Vec3& direction) const;

  /// Bit k is set when nothing opaque blocks segment k of the packet; glass is ignored. `active` has a bit for each
  /// segment that counts.
  std::uint16_t visible16(const SegmentPacket& segments, std::uint16_t active = 0xffff) const;

  bool has_glass() const;
  /// Largest distance between two points of the scene [m].
  double diameter() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clerestory
