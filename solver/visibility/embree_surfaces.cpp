#include "solver/visibility/embree_surfaces.h"

#include <new>

#include <embree3/rtcore.h>

namespace clerestory {

EmbreeSurfaces::~EmbreeSurfaces() {
  if (handle) rtcReleaseScene(handle);
}

void EmbreeSurfaces::build(const EmbreeDevice& device, const PatchSet& patches, bool glass) {
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

void EmbreeSurfaces::visit_near(const Vec3& p, double reach, const std::function<void(TriangleId)>& found) const {
  if (of_primitive.empty()) return;
  struct Visit {
    const EmbreeSurfaces& surfaces;
    const std::function<void(TriangleId)>& found;
  } visit{*this, found};
  RTCPointQuery query{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0,
                      static_cast<float>(reach)};
  RTCPointQueryContext c;
  rtcInitPointQueryContext(&c);
  const auto note = [](RTCPointQueryFunctionArguments* args) {
    const auto& to = *static_cast<const Visit*>(args->userPtr);
    to.found(TriangleId{to.surfaces.of_primitive[args->primID]});
    return false;  // the reach stays
  };
  rtcPointQuery(handle, &query, &c, note, &visit);
}

}  // namespace clerestory
