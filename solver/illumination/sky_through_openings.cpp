#include "solver/illumination/sky_through_openings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "solver/model/random_stream.h"
#include "solver/openings/openings.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/polygon_view.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr std::size_t kMostOpenings = 4;  ///< over a patch
constexpr double kLeastOfBest = 0.05;     ///< of what the best of them can give
constexpr std::uint32_t kPilotRays = 8;   ///< through an opening
constexpr double kAfar = 1.5;             ///< radii, from where on a point of the opening is as good as a direction
constexpr double kSmall = 0.1;            ///< of the way to the nearest opening: as its centre, so its corners see

/// A way from a point of the patch into the opening; weight: cosine at the point times solid angle for each share of
/// the unit square.
struct Aim {
  Ray ray;
  double weight = 0;
};

class Patch {
 public:
  Patch(const Problem& problem, std::size_t patch)
      : problem_(problem),
        normal_(problem.patches.normal[patch]),
        corners_(problem.patches.corner_positions(PatchId{patch})) {}

  const std::array<Vec3, 3>& corners() const { return corners_; }
  const Vec3& normal() const { return normal_; }
  Vec3 point(double u, double v) const { return problem_.rays.off_surface(point_on_triangle(corners_, u, v), normal_); }
  Vec3 centre() const { return (corners_[0] + corners_[1] + corners_[2]) / 3; }
  double radius() const {
    double farthest = 0;
    for (const Vec3& corner : corners_) farthest = std::max(farthest, length(corner - centre()));
    return farthest;
  }

  Aim aim(const LightArea& opening, bool from_afar, const std::array<double, 4>& u) const {
    const Vec3 p = point(u[0], u[1]);
    if (from_afar) {
      const Vec3 d = point_of(opening, u[2], u[3]) - p;
      const double r2 = dot(d, d), cosines = dot(d, normal_) * -dot(d, opening.normal) / r2;
      if (!(dot(d, normal_) > 0) || !(cosines > 0)) return {};
      return {{p, d / std::sqrt(r2)}, opening.area * cosines / r2};
    }
    const PolygonView polygon(p, normal_, opening.triangles, opening.corners);
    if (!(polygon.solid_angle() > 0)) return {};
    const auto [d, solid_angle] = polygon.look(u[2], u[3]);
    return {{p, d}, std::max(0.0, dot(d, normal_)) * solid_angle};
  }

  bool sees_much_sky(std::uint64_t key) const {
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    const Frame frame(normal_);
    for (std::uint32_t k = 0; k < rays.size(); ++k) {
      const auto u = sobol4(k, key);
      rays[k] = {point(u[2], u[3]), cosine_direction(frame, u[0], u[1])};
    }
    problem_.rays.first_hits(problem_.patches, rays, hits);
    return clerestory::sees_much_sky(hits);
  }

 private:
  const Problem& problem_;
  Vec3 normal_;
  std::array<Vec3, 3> corners_;
};

/// In the order of their numbers.
std::vector<std::uint32_t> openings_over(const RayScene& rays, std::span<const LightArea> openings, const Patch& patch,
                                         std::uint64_t key) {
  const auto from = [&](std::uint32_t k) {
    const auto u = sobol4(k, key);
    return patch.point(u[0], u[1]);
  };
  unsigned long long sent = 0;
  const auto in_view = [&](const Vec3& p, const AreasWanted& wanted) {
    return areas_in_view(rays, openings, p, patch.normal(), from, wanted, sent);
  };
  std::vector<std::uint32_t> over = in_view(patch.centre(), {kMostOpenings, kLeastOfBest});
  double nearest = std::numeric_limits<double>::infinity();
  for (const LightArea& o : openings) nearest = std::min(nearest, length(o.centre - patch.centre()) - o.radius);
  if (patch.radius() < kSmall * nearest) return over;
  for (const Vec3& corner : patch.corners())  // all of a patch may see of it is from one corner
    for (const std::uint32_t k : in_view(corner, {1, 0})) over.push_back(k);
  std::sort(over.begin(), over.end());
  over.erase(std::unique(over.begin(), over.end()), over.end());
  return over;
}

}  // namespace

Spectrum sky_through_openings(const Illumination& light, std::size_t i, std::uint64_t key,
                              std::vector<std::uint32_t>& looked_at, LightRow* row) {
  const Problem& problem = light.problem;
  const std::span<const LightArea> openings = problem.lights.sky_openings();
  const Patch patch(problem, i);
  looked_at.clear();
  if (openings.empty() || patch.sees_much_sky(mix_bits(key + 1))) return Spectrum(0.0);
  const std::vector<std::uint32_t> over = openings_over(problem.rays, openings, patch, mix_bits(key + 2));

  // Calls found(direction to the sky, weight) for each of the rays that leave by this opening and by none before it.
  const auto look = [&](std::uint32_t number, std::uint64_t stream, std::uint32_t count, bool roughly,
                        const auto& found) {
    const LightArea& opening = openings[number];
    const Vec3 away = opening.centre - patch.centre();
    const bool from_afar = roughly || length(away) - patch.radius() > kAfar * opening.radius;
    std::array<Ray, 16> rays;
    std::array<Hit, 16> hits;
    std::array<double, 16> weights;
    std::size_t queued = 0;
    const auto flush = [&] {
      problem.rays.first_hits(problem.patches, std::span(rays).first(queued), hits);
      for (std::size_t k = 0; k < queued; ++k) {
        const Ray& ray = rays[k];
        const Hit& hit = hits[k];
        if (hit.escaped() && first_way_out(openings, looked_at, ray.origin, ray.direction, hit.first) == number)
          found(hit.direction(ray), hit.transmittance * weights[k]);
      }
      queued = 0;
    };
    for (std::uint32_t k = 0; k < count; ++k) {
      const Aim aim = patch.aim(opening, from_afar, sobol4(k, stream));
      if (!(aim.weight > 0)) continue;
      rays[queued] = aim.ray;
      weights[queued++] = aim.weight;
      if (queued == rays.size()) flush();
    }
    if (queued > 0) flush();
  };
  std::vector<std::uint32_t> seen;
  for (const std::uint32_t k : over) {
    looked_at = {k};
    bool any = false;
    look(k, stream_key(key, k + 1), kPilotRays, true, [&](const Vec3&, const Spectrum&) { any = true; });
    if (any) seen.push_back(k);
  }
  looked_at = seen;
  Spectrum E(0.0);
  for (const std::uint32_t k : looked_at)
    look(k, mix_bits(stream_key(key, k)), kRaysOfOpening, false, [&](const Vec3& direction, const Spectrum& weight) {
      const std::uint32_t sky = pack_direction(direction);
      E += light.sky(unpack_direction(sky)) * weight / kRaysOfOpening;
      if (row) row->push_back(RowEntry::of_sky(sky, weight / kRaysOfOpening));
    });
  return E;
}

}  // namespace clerestory
