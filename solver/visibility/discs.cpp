#include "solver/visibility/discs.h"

#include <new>

#include <embree3/rtcore.h>

#include "solver/visibility/embree_device.h"

namespace clerestory {
namespace {

struct Context {
  RTCIntersectContext embree;
  const Discs::Passed* passed;
};

/// Tells of the disc, and lets the ray go on.
void note(const RTCFilterFunctionNArguments* args) {
  const auto& passed = *reinterpret_cast<const Context*>(args->context)->passed;
  for (unsigned k = 0; k < args->N; ++k) {
    if (args->valid[k] == 0) continue;
    passed(RTCHitN_primID(args->hit, args->N, k), double{RTCRayN_tfar(args->ray, args->N, k)});
    args->valid[k] = 0;
  }
}

}  // namespace

struct Discs::Impl {
  EmbreeDevice device;
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }
};

Discs::Discs(std::span<const Disc> discs) {
  auto impl = std::make_unique<Impl>();
  impl->scene = rtcNewScene(impl->device.handle);
  if (!discs.empty()) {
    RTCGeometry geometry = rtcNewGeometry(impl->device.handle, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
    auto* place = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                                              4 * sizeof(float), discs.size()));
    auto* normal = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), discs.size()));
    if (!place || !normal) throw std::bad_alloc();
    for (const Disc& disc : discs) {
      for (int axis = 0; axis < 3; ++axis)
        *place++ = static_cast<float>(disc.centre[axis]), *normal++ = static_cast<float>(disc.normal[axis]);
      *place++ = static_cast<float>(disc.radius);
    }
    rtcSetGeometryOccludedFilterFunction(geometry, note);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(impl->scene, geometry, 0);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(impl->scene);
  impl->device.check();
  impl_ = std::move(impl);
}
Discs::Discs(Discs&&) noexcept = default;
Discs::~Discs() = default;

void Discs::along(const Vec3& from, const Vec3& to, const Passed& passed) const {
  Context c{{}, &passed};
  rtcInitIntersectContext(&c.embree);
  c.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  const Vec3 d = to - from;
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x), ray.org_y = static_cast<float>(from.y),
  ray.org_z = static_cast<float>(from.z);
  ray.dir_x = static_cast<float>(d.x), ray.dir_y = static_cast<float>(d.y), ray.dir_z = static_cast<float>(d.z);
  ray.tnear = 0, ray.tfar = 1, ray.mask = ~0u;
  rtcOccluded1(impl_->scene, &c.embree, &ray);
}

}  // namespace clerestory
