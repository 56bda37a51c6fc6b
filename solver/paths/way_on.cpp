#include "solver/paths/way_on.h"

#include <numbers>

#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr double kBySlit = 0.5;

}  // namespace

double density_of_ways(const Illumination& light, const Vec3& p, const Vec3& n, const Vec3& d) {
  const double cosine = dot(n, d) / std::numbers::pi;
  return light.slits.reaches(p, n) ? (1 - kBySlit) * cosine + kBySlit * light.slits.preference(p, n, d) : cosine;
}

WayOn way_on(const Illumination& light, const Vec3& p, const Vec3& n, const std::array<double, 2>& square,
             RandomStream& random) {
  const bool has_slits = light.slits.reaches(p, n);
  if (!has_slits || random.uniform() >= kBySlit) {
    const Vec3 d = cosine_direction(Frame(n), square[0], square[1]);
    const double density = density_of_ways(light, p, n, d);
    return {d, density, has_slits ? dot(n, d) / std::numbers::pi / density : 1.0};
  }
  const OpeningSampler::Sample s = light.slits.sample(p, n, random.uniform(), square[0], square[1]);
  const double cosine = dot(n, s.direction) / std::numbers::pi;
  if (!(s.per_choice > 0) || !(cosine > 0)) return {s.direction, 0, 0, true};
  const double density =
      (1 - kBySlit) * cosine + kBySlit * (s.preference + light.slits.preference(p, n, s.direction, s.opening));
  return {s.direction, density, cosine * s.per_choice * s.preference / density, true};
}

}  // namespace clerestory
