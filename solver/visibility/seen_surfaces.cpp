#include "solver/visibility/seen_surfaces.h"

#include <limits>
#include <new>

#include <embree3/rtcore.h>

#include "solver/model/box.h"
#include "solver/visibility/embree_device.h"

namespace clerestory {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr unsigned kTriangles = 0, kPanes = 1;  // numbers of the geometries

struct Context {
  RTCIntersectContext embree;
  bool backs_are_there = false;
};

Context context(RTCIntersectContextFlags flags) {
  Context c;
  rtcInitIntersectContext(&c.embree);
  c.embree.flags = flags;
  return c;
}

/// A ray that meets a triangle's back goes on.
void pass_through_backs(const RTCFilterFunctionNArguments* args) {
  if (reinterpret_cast<const Context*>(args->context)->backs_are_there) return;
  const unsigned n = args->N;
  for (unsigned k = 0; k < n; ++k) {
    const float along = RTCHitN_Ng_x(args->hit, n, k) * RTCRayN_dir_x(args->ray, n, k) +
                        RTCHitN_Ng_y(args->hit, n, k) * RTCRayN_dir_y(args->ray, n, k) +
                        RTCHitN_Ng_z(args->hit, n, k) * RTCRayN_dir_z(args->ray, n, k);
    if (along > 0) args->valid[k] = 0;
  }
}

struct Buffers {
  float* vertex;
  unsigned* index;
  RTCGeometry geometry;
};

Buffers new_triangles(const EmbreeDevice& device, std::size_t vertices, std::size_t triangles) {
  Buffers b{};
  b.geometry = rtcNewGeometry(device.handle, RTC_GEOMETRY_TYPE_TRIANGLE);
  b.vertex = static_cast<float*>(
      rtcSetNewGeometryBuffer(b.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices));
  b.index = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(b.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles));
  if (!b.vertex || !b.index) throw std::bad_alloc();
  return b;
}

void put(float*& to, const Vec3& p) {
  for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(p[axis]);
}

void attach(RTCScene scene, RTCGeometry geometry, unsigned number) {
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene, geometry, number);
  rtcReleaseGeometry(geometry);
}

RTCRayHit one_ray(const Vec3& origin, const Vec3& direction) {
  RTCRayHit r{};
  r.ray.org_x = static_cast<float>(origin.x), r.ray.org_y = static_cast<float>(origin.y);
  r.ray.org_z = static_cast<float>(origin.z), r.ray.dir_x = static_cast<float>(direction.x);
  r.ray.dir_y = static_cast<float>(direction.y), r.ray.dir_z = static_cast<float>(direction.z);
  r.ray.tfar = kInfinity, r.ray.mask = ~0u;
  r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return r;
}

}  // namespace

struct SeenSurfaces::Impl {
  EmbreeDevice device;
  RTCScene scene = nullptr;
  Vec3 centre;
  double diagonal = 0;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }
};

SeenSurfaces::SeenSurfaces(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                           std::span<const std::array<Vec3, 3>> panes)
    : impl_(std::make_unique<Impl>()) {
  Box box = Box::around(points);
  for (const auto& pane : panes) box.add(Box::around(pane));
  if (!points.empty() || !panes.empty()) impl_->centre = box.centre(), impl_->diagonal = length(box.upper - box.lower);
  impl_->scene = rtcNewScene(impl_->device.handle);
  rtcSetSceneFlags(impl_->scene,
                   static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_MEDIUM);
  if (!triangles.empty()) {
    Buffers b = new_triangles(impl_->device, points.size(), triangles.size());
    for (const Vec3& p : points) put(b.vertex, p - impl_->centre);
    for (const auto& t : triangles)
      for (const std::uint32_t corner : t) *b.index++ = corner;
    rtcSetGeometryIntersectFilterFunction(b.geometry, pass_through_backs);
    attach(impl_->scene, b.geometry, kTriangles);
  }
  if (!panes.empty()) {
    Buffers b = new_triangles(impl_->device, 3 * panes.size(), panes.size());
    for (const auto& pane : panes)
      for (const Vec3& p : pane) put(b.vertex, p - impl_->centre);
    for (unsigned i = 0; i < 3 * panes.size(); ++i) *b.index++ = i;
    attach(impl_->scene, b.geometry, kPanes);
  }
  rtcCommitScene(impl_->scene);
  impl_->device.check();
}

SeenSurfaces::SeenSurfaces(SeenSurfaces&&) noexcept = default;
SeenSurfaces::~SeenSurfaces() = default;

const Vec3& SeenSurfaces::centre() const { return impl_->centre; }
double SeenSurfaces::diagonal() const { return impl_->diagonal; }

void SeenSurfaces::look(const SightPacket& rays, Sights& sights) const {
  alignas(64) int valid[16];
  RTCRayHit16 packet;
  for (std::size_t k = 0; k < 16; ++k) {
    const std::size_t from = k < rays.count ? k : 0;
    valid[k] = k < rays.count ? -1 : 0;
    packet.ray.org_x[k] = rays.x[from], packet.ray.org_y[k] = rays.y[from], packet.ray.org_z[k] = rays.z[from];
    packet.ray.dir_x[k] = rays.dx[from], packet.ray.dir_y[k] = rays.dy[from], packet.ray.dir_z[k] = rays.dz[from];
    packet.ray.tnear[k] = rays.near[from], packet.ray.tfar[k] = kInfinity, packet.ray.time[k] = 0;
    packet.ray.mask[k] = ~0u, packet.ray.id[k] = 0, packet.ray.flags[k] = 0;
    packet.hit.geomID[k] = packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  }
  Context c = context(rays.is_scattered ? RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT : RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  rtcIntersect16(valid, impl_->scene, &c.embree, &packet);
  for (std::size_t k = 0; k < 16; ++k) {
    sights.triangle[k] = packet.hit.geomID[k] == kTriangles ? packet.hit.primID[k] : Sights::kNothing;
    sights.pane[k] = packet.hit.geomID[k] == kPanes ? packet.hit.primID[k] : Sights::kNothing;
    sights.u[k] = packet.hit.u[k], sights.v[k] = packet.hit.v[k], sights.distance[k] = packet.ray.tfar[k];
  }
}

double SeenSurfaces::distance(const Vec3& origin, const Vec3& direction) const {
  Context c = context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  RTCRayHit r = one_ray(origin - impl_->centre, direction);
  rtcIntersect1(impl_->scene, &c.embree, &r);
  return double{r.ray.tfar};
}

bool SeenSurfaces::meets_back(const Vec3& origin, const Vec3& direction) const {
  Context c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  c.backs_are_there = true;
  RTCRayHit r = one_ray(origin - impl_->centre, direction);
  rtcIntersect1(impl_->scene, &c.embree, &r);
  const double along = r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z;
  if (r.hit.geomID != kTriangles || along <= 0) return false;
  // The other side of a sheet lies in the same place: then it has a front.
  const double front = distance(origin, direction);
  return !(front <= double{r.ray.tfar} + lift());
}

}  // namespace clerestory
