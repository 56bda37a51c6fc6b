#include "solver/visibility/fine_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

#include "solver/model/parallel.h"
#include "solver/visibility/embree_device.h"

namespace clerestory {
namespace {

/// One ray on its way, in double: Embree carries it to the callbacks beside its own, which is in float.
struct Query {
  RTCIntersectContext context;  ///< first: Embree hands back a pointer to it
  Vec3 origin, direction;
  double far;
  bool wants_glass;
  std::vector<FineRays::Met>* all = nullptr;  ///< set: all that is met, else the first
  FineRays::Met nearest;
};

}  // namespace

struct FineRays::Impl {
  const std::vector<Vec3>& vertices;
  const std::vector<std::array<VertexId, 3>>& corners;
  double diameter;
  std::vector<bool> is_glass;
  EmbreeDevice device;
  RTCScene scene = nullptr;

  Impl(const std::vector<Vec3>& v, const std::vector<std::array<VertexId, 3>>& c, double d)
      : vertices(v), corners(c), diameter(d) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene) rtcReleaseScene(scene);
  }

  /// By the signs of the ray's moments about the edges, which two triangles compute alike for the edge they share.
  std::optional<Met> meet(std::size_t t, const Vec3& origin, const Vec3& d, double far) const {
    const Vec3 a = vertices[corners[t][0]] - origin, b = vertices[corners[t][1]] - origin,
               c = vertices[corners[t][2]] - origin;
    const double U = dot(cross(c - b, c + b), d), V = dot(cross(a - c, a + c), d), W = dot(cross(b - a, b + a), d);
    if (std::min({U, V, W}) < 0 && std::max({U, V, W}) > 0) return std::nullopt;
    const double sum = U + V + W;
    const Vec3 n =
        cross(vertices[corners[t][1]] - vertices[corners[t][0]], vertices[corners[t][2]] - vertices[corners[t][0]]);
    const double along = dot(n, d);
    if (sum == 0 || along == 0) return std::nullopt;
    const double distance = dot(n, a) / along;
    if (!(distance > 0 && distance < far)) return std::nullopt;
    return Met{TriangleId{t}, distance, V / sum, W / sum, along < 0};
  }

  static void bounds(const RTCBoundsFunctionArguments* args) {
    const auto& self = *static_cast<const Impl*>(args->geometryUserPtr);
    // Embree walks its tree in float: boxes are wider than all that this moves a ray by.
    const double wider = 2e-6 * self.diameter;
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    RTCBounds& box = *args->bounds_o;
    box = {kInfinity, kInfinity, kInfinity, 0, -kInfinity, -kInfinity, -kInfinity, 0};
    for (const VertexId v : self.corners[args->primID]) {
      const Vec3& p = self.vertices[v];
      box.lower_x = std::min(box.lower_x, static_cast<float>(p.x - wider));
      box.lower_y = std::min(box.lower_y, static_cast<float>(p.y - wider));
      box.lower_z = std::min(box.lower_z, static_cast<float>(p.z - wider));
      box.upper_x = std::max(box.upper_x, static_cast<float>(p.x + wider));
      box.upper_y = std::max(box.upper_y, static_cast<float>(p.y + wider));
      box.upper_z = std::max(box.upper_z, static_cast<float>(p.z + wider));
    }
  }

  static void intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& self = *static_cast<const Impl*>(args->geometryUserPtr);
    if (args->N != 1 || !args->valid[0]) return;
    auto& query = *reinterpret_cast<Query*>(args->context);
    if (self.is_glass[args->primID] != query.wants_glass) return;
    const auto met = self.meet(args->primID, query.origin, query.direction, query.far);
    if (!met) return;
    if (query.all) {
      query.all->push_back(*met);
      return;
    }
    // Of two in one place the lower number, whatever the tree's order.
    if (query.nearest.triangle.valid() && met->distance == query.nearest.distance &&
        query.nearest.triangle.value < met->triangle.value)
      return;
    query.nearest = *met;
    query.far = std::nextafter(met->distance, 2 * met->distance);
    auto& ray = reinterpret_cast<RTCRayHit*>(args->rayhit)->ray;
    ray.tfar = std::min(ray.tfar, static_cast<float>(met->distance * (1 + 1e-6)));
  }

  void trace(Query& query) const {
    rtcInitIntersectContext(&query.context);
    RTCRayHit r{};
    r.ray.org_x = static_cast<float>(query.origin.x), r.ray.org_y = static_cast<float>(query.origin.y);
    r.ray.org_z = static_cast<float>(query.origin.z), r.ray.dir_x = static_cast<float>(query.direction.x);
    r.ray.dir_y = static_cast<float>(query.direction.y), r.ray.dir_z = static_cast<float>(query.direction.z);
    r.ray.tnear = 0, r.ray.tfar = static_cast<float>(query.far * (1 + 1e-6)), r.ray.mask = ~0u;
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &query.context, &r);
  }
};

FineRays::FineRays(const PatchSet& patches, const std::vector<Vec3>& vertices,
                   const std::vector<std::array<VertexId, 3>>& corners, double diameter)
    : impl_(std::make_unique<Impl>(vertices, corners, diameter)) {
  Impl& self = *impl_;
  for (std::size_t t = 0; t < patches.triangle_count(); ++t)
    self.is_glass.push_back(patches.front_material(TriangleId{t}).lets_rays_pass());
  self.scene = rtcNewScene(self.device.handle);
  rtcSetSceneFlags(self.scene, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(self.device.handle, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(self.corners.size()));
  rtcSetGeometryUserData(geometry, &self);
  rtcSetGeometryBoundsFunction(geometry, Impl::bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, Impl::intersect);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(self.scene, geometry);
  rtcReleaseGeometry(geometry);
  on_one_thread([&] { rtcCommitScene(self.scene); });
  self.device.check();
}
FineRays::FineRays(FineRays&&) noexcept = default;
FineRays& FineRays::operator=(FineRays&&) noexcept = default;
FineRays::~FineRays() = default;

Vec3 FineRays::normal(TriangleId t) const {
  const auto& c = impl_->corners[t];
  const Vec3& a = impl_->vertices[c[0]];
  return normalized(cross(impl_->vertices[c[1]] - a, impl_->vertices[c[2]] - a));
}

std::optional<FineRays::Met> FineRays::first(const Vec3& origin, const Vec3& direction, double far) const {
  Query query{{}, origin, direction, far, false, nullptr, {}};
  impl_->trace(query);
  if (!query.nearest.triangle.valid()) return std::nullopt;
  return query.nearest;
}

std::vector<FineRays::Met> FineRays::glass(const Vec3& origin, const Vec3& direction, double far) const {
  std::vector<Met> all;
  Query query{{}, origin, direction, far, true, &all, {}};
  impl_->trace(query);
  std::sort(all.begin(), all.end(), [](const Met& a, const Met& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle.value < b.triangle.value;
  });
  const double same = 1e-12 * impl_->diameter / length(direction);
  const auto share_a_corner = [&](const Met& a, const Met& b) {
    for (const VertexId v : impl_->corners[a.triangle])
      for (const VertexId w : impl_->corners[b.triangle])
        if (impl_->vertices[v] == impl_->vertices[w]) return true;
    return false;
  };
  std::vector<Met> panes;
  for (const Met& met : all)
    if (panes.empty() || met.distance - panes.back().distance > same || !share_a_corner(met, panes.back()))
      panes.push_back(met);
  return panes;
}

}  // namespace clerestory
