#pragma once
// Triangles and rays as Embree has them. Included by sources of this folder only: Embree stays inside.

#include <cstdint>
#include <vector>

#include <embree3/rtcore.h>

#include "solver/visibility/embree_device.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// One Embree scene over some triangles of the PatchSet; primitive k is triangle of_primitive[k].
struct Surfaces {
  RTCScene handle = nullptr;
  std::vector<std::uint32_t> of_primitive;
  Surfaces() = default;
  Surfaces(const Surfaces&) = delete;
  Surfaces& operator=(const Surfaces&) = delete;
  ~Surfaces() {
    if (handle) rtcReleaseScene(handle);
  }

  /// glass: of the panes, or of all other triangles.
  void build(const EmbreeDevice& device, const PatchSet& patches, bool glass);

  /// Calls found(triangle) for the triangles whose boxes come within `reach` of p.
  template <class Found>
  void visit_near(const Vec3& p, double reach, const Found& found) const {
    struct Visit {
      const Surfaces* surfaces;
      const Found* found;
    } visit{this, &found};
    RTCPointQuery query{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0,
                        static_cast<float>(reach)};
    RTCPointQueryContext c;
    rtcInitPointQueryContext(&c);
    const auto note = [](RTCPointQueryFunctionArguments* args) {
      const auto& to = *static_cast<const Visit*>(args->userPtr);
      (*to.found)(TriangleId{to.surfaces->of_primitive[args->primID]});
      return false;  // the reach stays
    };
    if (!of_primitive.empty()) rtcPointQuery(handle, &query, &c, note, &visit);
  }
};

RTCIntersectContext context(RTCIntersectContextFlags flags);

/// One ray that met nothing yet.
RTCRayHit ray_hit(const Vec3& origin, const Vec3& direction, float near_t, float far_t);

/// Segments as rays of length 1. Without 16 lanes of hardware Embree reads lanes that are not valid too: they must hold
/// numbers.
RTCRay16 ray16(const SegmentPacket& s, std::uint16_t active, int* valid);

}  // namespace clerestory
