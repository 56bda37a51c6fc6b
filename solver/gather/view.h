#pragma once
// What comes back along rays from one point, and whom it belongs to: for plans and gathers.

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <span>

#include "solver/gather/gather_point.h"
#include "solver/lights/light_tree.h"
#include "solver/openings/openings.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {

/// Owners of rays: openings and, from kBrightAreas on, bright areas, by number.
inline constexpr std::uint32_t kBrightAreas = 0x80000000, kNobody = kNoOpening;

/// What up to 16 rays met, some of them more than one place: weighted so that it makes their values.
struct FoundByRays {
  std::vector<RowEntry> entry;
  std::vector<std::size_t> ray;  ///< of each entry, among those sent together

  void add(std::size_t k, const RowEntry& e) {
    if (!e.is_empty()) entry.push_back(e), ray.push_back(k);
  }
  void clear() { entry.clear(), ray.clear(); }
};

class View {
 public:
  /// bright_rays  shadow rays to bright patches that what the bundle meets of them shares their light with.
  View(const Illumination& light, const Vec3& p, const Frame& frame, int bright_rays, const GatherPlan& plan)
      : light_(light),
        p_(p),
        frame_(frame),
        bright_rays_(bright_rays),
        plan_(plan),
        at_(light.sampler.receiver(p, frame.n)) {
    for (const std::uint32_t m : plan.mirrors) in_mirrors_.push_back(seen_in(light, p, frame.n, m));
  }

  /// Up to 16 rays of one kind: pi times the radiance along each that belongs to `owner`, one of the plan's
  /// openings or bright areas, or kNobody; 0 along the others. density[k]: rays of that kind per solid angle.
  /// What panes turn back belongs to the owner of the ray that goes on through them.
  /// found: null, or set to what was met.
  void look(std::span<const Vec3> directions, std::span<const double> density, std::uint32_t owner,
            std::span<Spectrum> values, FoundByRays* found = nullptr) const;

  /// Of a ray that meets `patch`, if any, and the first surface at `distance`.
  std::uint32_t owner_of(const Vec3& direction, double distance, PatchId patch) const;
  /// Of a ray that is not traced yet.
  std::uint32_t owner_of(const Vec3& direction) const;

  const LightTree::Receiver& at() const { return at_; }

  /// What mirror m of the plan shows is seen from behind it as from here.
  static LightTree::Receiver seen_in(const Illumination& light, const Vec3& p, const Vec3& n, std::uint32_t m) {
    const MirrorPlane& mirror = light.problem.rays.mirrors()[m];
    return light.sampler.receiver(mirror.image_of(p), mirror.image_of_direction(n));
  }
  const std::vector<LightTree::Receiver>& in_mirrors() const { return in_mirrors_; }

 private:
  /// found: as of look(), for ray k.
  Spectrum turned_back(const Echo& echo, const Ray& ray, double density, std::size_t k, FoundByRays* found) const;
  /// Of what a ray brings from a bright patch, the part that shadow rays do not: density of such rays per solid angle.
  double share_of_bundle(const Hit& hit, const Ray& ray, double density) const;
  double slit_gain(std::uint32_t number, const Vec3& direction, double distance) const;

  const Illumination& light_;
  Vec3 p_;
  const Frame& frame_;
  int bright_rays_;
  const GatherPlan& plan_;
  LightTree::Receiver at_;
  std::vector<LightTree::Receiver> in_mirrors_;  ///< by the plan's mirrors
};

/// Where to look at an area, how, and who else may own a ray.
struct AreaView {
  const View& view;
  const PolygonView& polygon;
  std::uint32_t owner;

  /// Up to 16 points.
  void look(std::span<const std::array<float, 2>> points, std::span<Spectrum> values,
            std::span<PolygonView::Sight> sights, FoundByRays* found = nullptr) const;
};

/// Shadow rays to bright patches at a point with that plan.
int bright_rays(const Illumination& light, const GatherPattern& pattern, const GatherPlan& plan);

/// Of cosine-distributed directions, per solid angle, in the frame of the normal.
inline double cosine_density(const std::array<float, 3>& d) {
  return std::max(1e-6, static_cast<double>(d[2])) / std::numbers::pi;
}

}  // namespace clerestory
