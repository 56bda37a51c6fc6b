#include "solver/model/radiosity_at_points.h"

#include <algorithm>

namespace clerestory {
namespace {

/// Irradiance behind a diffuser's patch p at x, linear between the points of the patch that lies there.
Spectrum irradiance_behind(const PatchSet& patches, const VertexLightmap& lightmap, const Field& E_points,
                           std::size_t p, const Vec3& x) {
  Spectrum E(0.0);
  double best = -1e300;
  for (const PatchSet::Behind& other : patches.patches_behind(p)) {
    const auto c = patches.corner_positions(other.patch);
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    const double v = dot(cross(c[2] - x, c[0] - x), n) / dot(n, n), w = dot(cross(c[0] - x, c[1] - x), n) / dot(n, n);
    const double inside = std::min({1 - v - w, v, w});
    if (!(inside > best)) continue;
    best = inside;
    const auto& point = lightmap.corners[other.patch];
    E = E_points[point[0]] * (1 - v - w) + E_points[point[1]] * v + E_points[point[2]] * w;
  }
  return E;
}

}  // namespace

Field radiosity_at_points(const PatchSet& patches, const VertexLightmap& lightmap, const Field& E, const Field& M) {
  Field B(lightmap.position.size(), E.channels);
  for (std::size_t i = 0; i < B.size(); ++i) {
    const std::size_t p = lightmap.patch_of_point[i];
    B.set(i, M[p] + patches.rho[p] * E[i]);
    if (!patches.patches_behind(p).empty())
      B.add(i, patches.tau[p] * irradiance_behind(patches, lightmap, E, p, lightmap.position[i]));
  }
  return B;
}

}  // namespace clerestory
