#include "solver/illumination/near_luminaires.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/geometry/triangle.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/luminaire_view.h"
#include "solver/lights/near_planes.h"
#include "solver/model/coordinate_grid.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

// Of the scene's diameter: floats resolve 6e-8 of it, and what rays are lifted by is 5e-7.
constexpr double kClearance = 2e-6;
constexpr double kFloatRounding = 1.2e-7;                  // of a coordinate: two roundings
constexpr std::size_t kMostFound = 256, kMostPlanes = 24;  // of a luminaire; the nearest
constexpr std::uint32_t kRays = 128;  // that tell where its light goes, and whether its side is open

struct Found {
  NearPlane plane;
  double distance;  ///< of the surface from the luminaire's position [m]
};

/// Box around a luminaire's opening, so much wider.
struct Reach {
  Vec3 lower, upper;
  std::uint32_t luminaire;
};

/// Planes of all triangles within twice the clearance of the luminaires, by luminaire, each once; those nearer to each
/// other than `exact` are one.
std::vector<std::vector<Found>> planes_around(const std::vector<PlacedLuminaire>& luminaires, const PatchSet& patches,
                                              double clearance, double exact) {
  std::vector<Reach> by_x;
  double widest = 0;
  const Vec3 margin{2 * clearance, 2 * clearance, 2 * clearance};
  for (std::uint32_t k = 0; k < luminaires.size(); ++k) {
    const LightBounds b = bounds(luminaires[k]);
    by_x.push_back({b.lower - margin, b.upper + margin, k});
    widest = std::max(widest, by_x.back().upper.x - by_x.back().lower.x);
  }
  std::ranges::stable_sort(by_x, {}, [](const Reach& r) { return r.lower.x; });
  std::vector<std::vector<Found>> found(luminaires.size());
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    const std::array<Vec3, 3> c{patches.vertices[patches.corners[t][0]], patches.vertices[patches.corners[t][1]],
                                patches.vertices[patches.corners[t][2]]};
    const Vec3 lower{std::min({c[0].x, c[1].x, c[2].x}), std::min({c[0].y, c[1].y, c[2].y}),
                     std::min({c[0].z, c[1].z, c[2].z})};
    const Vec3 upper{std::max({c[0].x, c[1].x, c[2].x}), std::max({c[0].y, c[1].y, c[2].y}),
                     std::max({c[0].z, c[1].z, c[2].z})};
    const auto first = std::ranges::lower_bound(by_x, lower.x - widest, {}, [](const Reach& r) { return r.lower.x; });
    for (auto at = first; at != by_x.end() && at->lower.x <= upper.x; ++at) {
      if (at->upper.x < lower.x || at->lower.y > upper.y || at->upper.y < lower.y || at->lower.z > upper.z ||
          at->upper.z < lower.z)
        continue;
      const PlacedLuminaire& luminaire = luminaires[at->luminaire];
      const Vec3& q = luminaire.position;
      const double distance = length(nearest_point(c, q) - q);
      const Vec3 n = normalized(cross(c[1] - c[0], c[2] - c[0]));
      if (!(distance <= 2 * clearance + reach(luminaire)) || !(dot(n, n) > 0.5)) continue;
      const NearPlane plane{n, dot(n, c[0]), clearance};
      auto& planes = found[at->luminaire];
      const auto same = std::ranges::find_if(planes, [&](const Found& f) {
        const double along = dot(f.plane.normal, n);
        return std::abs(along) > 1 - 1e-12 && std::abs(plane.height(q) * along - f.plane.height(q)) < exact;
      });
      if (same != planes.end())
        same->distance = std::min(same->distance, distance);
      else if (planes.size() < kMostFound)
        planes.push_back({plane, distance});
    }
  }
  return found;
}

/// Whether most of the light of the luminaire goes to the side of `towards` (unit) of its position.
bool shines_mostly(const Luminaire& luminaire, const Vec3& towards) {
  const Beam beam = beam_of(luminaire);
  double there = 0, all = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, 1);
    const Vec3 d = direction_in(beam, u[0], u[1]);
    const double I = luminous_mean(intensity(luminaire, d));
    all += I;
    if (dot(d, towards) > 0) there += I;
  }
  return there > 0.5 * all;
}

/// Whether rays from q to the side of `n` leave the scene.
bool is_open(const PatchSet& patches, const RayScene& rays, const Vec3& q, const Vec3& n) {
  const Frame frame(n);
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, 2);
    if (rays.first_hit(patches, {q, cosine_direction(frame, u[0], u[1])}).escaped()) return true;
  }
  return false;
}

}  // namespace

void find_near_planes(Lights& lights, const PatchSet& patches, const RayScene& rays) {
  if (lights.luminaires.empty()) return;
  const double clearance = kClearance * rays.diameter(), exact = kCoordinateGrid * rays.diameter();
  auto found = planes_around(lights.luminaires, patches, clearance, exact);
  for (std::size_t k = 0; k < found.size(); ++k) {
    PlacedLuminaire& luminaire = lights.luminaires[k];
    std::vector<Found>& around = found[k];
    std::ranges::stable_sort(around, {}, &Found::distance);
    if (around.size() > kMostPlanes) around.resize(kMostPlanes);
    for (Found& f : around) {
      const double height = f.plane.height(luminaire.position);
      const double coordinate = std::abs(dot(f.plane.normal, luminaire.position + patches.origin));
      const Vec3 up = height < 0 ? -f.plane.normal : f.plane.normal;  // to its own side
      f.plane.is_mount = std::abs(height) <= exact ||
                         (std::abs(height) <= kFloatRounding * coordinate && shines_mostly(luminaire, -up) &&
                          is_open(patches, rays, luminaire.position + up * (clearance - std::abs(height)), up));
    }
    // In a slot narrower than two clearances rays keep to its middle.
    for (Found& f : around)
      for (const Found& other : around) {
        const double own = f.plane.height(luminaire.position), theirs = other.plane.height(luminaire.position);
        const bool opposite = dot(f.plane.normal, other.plane.normal) * own * theirs < 0;
        if (opposite && std::abs(dot(f.plane.normal, other.plane.normal)) > 0.5 && !f.plane.is_mount &&
            !other.plane.is_mount)
          f.plane.clearance = std::min(f.plane.clearance, 0.4 * (std::abs(own) + std::abs(theirs)));
      }
    luminaire.near_planes.clear();
    for (const Found& f : around) luminaire.near_planes.push_back(f.plane);
  }
}

std::vector<bool> patches_near_luminaires(const PatchSet& patches, const Lights& lights) {
  if (lights.luminaires.empty()) return std::vector<bool>(patches.patch_count());
  std::vector<Beam> beams;
  for (const Luminaire& luminaire : lights.luminaires) beams.push_back(beam_of(luminaire));
  std::vector<char> near(patches.patch_count(), 0);
  parallel_for(near.size(), 256, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) {
      const auto corners = patches.corner_positions(PatchId{i});
      for (std::size_t k = 0; k < beams.size() && !near[i]; ++k)
        near[i] =
            wants_view(lights.luminaires[k], beams[k], corners) && !is_behind(lights.luminaires[k], beams[k], corners);
    }
  });
  return {near.begin(), near.end()};
}

}  // namespace clerestory
