#pragma once
// What eyes see: one-sided triangles, and panes between them. Embree stays inside.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "solver/model/vec.h"

namespace clerestory {

/// Sixteen rays in the frame of SeenSurfaces; directions of any length.
struct SightPacket {
  alignas(64) std::array<float, 16> x, y, z, dx, dy, dz, near;
  unsigned count = 0;         ///< the first so many are rays
  bool is_scattered = false;  ///< else they go nearly the same way, which is faster

  void add(const Vec3& origin, const Vec3& direction, double near_t) {
    const std::size_t k = count++;
    x[k] = static_cast<float>(origin.x), y[k] = static_cast<float>(origin.y), z[k] = static_cast<float>(origin.z);
    dx[k] = static_cast<float>(direction.x), dy[k] = static_cast<float>(direction.y);
    dz[k] = static_cast<float>(direction.z), near[k] = static_cast<float>(near_t);
  }
};

/// What each of them meets first.
struct Sights {
  static constexpr std::uint32_t kNothing = 0xffffffff;
  alignas(64) std::array<std::uint32_t, 16> triangle, pane;  ///< either one's number, or kNothing both
  std::array<float, 16> u, v;                                ///< barycentric weights of corners 1 and 2
  std::array<float, 16> distance;                            ///< in units of the direction's length
};

/// Triangles are seen from where their corners run counter-clockwise; from behind they are not there, so that of two
/// that lie in one place, a sheet's sides, each is seen from its own side. Panes are seen from both. Thread safe.
class SeenSurfaces {
 public:
  /// Cost: 1 us a triangle on one thread, 100 bytes. The answer does not depend on the number of threads.
  SeenSurfaces(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
               std::span<const std::array<Vec3, 3>> panes);
  SeenSurfaces(SeenSurfaces&&) noexcept;
  ~SeenSurfaces();

  /// Origin of the frame that rays are in: the middle, so that floats are fine enough wherever a model lies.
  const Vec3& centre() const;
  double diagonal() const;  ///< [m]
  /// How far a ray starts from what it leaves, for floats to tell [m].
  double lift() const { return 1e-6 * diagonal(); }

  void look(const SightPacket& rays, Sights& sights) const;

  /// Of one ray from a point outside of the frame, in unit direction: how far it goes to what it meets first;
  /// infinite when that is nothing [m].
  double distance(const Vec3& origin, const Vec3& direction) const;
  /// Whether what it would meet first, were triangles there from behind, is a triangle's back.
  bool meets_back(const Vec3& origin, const Vec3& direction) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clerestory
