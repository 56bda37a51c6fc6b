#pragma once
// Rays against the triangles of a PatchSet. Embree stays inside.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/model/patch_set.h"

namespace clerestory {

struct Ray {
  Vec3 origin;     ///< already lifted off its surface, see RayScene::lift() [m]
  Vec3 direction;  ///< unit
};

/// What a ray met first, mirrors apart.
struct Hit {
  PatchId patch;                ///< the side it met; invalid when it escaped, or met a side that takes no part
  TriangleId triangle;          ///< invalid when it escaped
  float distance = 0;           ///< along the unit direction [m]
  Spectrum transmittance{1.0};  ///< of glass and mirrors on the way

  float first = 0;         ///< distance to the first surface, be it a mirror [m]
  bool reflected = false;  ///< by mirrors on the way
  Ray leg;                 ///< when reflected: the last part of the way; `distance` is its length then

  bool escaped() const { return !triangle.valid(); }
  /// Direction [unit] in which `ray` arrived here, and where that is.
  const Vec3& direction(const Ray& ray) const { return reflected ? leg.direction : ray.direction; }
  Vec3 position(const Ray& ray) const {
    return (reflected ? leg.origin : ray.origin) + direction(ray) * static_cast<double>(distance);
  }
};

/// A plane with mirrors in it.
struct MirrorPlane {
  Vec3 normal;        ///< unit
  double offset = 0;  ///< dot(normal, x) = offset in the plane [m]

  Vec3 image_of(const Vec3& x) const { return x - normal * (2 * (dot(normal, x) - offset)); }
  Vec3 image_of_direction(const Vec3& d) const { return d - normal * (2 * dot(normal, d)); }
};

/// Sixteen segments for one packet, as separate coordinates; both ends already lifted off their surfaces.
struct SegmentPacket {
  alignas(64) std::array<float, 16> from_x, from_y, from_z, to_x, to_y, to_z;

  void set(int lane, const Vec3& from, const Vec3& to) {
    const auto k = static_cast<std::size_t>(lane);
    from_x[k] = static_cast<float>(from.x), from_y[k] = static_cast<float>(from.y);
    from_z[k] = static_cast<float>(from.z), to_x[k] = static_cast<float>(to.x);
    to_y[k] = static_cast<float>(to.y), to_z[k] = static_cast<float>(to.z);
  }
};

/// Read-only, thread safe. Opaque triangles block; glass takes its share, by the
/// angle (glass_sheet.h); mirrors turn first_hit() into another direction, up to 64 times. Knows triangles only, so it
/// stays valid when make_patches() changes which sides take part.
class RayScene {
 public:
  /// Deterministic for any thread count: the tree is built by one thread.
  explicit RayScene(const PatchSet& patches);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// First surface met, `patches` telling which side takes part as which patch.
  Hit first_hit(const PatchSet& patches, const Ray& ray) const;
  /// The same for rays that go nearly the same way, in packets of 16; scattered ones are faster one by one.
  void first_hits(const PatchSet& patches, std::span<const Ray> rays, std::span<Hit> hits) const;

  /// Distance to the first surface that is not glass; infinite when there is none [m].
  double first_surface(const Ray& ray) const;

  /// Bit k is set when nothing opaque blocks segment k; glass is ignored. `active` has a bit for each segment to test.
  std::uint16_t visible16(const SegmentPacket& segments, std::uint16_t active = 0xffff) const;

  /// Whether nothing opaque blocks one segment; glass is ignored.
  bool visible(const Vec3& from, const Vec3& to) const;

  /// Share of light that passes from `from` to `to` (both lifted): 0 when something opaque blocks.
  Spectrum transmittance(const Vec3& from, const Vec3& to) const;

  /// Share that glass lets through between two points that see each other; 1 without glass.
  Spectrum glass_transmittance(const Vec3& from, const Vec3& to) const;

  /// Share of light that gets to `from` by that mirror, from a light whose image behind it is at `image`: 0 when the
  /// way meets no such mirror or something blocks it before or after.
  Spectrum transmittance_by_mirror(const Vec3& from, const Vec3& image, std::uint32_t mirror) const;

  bool has_glass() const;
  bool has_mirrors() const;
  /// The planes of mirrors, no more than 64 of them: rays are reflected by all, luminaires have images in these.
  const std::vector<MirrorPlane>& mirrors() const;
  /// Distance by which ray ends are lifted along their surface's normal, so that rounding to float cannot put them
  /// behind it: a few units in the last place at the rim of the scene [m].
  double lift() const;
  /// Length of the diagonal of the bounding box [m].
  double diameter() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clerestory
