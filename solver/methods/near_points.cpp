#include "solver/methods/near_points.h"

#include <cmath>

#include "solver/model/units.h"

namespace clerestory {

std::vector<std::uint32_t> carry_flux_to_points(const PatchSet& patches, const Field& E,
                                                std::span<const std::uint32_t> of, VertexLightmap& lightmap) {
  constexpr double kResolved = 0.05;
  std::vector<bool> off(lightmap.position.size());
  std::vector<std::uint32_t> points;
  for (const std::uint32_t i : of) {
    const auto& c = lightmap.corners[i];
    const double mean = luminous_mean(lightmap.E[c[0]] + lightmap.E[c[1]] + lightmap.E[c[2]]) / 3;
    const double exact = luminous_mean(E[i]);
    if (std::abs(mean - exact) <= kResolved * exact) continue;
    for (const std::uint32_t p : c)
      if (!off[p]) {
        off[p] = true;
        points.push_back(p);
      }
  }
  if (points.empty()) return points;
  std::vector<double> area(off.size(), 0.0);
  for (const std::uint32_t p : points) lightmap.E.set(p, Spectrum(0.0));
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    for (const std::uint32_t p : lightmap.corners[i])
      if (off[p]) {
        lightmap.E.add(p, E[i] * patches.area[i]);
        area[p] += patches.area[i];
      }
  for (const std::uint32_t p : points) lightmap.E.set(p, lightmap.E[p] / area[p]);
  return points;
}

}  // namespace clerestory
