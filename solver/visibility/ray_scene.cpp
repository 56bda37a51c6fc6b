#include "solver/visibility/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <embree3/rtcore.h>

#include "solver/geometry/triangle.h"
#include "solver/model/coordinate_grid.h"
#include "solver/model/parallel.h"
#include "solver/visibility/echo_choice.h"
#include "solver/visibility/embree_surfaces.h"
#include "solver/visibility/fine_rays.h"
#include "solver/visibility/glass_sheet.h"
#include "solver/visibility/tight_places.h"
#include "solver/visibility/turning_planes.h"

namespace clerestory {
namespace {

constexpr int kMostReflections = 64;  // of one ray; what is left is lost
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kLift = 5e-7;          // of the diameter: a few units in the last place at the rim of the scene
constexpr double kPlaceInPlane = 2e-6;  // of the diameter: how far from its plane a mirror is looked for
constexpr double kFineLift = 1e-12;     // of the diameter: far above double's rounding, far below the coordinates' grid

RTCIntersectContext context(RTCIntersectContextFlags flags) {
  RTCIntersectContext c;
  rtcInitIntersectContext(&c);
  c.flags = flags;
  return c;
}

/// One ray that met nothing yet.
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

/// Who is told of the panes on one part of a ray's way.
struct PanesOnLeg {
  EchoChoice* choice = nullptr;  ///< null: nobody
  Spectrum so_far{1.0};          ///< what is left of the ray where the leg starts
  double lift_share = 1;
  bool is_first = true;  ///< no mirror comes before it
};

}  // namespace

struct RayScene::Impl {
  EmbreeDevice device;
  EmbreeSurfaces opaque, glass;
  std::vector<GlassTable> glass_kinds;
  std::vector<std::uint32_t> kind_of_glass;  ///< by triangle; empty without glass
  TurningPlanes turning;
  GlossySides glossy;
  double diameter = 0;
  std::vector<Vec3> vertices;  ///< in double, for what float cannot tell
  std::vector<std::array<VertexId, 3>> corners;
  TightPlaces tight;
  std::optional<FineRays> fine;  ///< when any place is tight

  Vec3 corner(TriangleId t, std::size_t k) const { return vertices[corners[t][k]]; }
  Vec3 unit_normal(TriangleId t) const {
    return normalized(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
  }
  Vec3 off_surface(const Vec3& p, const Vec3& n, double share) const {
    return p + n * (share * (tight.contains(p) ? kFineLift : kLift) * diameter);
  }

  bool lands_tight(const Hit& hit, const Ray& ray) const {
    return !tight.is_clear(hit.triangle) && (tight.is_tight(hit.triangle) || tight.contains(hit.position(ray)));
  }

  /// Of one ray up to the first surface, be it a mirror.
  Hit one_leg(const PatchSet& patches, const Ray& ray, PanesOnLeg panes) const {
    if (tight.contains(ray.origin)) return fine_leg(patches, ray, panes);
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRayHit r = ray_hit(ray.origin, ray.direction, 0, kInfinity);
    rtcIntersect1(opaque.handle, &c, &r);
    Hit hit;
    hit.distance = hit.first = double{r.ray.tfar};
    if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
      hit.triangle = TriangleId{opaque.of_primitive[r.hit.primID]};
      if (lands_tight(hit, ray)) return fine_leg(patches, ray, panes);
      const float along = r.hit.Ng_x * r.ray.dir_x + r.hit.Ng_y * r.ray.dir_y + r.hit.Ng_z * r.ray.dir_z;
      hit.patch = patches.patch_at(hit.triangle, along < 0 ? kFront : kBack, double{r.hit.u}, double{r.hit.v});
    }
    if (!glass.of_primitive.empty())
      hit.transmittance = through_glass(ray.origin, ray.direction, hit.distance, false, panes);
    return hit;
  }

  /// The same where float cannot tell what is first.
  Hit fine_leg(const PatchSet& patches, const Ray& ray, PanesOnLeg panes) const {
    Hit hit;
    hit.distance = hit.first = std::numeric_limits<double>::infinity();
    if (const auto met = fine->first(ray.origin, ray.direction, hit.distance)) {
      hit.distance = hit.first = met->distance;
      hit.triangle = met->triangle;
      hit.patch = patches.patch_at(hit.triangle, met->front ? kFront : kBack, met->u, met->v);
    }
    if (!glass.of_primitive.empty())
      hit.transmittance = through_glass(ray.origin, ray.direction, hit.distance, true, panes);
    return hit;
  }

  /// Goes on from a hit as long as it is on a mirror. share: of the lift.
  void follow_mirrors(const PatchSet& patches, const Ray& first, double share, Hit& hit, EchoChoice* choice) const {
    Ray ray = first;
    for (int k = 0; k < kMostReflections; ++k) {
      const TurningPlanes::Mirror* mirror = turning.mirror_at(hit.triangle);
      if (!mirror) return;
      const double along = dot(mirror->normal, ray.direction);
      const Vec3 n = along < 0 ? mirror->normal : -mirror->normal;
      const Vec3 met = hit.position(first), x = met - mirror->normal * (dot(mirror->normal, met) - mirror->offset);
      ray = {off_surface(x, n, share), ray.direction - mirror->normal * (2 * along)};
      const Spectrum so_far = hit.transmittance * mirror->reflectance;
      const double to_first = hit.first;
      hit = one_leg(patches, ray, {choice, so_far, share, false});
      hit.plane = k == 0 ? mirror->plane : kNoPlane;
      hit.first = to_first;
      hit.transmittance *= so_far;
      hit.reflected = true;
      hit.leg = ray;
    }
  }

  Vec3 in_plane_of(TriangleId t, const Vec3& x) const {
    const Vec3 n = unit_normal(t);
    return x - n * dot(n, x - corner(t, 0));
  }

  const Lobe* lobe(TriangleId t, const Vec3& direction) const {
    if (glossy.empty() || !t.valid()) return nullptr;
    return glossy.lobe(t, dot(unit_normal(t), direction) < 0 ? kFront : kBack);
  }

  /// Where a ray ends on a glossy side, it goes on by the lobe. share: of the lift.
  void offer_gloss(const Ray& first, const Hit& hit, double share, EchoChoice& choice) const {
    const Vec3& direction = hit.direction(first);
    const Lobe* at = lobe(hit.triangle, direction);
    if (!at) return;
    const Vec3 front = unit_normal(hit.triangle), n = dot(front, direction) < 0 ? front : -front;
    RandomStream random(key_of({hit.position(first), direction}, kGlossOfRay));
    const double u = random.uniform(), v = random.uniform();
    const Lobe::Sample s = at->sample(n, -direction, u, v);
    if (!(s.density > 0)) return;
    const Vec3 x = in_plane_of(hit.triangle, hit.position(first));
    choice.offer({kNoPlane, hit.transmittance * s.weight, {off_surface(x, n, share), s.direction}, true});
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

  /// Calls met(distance, triangle) for the panes before `far`, from near to far. direction: unit.
  template <class Met>
  void walk_glass(const Vec3& origin, const Vec3& direction, double far, bool finely, const Met& met) const {
    double done = -1;
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    const float far_t = static_cast<float>(far), step = static_cast<float>(1e-6 * diameter);
    for (float near_t = 0; near_t < far_t && !finely;) {
      RTCRayHit r = ray_hit(origin, direction, near_t, far_t);
      rtcIntersect1(glass.handle, &c, &r);
      if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
      const TriangleId pane{glass.of_primitive[r.hit.primID]};
      finely = tight.is_tight(pane);
      if (finely) break;
      done = double{r.ray.tfar};
      met(done, pane);
      near_t = std::max(r.ray.tfar + step, std::nextafter(r.ray.tfar, kInfinity));  // panes count once at shared edges
    }
    if (!finely) return;
    for (const FineRays::Met& pane : fine->glass(origin, direction, far))
      if (pane.distance > done + double{step} || done < 0) met(pane.distance, pane.triangle);
  }

  const GlassTable& glass_of(TriangleId pane) const { return glass_kinds[kind_of_glass[pane]]; }

  /// Product of the transmittances of the glass met before `far`, each at the angle at which it is met. direction:
  /// unit. finely: an end is in a tight place.
  Spectrum through_glass(const Vec3& origin, const Vec3& direction, double far, bool finely,
                         const PanesOnLeg& panes = {}) const {
    Spectrum share(1.0);
    walk_glass(origin, direction, far, finely, [&](double distance, TriangleId pane) {
      const double cosine = dot(unit_normal(pane), direction);
      if (panes.choice)
        panes.choice->offer(
            {panes.is_first ? turning.glass_plane[pane] : kNoPlane,
             panes.so_far * share * glass_of(pane).reflectance(cosine),
             turned(origin, direction, distance, unit_normal(pane), corner(pane, 0), panes.lift_share)});
      share *= glass_of(pane).transmittance(cosine);
    });
    return share;
  }

  /// The ray that a pane or mirror turns: it starts in the very plane, lifted off it; a ray in float hits it only
  /// nearly.
  Ray turned(const Vec3& origin, const Vec3& direction, double distance, const Vec3& normal, const Vec3& in_plane,
             double lift_share) const {
    const double along = dot(normal, direction);
    const Vec3 met = origin + direction * distance, x = met - normal * dot(normal, met - in_plane);
    return {off_surface(x, along < 0 ? normal : -normal, lift_share), direction - normal * (2 * along)};
  }
  /// What a mirror or pane of that plane turns of light that comes along `direction` to the place x of it, seen from
  /// where `up` points; black where there is none.
  Spectrum turned_at(std::uint32_t plane, const Vec3& x, const Vec3& up, const Vec3& direction) const {
    const double reach = kPlaceInPlane * diameter;
    const Vec3 from = x + up * reach;
    if (turning.planes[plane].is_glass) {
      Spectrum share(0.0);
      walk_glass(from, -up, 2 * reach, tight.contains(x), [&](double, TriangleId pane) {
        if (turning.glass_plane[pane] == plane) share = glass_of(pane).reflectance(dot(up, direction));
      });
      return share;
    }
    TriangleId met;
    if (tight.contains(x)) {
      if (const auto found = fine->first(from, -up, 2 * reach)) met = found->triangle;
    } else {
      auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
      RTCRayHit r = ray_hit(from, -up, 0, static_cast<float>(2 * reach));
      rtcIntersect1(opaque.handle, &c, &r);
      if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) met = TriangleId{opaque.of_primitive[r.hit.primID]};
    }
    const TurningPlanes::Mirror* mirror = turning.mirror_at(met);
    return mirror && mirror->plane == plane ? mirror->reflectance : Spectrum(0.0);
  }

  struct Surface {
    double distance = std::numeric_limits<double>::infinity();
    TriangleId triangle;
  };
  /// First opaque surface.
  Surface first_surface(const Ray& ray) const {
    const auto finely = [&]() -> Surface {
      const auto met = fine->first(ray.origin, ray.direction, std::numeric_limits<double>::infinity());
      return met ? Surface{met->distance, met->triangle} : Surface{};
    };
    if (tight.contains(ray.origin)) return finely();
    auto c = context(RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
    RTCRayHit r = ray_hit(ray.origin, ray.direction, 0, kInfinity);
    rtcIntersect1(opaque.handle, &c, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    const TriangleId met{opaque.of_primitive[r.hit.primID]};
    return tight.is_tight(met) ? finely() : Surface{double{r.ray.tfar}, met};
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
  impl->turning = find_turning_planes(patches, impl->diameter);
  impl->glossy = GlossySides(patches, impl->diameter);
  impl->tight = TightPlaces(patches, kLift * impl->diameter);
  if (impl->tight.any()) impl->fine.emplace(patches, impl->vertices, impl->corners, impl->diameter);
  impl_ = std::move(impl);
}
RayScene::RayScene(std::shared_ptr<const Impl> impl, double lift_share, bool leaves_gloss)
    : impl_(std::move(impl)), lift_share_(lift_share), leaves_gloss_(leaves_gloss) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

bool RayScene::has_mirrors() const { return !impl_->turning.mirrors.empty(); }
const std::vector<MirrorPlane>& RayScene::mirrors() const { return impl_->turning.planes; }
std::uint32_t RayScene::plane_of(TriangleId t) const {
  if (const TurningPlanes::Mirror* mirror = has_mirrors() ? impl_->turning.mirror_at(t) : nullptr) return mirror->plane;
  return has_glass() ? impl_->turning.glass_plane[t] : kNoPlane;
}
bool RayScene::has_gloss() const { return !impl_->glossy.empty(); }
const GlossySides& RayScene::gloss() const { return impl_->glossy; }
Vec3 RayScene::normal(TriangleId t) const { return impl_->unit_normal(t); }
Vec3 RayScene::in_plane_of(TriangleId t, const Vec3& x) const { return impl_->in_plane_of(t, x); }
std::array<double, 2> RayScene::barycentric(TriangleId t, const Vec3& x) const {
  const Vec3 a = impl_->corner(t, 0), ab = impl_->corner(t, 1) - a, ac = impl_->corner(t, 2) - a, n = cross(ab, ac);
  const double per_area = 1 / dot(n, n);
  return {std::clamp(dot(n, cross(x - a, ac)) * per_area, 0.0, 1.0),
          std::clamp(dot(n, cross(ab, x - a)) * per_area, 0.0, 1.0)};
}
const Lobe* RayScene::lobe(TriangleId t, const Vec3& direction) const { return impl_->lobe(t, direction); }
bool RayScene::has_glass() const { return !impl_->glass.of_primitive.empty(); }
double RayScene::lift() const { return lift_share_ * kLift * impl_->diameter; }
Vec3 RayScene::off_surface(const Vec3& p, const Vec3& n) const { return impl_->off_surface(p, n, lift_share_); }
RayScene RayScene::with_nearer_ends() const { return {impl_, 0.5, leaves_gloss_}; }
RayScene RayScene::without_gloss() const { return {impl_, lift_share_, true}; }
bool RayScene::has_tight_places() const { return impl_->tight.any(); }
bool RayScene::is_tight(const Vec3& p) const { return impl_->tight.contains(p); }
double RayScene::diameter() const { return impl_->diameter; }

Vec3 RayScene::beside_surfaces(const Vec3& p, const Vec3& n) const {
  const double in_plane = kCoordinateGrid * impl_->diameter,
               off = is_tight(p) ? lift_share_ * kFineLift * impl_->diameter : lift();
  const double reach = std::max(off, in_plane);
  std::vector<TriangleId> near;
  const auto note = [&](TriangleId t) { near.push_back(t); };
  for (const EmbreeSurfaces* surfaces : {&impl_->opaque, &impl_->glass}) surfaces->visit_near(p, 2 * lift(), note);
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

void RayScene::first_hits(const PatchSet& patches, std::span<const Ray> rays, std::span<Hit> hits,
                          std::span<Echo> echoes) const {
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
      Echo* echo = echoes.empty() ? nullptr : &echoes[first + k];
      if (echo) *echo = {};
      EchoChoice choice(sent, echo);
      const PanesOnLeg panes{choice ? &choice : nullptr, Spectrum(1.0), lift_share_};
      if (has_tight_places() && (k == 0 || sent.origin != rays[first + k - 1].origin))
        starts_tight = is_tight(sent.origin);
      if (starts_tight || (!hit.escaped() && impl_->lands_tight(hit, sent))) {
        hit = impl_->fine_leg(patches, sent, panes);
        if (has_mirrors()) impl_->follow_mirrors(patches, sent, lift_share_, hit, panes.choice);
        if (choice && !leaves_gloss_) impl_->offer_gloss(sent, hit, lift_share_, choice);
        choice.finish();
        continue;
      }
      if (!hit.escaped()) {
        const float along = packet.hit.Ng_x[k] * packet.ray.dir_x[k] + packet.hit.Ng_y[k] * packet.ray.dir_y[k] +
                            packet.hit.Ng_z[k] * packet.ray.dir_z[k];
        hit.patch = patches.patch_at(hit.triangle, along < 0 ? kFront : kBack, double{packet.hit.u[k]},
                                     double{packet.hit.v[k]});
      }
      if ((by_glass >> k) & 1)
        hit.transmittance = impl_->through_glass(sent.origin, sent.direction, hit.distance, false, panes);
      if (has_mirrors()) impl_->follow_mirrors(patches, sent, lift_share_, hit, panes.choice);
      if (choice && !leaves_gloss_) impl_->offer_gloss(sent, hit, lift_share_, choice);
      choice.finish();
    }
  }
}

Hit RayScene::first_hit(const PatchSet& patches, const Ray& ray, Echo* echo) const {
  if (echo) *echo = {};
  EchoChoice choice(ray, has_echoes() ? echo : nullptr);
  const PanesOnLeg panes{choice ? &choice : nullptr, Spectrum(1.0), lift_share_};
  Hit hit = impl_->one_leg(patches, ray, panes);
  if (has_mirrors()) impl_->follow_mirrors(patches, ray, lift_share_, hit, panes.choice);
  if (choice && !leaves_gloss_) impl_->offer_gloss(ray, hit, lift_share_, choice);
  choice.finish();
  return hit;
}

Hit RayScene::first_leg(const PatchSet& patches, const Ray& ray, Echo& echo) const {
  echo = {};
  EchoChoice choice(ray, &echo);
  const Hit hit = impl_->one_leg(patches, ray, {&choice, Spectrum(1.0), lift_share_});
  if (const TurningPlanes::Mirror* mirror = has_mirrors() ? impl_->turning.mirror_at(hit.triangle) : nullptr)
    choice.offer({mirror->plane, hit.transmittance * mirror->reflectance,
                  impl_->turned(ray.origin, ray.direction, hit.distance, mirror->normal, impl_->corner(hit.triangle, 0),
                                lift_share_)});
  if (!leaves_gloss_) impl_->offer_gloss(ray, hit, lift_share_, choice);
  choice.finish();
  return hit;
}

double RayScene::first_surface(const Ray& ray) const { return impl_->first_surface(ray).distance; }

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

Spectrum RayScene::transmittance_by_mirrors(const Vec3& from, const Vec3& image, const MirrorWay& way) const {
  // Where the way crosses the planes, from the last to the first: most ways miss one.
  std::array<Vec3, MirrorWay::kMost> crossing;
  std::array<bool, MirrorWay::kMost> above;
  Vec3 start = from, end = image;
  for (std::size_t k = way.count; k-- > 0;) {
    const MirrorPlane& plane = impl_->turning.planes[way.plane[k]];
    const double height = plane.height(start), beyond = plane.height(end);
    if (!(height * beyond < 0)) return Spectrum(0.0);
    crossing[k] = start + (end - start) * (height / (height - beyond));
    if (!plane.is_within(crossing[k], lift())) return Spectrum(0.0);
    above[k] = height > 0;
    start = crossing[k], end = plane.image_of(end);
  }
  Spectrum share(1.0);
  start = from;
  for (std::size_t k = way.count; k-- > 0;) {
    const MirrorPlane& plane = impl_->turning.planes[way.plane[k]];
    const Vec3 up = above[k] ? plane.normal : -plane.normal, x = off_surface(crossing[k], up);
    share *= impl_->turned_at(way.plane[k], crossing[k], up, normalized(crossing[k] - start));
    if (share.is_black()) return share;
    share *= transmittance(start, x);
    if (share.is_black()) return share;
    start = x;
  }
  return share * transmittance(start, end);
}

std::vector<Turn> RayScene::turns(const Ray& ray) const {
  std::vector<Turn> found;
  Spectrum share(1.0);
  const auto turned = [&](double distance, TriangleId met) {
    return impl_->turned(ray.origin, ray.direction, distance, impl_->unit_normal(met), impl_->corner(met, 0),
                         lift_share_);
  };
  const Impl::Surface end = impl_->first_surface(ray);
  impl_->walk_glass(
      ray.origin, ray.direction, end.distance, is_tight(ray.origin), [&](double distance, TriangleId pane) {
        const GlassTable& kind = impl_->glass_of(pane);
        const double cosine = dot(impl_->unit_normal(pane), ray.direction);
        found.push_back(
            {impl_->turning.glass_plane[pane], share * kind.reflectance(cosine), turned(distance, pane), false});
        share *= kind.transmittance(cosine);
      });
  if (const TurningPlanes::Mirror* mirror = has_mirrors() ? impl_->turning.mirror_at(end.triangle) : nullptr)
    found.push_back({mirror->plane, share * mirror->reflectance, turned(end.distance, end.triangle), true});
  return found;
}

Spectrum RayScene::glass_transmittance(const Vec3& from, const Vec3& to) const {
  if (!has_glass()) return Spectrum(1.0);
  const double distance = length(to - from);
  if (!(distance > 0)) return Spectrum(1.0);
  const Vec3 d = (to - from) / distance;
  return impl_->through_glass(from, d, distance, is_tight(from) || is_tight(to));
}

}  // namespace clerestory
