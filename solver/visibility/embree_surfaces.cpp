#include "solver/visibility/embree_surfaces.h"

#include <new>

namespace clerestory {

void Surfaces::build(const EmbreeDevice& device, const PatchSet& patches, bool glass) {
  for (std::size_t t = 0; t < patches.triangle_count(); ++t)
    if (patches.front_material(TriangleId{t}).lets_rays_pass() == glass)
      of_primitive.push_back(static_cast<std::uint32_t>(t));
  handle = rtcNewScene(device.handle);
  rtcSetSceneFlags(handle, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(handle, RTC_BUILD_QUALITY_MEDIUM);
  if (!of_primitive.empty()) {
    RTCGeometry geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), patches.vertices.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(unsigned), of_primitive.size()));
    if (!vertex || !index) throw std::bad_alloc();
    for (const Vec3& v : patches.vertices)
      for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(v[axis]);
    for (const std::uint32_t t : of_primitive)
      for (const VertexId v : patches.corners[t]) *index++ = v.value;
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(handle, geometry, 0);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(handle);
  device.check();
}

RTCIntersectContext context(RTCIntersectContextFlags flags) {
  RTCIntersectContext c;
  rtcInitIntersectContext(&c);
  c.flags = flags;
  return c;
}

RTCRayHit ray_hit(const Vec3& origin, const Vec3& direction, float near_t, float far_t) {
  RTCRayHit r{};
  r.ray.org_x = static_cast<float>(origin.x), r.ray.org_y = static_cast<float>(origin.y);
  r.ray.org_z = static_cast<float>(origin.z), r.ray.dir_x = static_cast<float>(direction.x);
  r.ray.dir_y = static_cast<float>(direction.y), r.ray.dir_z = static_cast<float>(direction.z);
  r.ray.tnear = near_t, r.ray.tfar = far_t, r.ray.mask = ~0u;
  r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return r;
}

RTCRay16 ray16(const SegmentPacket& s, std::uint16_t active, int* valid) {
  RTCRay16 packet;
  for (std::size_t k = 0; k < 16; ++k) {
    const bool on = (active >> k) & 1;
    valid[k] = on ? -1 : 0;
    packet.org_x[k] = on ? s.from_x[k] : 0, packet.org_y[k] = on ? s.from_y[k] : 0;
    packet.org_z[k] = on ? s.from_z[k] : 0;
    packet.dir_x[k] = on ? s.to_x[k] - s.from_x[k] : 0, packet.dir_y[k] = on ? s.to_y[k] - s.from_y[k] : 0;
    packet.dir_z[k] = on ? s.to_z[k] - s.from_z[k] : 1;
    packet.tnear[k] = 0, packet.tfar[k] = 1, packet.time[k] = 0;
    packet.mask[k] = ~0u, packet.id[k] = 0, packet.flags[k] = 0;
  }
  return packet;
}

}  // namespace clerestory
