#include "solver/visibility/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include <embree3/rtcore.h>

#include "solver/geometry/triangle.h"
#include "solver/model/coordinate_grid.h"
#include "solver/model/parallel.h"
#include "solver/visibility/embree_device.h"
#include "solver/visibility/fine_rays.h"
#include "solver/visibility/glass_sheet.h"
#include "solver/visibility/tight_places.h"

namespace clerestory {
namespace {

constexpr int kMostReflections = 64;     // of one ray; what is left is lost
constexpr std::size_t kMostPlanes = 64;  // of mirrors that show images of luminaires
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kLift = 5e-7;       // of the diameter: a few units in the last place at the rim of the scene
constexpr double kFineLift = 1e-12;  // of the diameter: far above double's rounding, far below the coordinates' grid

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

  void build(const EmbreeDevice& device, const PatchSet& patches, bool glass) {
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

/// Segments as rays of length 1. Without 16 lanes of hardware Embree reads lanes that are not valid too: they must hold
/// numbers.
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

}  // namespace

struct RayScene::Impl {
  EmbreeDevice device;
  Surfaces opaque, glass;
  std::vector<GlassTable> glass_kinds;
  std::vector<std::uint32_t> kind_of_glass;  ///< by triangle; empty without glass
  struct Mirror {
    Vec3 normal;
    double offset;        ///< of its own plane
    std::uint32_t plane;  ///< kMostPlanes: of none
    Spectrum reflectance;
  };
  std::vector<Mirror> mirrors;
  std::vector<std::uint32_t> mirror_of_triangle;  ///< number in `mirrors` or kNone; empty without mirrors
  std::vector<MirrorPlane> planes;
  static constexpr std::uint32_t kNone = 0xffffffff;
  double diameter = 0;
  std::vector<Vec3> vertices;  ///< in double, for what float cannot tell
  std::vector<std::array<VertexId, 3>> corners;
  TightPlaces tight;
  std::optional<FineRays> fine;  ///< when any place is tight

  void find_mirrors(const PatchSet& patches) {
    for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
      if (!patches.front_material(TriangleId{t}).turns_rays()) continue;
      const auto& c = patches.corners[t];
      const Vec3 a = patches.vertices[c[0]];
      const Vec3 n = normalized(cross(patches.vertices[c[1]] - a, patches.vertices[c[2]] - a));
      if (!(length(n) > 0.5)) continue;  // without area
      if (mirror_of_triangle.empty()) mirror_of_triangle.assign(patches.triangle_count(), kNone);
      const auto same = [&](const MirrorPlane& plane) {
        return length(cross(plane.normal, n)) < 1e-6 && std::abs(dot(plane.normal, a) - plane.offset) < 1e-6 * diameter;
      };
      auto plane = static_cast<std::size_t>(std::find_if(planes.begin(), planes.end(), same) - planes.begin());
      if (plane == planes.size() && plane < kMostPlanes) planes.push_back({n, dot(n, a)});
      plane = std::min(plane, kMostPlanes);
      mirror_of_triangle[t] = static_cast<std::uint32_t>(mirrors.size());
      const Vec3 normal = plane < planes.size() ? planes[plane].normal : n;
      mirrors.push_back({normal, dot(normal, a), static_cast<std::uint32_t>(plane),
                         patches.front_material(TriangleId{t}).reflectance});
    }
  }

  Vec3 off_surface(const Vec3& p, const Vec3& n, double share) const {
    return p + n * (share * (tight.contains(p) ? kFineLift : kLift) * diameter);
  }

  const Mirror* mirror_at(TriangleId t) const {
    if (!t.valid() || mirror_of_triangle[t] == kNone) return nullptr;
    return &mirrors[mirror_of_triangle[t]];
  }

  bool lands_tight(const Hit& hit, const Ray& ray) const {
    return !tight.is_clear(hit.triangle) && (tight.is_tight(hit.triangle) || tight.contains(hit.position(ray)));
  }

  /// Of one ray up to the first surface, be it a mirror.
  Hit one_leg(const PatchSet& patches, const Ray& ray) const {
    if (tight.contains(ray.origin)) return fine_leg(patches, ray);
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRayHit r = ray_hit(ray.origin, ray.direction, 0, kInfinity);
    rtcIntersect1(opaque.handle, &c, &r);
    Hit hit;
    hit.distance = hit.first = double{r.ray.tfar};
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
      hit.triangle = TriangleId{opaque.of_primitive[r.hit.primID]};
      if (lands_tight(hit, ray)) return fine_leg(patches, ray);
      const float along = r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z;
      hit.patch = patches.patch_at(hit.triangle, along < 0 ? kFront : kBack, double{r.hit.u}, double{r.hit.v});
    }
    if (!glass.of_primitive.empty()) hit.transmittance = through_glass(ray.origin, ray.direction, hit.distance);
    return hit;
  }

  /// The same where float cannot tell what is first.
  Hit fine_leg(const PatchSet& patches, const Ray& ray) const {
    Hit hit;
    hit.distance = hit.first = std::numeric_limits<double>::infinity();
    if (const auto met = fine->first(ray.origin, ray.direction, hit.distance)) {
      hit.distance = hit.first = met->distance;
      hit.triangle = met->triangle;
      hit.patch = patches.patch_at(hit.triangle, met->front ? kFront : kBack, met->u, met->v);
    }
    if (!glass.of_primitive.empty()) hit.transmittance = through_fine_glass(ray.origin, ray.direction, hit.distance);
    return hit;
  }

  /// Goes on from a hit as long as it is on a mirror. share: of the lift.
  void follow_mirrors(const PatchSet& patches, const Ray& first, double share, Hit& hit) const {
    Ray ray = first;
    for (int k = 0; k < kMostReflections; ++k) {
      const Mirror* mirror = mirror_at(hit.triangle);
      if (!mirror) return;
      const double along = dot(mirror->normal, ray.direction);
      const Vec3 n = along < 0 ? mirror->normal : -mirror->normal;
      const Vec3 met = hit.position(first), x = met - mirror->normal * (dot(mirror->normal, met) - mirror->offset);
      ray = {off_surface(x, n, share), ray.direction - mirror->normal * (2 * along)};
      const Spectrum so_far = hit.transmittance * mirror->reflectance;
      const double to_first = hit.first;
      hit = one_leg(patches, ray);
      hit.first = to_first;
      hit.transmittance *= so_far;
      hit.reflected = true;
      hit.leg = ray;
    }
  }

  void tabulate_glass(const PatchSet& patches) {
    if (!glass.of_primitive.empty()) kind_of_glass.assign(patches.triangle_count(), 0);
    std::vector<std::uint32_t> kind_of_material(patches.materials.size(), 0xffffffff);
    for (const std::uint32_t t : glass.of_primitive) {
      const MaterialId material = patches.side_material[t][kFront];
      std::uint32_t& kind = kind_of_material[material];
      if (kind == 0xffffffff) {
        kind = static_cast<std::uint32_t>(glass_kinds.size());
        glass_kinds.emplace_back(patches.materials[material].transmittance);
      }
      kind_of_glass[t] = kind;
    }
  }

  /// Bits of the rays of a packet that meet glass before their ends, which it overwrites.
  unsigned glass_in_the_way(const int* valid, RTCRay16& rays) const {
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    rtcOccluded16(valid, glass.handle, &c, &rays);
    unsigned met = 0;
    for (unsigned k = 0; k < 16; ++k) met |= (valid[k] && rays.tfar[k] < 0 ? 1u : 0u) << k;
    return met;
  }

  /// Product of the transmittances of the glass met before `far`, each at the angle at which it is met. direction:
  /// unit. Neither end is in a tight place.
  Spectrum through_glass(const Vec3& origin, const Vec3& direction, double far) const {
    Spectrum share(1.0);
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    const float far_t = static_cast<float>(far), step = static_cast<float>(1e-6 * diameter);
    for (float near_t = 0; near_t < far_t;) {
      RTCRayHit r = ray_hit(origin, direction, near_t, far_t);
      rtcIntersect1(glass.handle, &c, &r);
      if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) break;
      const TriangleId met{glass.of_primitive[r.hit.primID]};
      if (tight.is_tight(met)) return through_fine_glass(origin, direction, far);
      const Vec3 n(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z);
      share *= glass_kinds[kind_of_glass[met]].at(dot(n, direction) / length(n));
      near_t = std::max(r.ray.tfar + step, std::nextafter(r.ray.tfar, kInfinity));  // panes count once at shared edges
    }
    return share;
  }
  /// The same by double precision.
  Spectrum through_fine_glass(const Vec3& origin, const Vec3& direction, double far) const {
    Spectrum share(1.0);
    for (const FineRays::Met& met : fine->glass(origin, direction, far))
      share *= glass_kinds[kind_of_glass[met.triangle]].at(dot(fine->normal(met.triangle), direction));
    return share;
  }

  /// Whether nothing opaque blocks a segment of which an end lies in a tight place.
  bool fine_visible(const Vec3& from, const Vec3& to) const { return !fine->first(from, to - from, 1).has_value(); }
};

RayScene::RayScene(const PatchSet& patches) {
  auto impl = std::make_shared<Impl>();
  Vec3 lower(kInfinity, kInfinity, kInfinity), upper(-kInfinity, -kInfinity, -kInfinity);
  for (const Vec3& v : patches.vertices) {
    lower = {std::min(lower.x, v.x), std::min(lower.y, v.y), std::min(lower.z, v.z)};
    upper = {std::max(upper.x, v.x), std::max(upper.y, v.y), std::max(upper.z, v.z)};
  }
  impl->vertices = patches.vertices;
  impl->corners = patches.corners;
  impl->diameter = patches.vertices.empty() ? 0 : length(upper - lower);
  on_one_thread([&] {  // the tree decides which of two equally near triangles is met
    impl->opaque.build(impl->device, patches, false);
    impl->glass.build(impl->device, patches, true);
  });
  impl->tabulate_glass(patches);
  impl->find_mirrors(patches);
  impl->tight = TightPlaces(patches, kLift * impl->diameter);
  if (impl->tight.any()) impl->fine.emplace(patches, impl->vertices, impl->corners, impl->diameter);
  impl_ = std::move(impl);
}
RayScene::RayScene(std::shared_ptr<const Impl> impl, double lift_share)
    : impl_(std::move(impl)), lift_share_(lift_share) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

bool RayScene::has_mirrors() const { return !impl_->mirrors.empty(); }
const std::vector<MirrorPlane>& RayScene::mirrors() const { return impl_->planes; }
bool RayScene::has_glass() const { return !impl_->glass.of_primitive.empty(); }
double RayScene::lift() const { return lift_share_ * kLift * impl_->diameter; }
Vec3 RayScene::off_surface(const Vec3& p, const Vec3& n) const { return impl_->off_surface(p, n, lift_share_); }
RayScene RayScene::with_nearer_ends() const { return {impl_, 0.25}; }
bool RayScene::has_tight_places() const { return impl_->tight.any(); }
bool RayScene::is_tight(const Vec3& p) const { return impl_->tight.contains(p); }
double RayScene::diameter() const { return impl_->diameter; }

Vec3 RayScene::beside_surfaces(const Vec3& p, const Vec3& n) const {
  const double in_plane = kCoordinateGrid * impl_->diameter,
               off = is_tight(p) ? lift_share_ * kFineLift * impl_->diameter : lift();
  const double reach = std::max(off, in_plane);
  std::vector<TriangleId> near;
  const auto note = [&](TriangleId t) { near.push_back(t); };
  for (const Surfaces* surfaces : {&impl_->opaque, &impl_->glass}) surfaces->visit_near(p, 2 * lift(), note);
  std::sort(near.begin(), near.end(), [](TriangleId a, TriangleId b) { return a.value < b.value; });
  Vec3 at = p;
  for (const TriangleId t : near) {
    const std::array c{impl_->vertices[impl_->corners[t][0]], impl_->vertices[impl_->corners[t][1]],
                       impl_->vertices[impl_->corners[t][2]]};
    if (length(at - nearest_point(c, at)) >= reach) continue;
    const Vec3 normal = normalized(cross(c[1] - c[0], c[2] - c[0]));
    const double h = dot(normal, at - c[0]);
    const bool is_above = std::abs(h) > in_plane ? h > 0 : dot(normal, n) >= 0;
    if (std::abs(h) < off || std::abs(h) <= in_plane) at += normal * ((is_above ? off : -off) - h);
  }
  return at;
}

void RayScene::first_hits(const PatchSet& patches, std::span<const Ray> rays, std::span<Hit> hits) const {
  auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  alignas(64) int valid[16];
  RTCRayHit16 packet;
  for (std::size_t first = 0; first < rays.size(); first += 16) {
    const std::size_t count = std::min<std::size_t>(16, rays.size() - first);
    for (std::size_t k = 0; k < 16; ++k) {
      valid[k] = k < count ? -1 : 0;
      const Ray& ray = rays[first + std::min(k, count - 1)];
      packet.ray.org_x[k] = static_cast<float>(ray.origin.x), packet.ray.org_y[k] = static_cast<float>(ray.origin.y);
      packet.ray.org_z[k] = static_cast<float>(ray.origin.z), packet.ray.dir_x[k] = static_cast<float>(ray.direction.x);
      packet.ray.dir_y[k] = static_cast<float>(ray.direction.y);
      packet.ray.dir_z[k] = static_cast<float>(ray.direction.z);
      packet.ray.tnear[k] = 0, packet.ray.tfar[k] = kInfinity, packet.ray.time[k] = 0;
      packet.ray.mask[k] = ~0u, packet.ray.id[k] = 0, packet.ray.flags[k] = 0;
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID, packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect16(valid, impl_->opaque.handle, &c, &packet);
    const std::array<float, 16> distance = std::to_array(packet.ray.tfar);
    const unsigned by_glass = has_glass() ? impl_->glass_in_the_way(valid, packet.ray) : 0;
    bool starts_tight = false;
    for (std::size_t k = 0; k < count; ++k) {
      Hit& hit = hits[first + k];
      hit = Hit{};
      hit.distance = hit.first = double{distance[k]};
      if (packet.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID)
        hit.triangle = TriangleId{impl_->opaque.of_primitive[packet.hit.primID[k]]};
      const Ray& sent = rays[first + k];
      if (has_tight_places() && (k == 0 || sent.origin != rays[first + k - 1].origin))
        starts_tight = is_tight(sent.origin);
      if (starts_tight || (!hit.escaped() && impl_->lands_tight(hit, sent))) {
        hit = impl_->fine_leg(patches, rays[first + k]);
        if (has_mirrors()) impl_->follow_mirrors(patches, rays[first + k], lift_share_, hit);
        continue;
      }
      if (!hit.escaped()) {
        const float along = packet.hit.Ng_x[k] * packet.ray.dir_x[k] + packet.hit.Ng_y[k] * packet.ray.dir_y[k] +
                            packet.hit.Ng_z[k] * packet.ray.dir_z[k];
        hit.patch = patches.patch_at(hit.triangle, along < 0 ? kFront : kBack, double{packet.hit.u[k]},
                                     double{packet.hit.v[k]});
      }
      if ((by_glass >> k) & 1) {
        const Ray& ray = rays[first + k];
        hit.transmittance = impl_->through_glass(ray.origin, ray.direction, hit.distance);
      }
      if (has_mirrors()) impl_->follow_mirrors(patches, rays[first + k], lift_share_, hit);
    }
  }
}

Hit RayScene::first_hit(const PatchSet& patches, const Ray& ray) const {
  Hit hit = impl_->one_leg(patches, ray);
  if (has_mirrors()) impl_->follow_mirrors(patches, ray, lift_share_, hit);
  return hit;
}

double RayScene::first_surface(const Ray& ray) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const auto finely = [&] {
    const auto met = impl_->fine->first(ray.origin, ray.direction, kFar);
    return met ? met->distance : kFar;
  };
  if (is_tight(ray.origin)) return finely();
  auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRayHit r = ray_hit(ray.origin, ray.direction, 0, kInfinity);
  rtcIntersect1(impl_->opaque.handle, &c, &r);
  if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID &&
      impl_->tight.is_tight(TriangleId{impl_->opaque.of_primitive[r.hit.primID]}))
    return finely();
  return double{r.ray.tfar};
}

std::uint16_t RayScene::meets_glass(const SegmentPacket& s, std::uint16_t active) const {
  if (!has_glass() || !active) return 0;
  alignas(64) int valid[16];
  RTCRay16 packet = ray16(s, active, valid);
  unsigned met = impl_->glass_in_the_way(valid, packet);
  for (unsigned k = 0; k < 16 && has_tight_places(); ++k)
    if ((active >> k) & 1 && (is_tight(s.from[k]) || is_tight(s.to[k]))) met |= 1u << k;
  return static_cast<std::uint16_t>(met);
}

std::uint16_t RayScene::visible16(const SegmentPacket& s, std::uint16_t active) const {
  auto c = context(RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
  alignas(64) int valid[16];
  RTCRay16 packet = ray16(s, active, valid);
  rtcOccluded16(valid, impl_->opaque.handle, &c, &packet);
  unsigned visible = 0;
  for (unsigned k = 0; k < 16; ++k) visible |= (packet.tfar[k] >= 0 ? 1u : 0u) << k;
  if (has_tight_places()) {
    const Vec3 *from = nullptr, *to = nullptr;  // many segments have an end in common
    bool starts_tight = false, ends_tight = false;
    for (unsigned k = 0; k < 16; ++k) {
      if (!((active >> k) & 1)) continue;
      if (!from || s.from[k] != *from) starts_tight = is_tight(s.from[k]);
      if (!to || s.to[k] != *to) ends_tight = is_tight(s.to[k]);
      from = &s.from[k], to = &s.to[k];
      if (starts_tight || ends_tight)
        visible = (visible & ~(1u << k)) | (impl_->fine_visible(*from, *to) ? 1u << k : 0u);
    }
  }
  return static_cast<std::uint16_t>(visible & active);
}

bool RayScene::visible(const Vec3& from, const Vec3& to) const {
  if (is_tight(from) || is_tight(to)) return impl_->fine_visible(from, to);
  auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  RTCRayHit r = ray_hit(from, to - from, 0, 1);
  rtcOccluded1(impl_->opaque.handle, &c, &r.ray);
  return r.ray.tfar >= 0;
}

Spectrum RayScene::transmittance(const Vec3& from, const Vec3& to) const {
  return visible(from, to) ? glass_transmittance(from, to) : Spectrum(0.0);
}

Spectrum RayScene::transmittance_by_mirror(const Vec3& from, const Vec3& image, std::uint32_t mirror) const {
  const MirrorPlane& plane = impl_->planes[mirror];
  if (!((dot(plane.normal, from) - plane.offset) * (dot(plane.normal, image) - plane.offset) < 0)) return Spectrum(0.0);
  const auto finely = [&] {
    const auto met = impl_->fine->first(from, image - from, 1);
    return met ? met->triangle : TriangleId{};
  };
  TriangleId first;
  if (is_tight(from)) {
    first = finely();
  } else {
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRayHit r = ray_hit(from, image - from, 0, 1);
    rtcIntersect1(impl_->opaque.handle, &c, &r);
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) first = TriangleId{impl_->opaque.of_primitive[r.hit.primID]};
    if (impl_->tight.is_tight(first)) first = finely();
  }
  const auto* met = impl_->mirror_at(first);
  if (!met || met->plane != mirror) return Spectrum(0.0);
  const double height = dot(met->normal, from) - met->offset, beyond = dot(met->normal, image) - met->offset;
  const Vec3 x = from + (image - from) * (height / (height - beyond));
  const Vec3 lifted = off_surface(x, height > 0 ? met->normal : -met->normal);
  return met->reflectance * glass_transmittance(from, lifted) * transmittance(lifted, plane.image_of(image));
}

Spectrum RayScene::glass_transmittance(const Vec3& from, const Vec3& to) const {
  if (!has_glass()) return Spectrum(1.0);
  const double distance = length(to - from);
  if (!(distance > 0)) return Spectrum(1.0);
  const Vec3 d = (to - from) / distance;
  return is_tight(from) || is_tight(to) ? impl_->through_fine_glass(from, d, distance)
                                        : impl_->through_glass(from, d, distance);
}

}  // namespace clerestory
