#include "solver/lights/beam.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/lights/luminaire.h"
#include "solver/lights/spot_luminaire.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// [rad] By judgement: photometric files have an angle every 2.5 to 5 degrees, and change slowly but for narrow beams.
constexpr double kCoarsest = 0.15, kFinest = 2e-3;
constexpr double kShareOfBeam = 0.4;  // of the half-angle of a cone that the peak would fill with all the flux

}  // namespace

Beam beam_of(const Luminaire& luminaire) {
  const LightBounds b = bounds(luminaire);
  Beam beam{b.axis, b.cone < std::numbers::pi ? b.cone : std::numbers::pi, b.power, luminous_mean(power(luminaire)), 0};
  if (const auto* spot = std::get_if<SpotLuminaire>(&luminaire.kind)) {
    beam.peak = luminous_mean(intensity(*spot, spot->direction));  // less than nominal in a very narrow cone
    beam.edge_from = std::min(spot->inner_angle, spot->outer_angle), beam.edge_to = spot->outer_angle;
  }
  const double filled = beam.peak > 0 ? beam.flux / (std::numbers::pi * beam.peak) : 0;  // square of that half-angle
  beam.finest = std::clamp(kShareOfBeam * std::sqrt(filled), kFinest, kCoarsest);
  beam.is_even = std::holds_alternative<PointLuminaire>(luminaire.kind);
  beam.depth = dot({std::abs(b.axis.x), std::abs(b.axis.y), std::abs(b.axis.z)}, b.upper - b.lower) / 2;
  return beam;
}

bool is_behind(const Luminaire& luminaire, const Beam& beam, const std::array<Vec3, 3>& corners) {
  constexpr double kRightAngle = std::numbers::pi / 2 + 1e-5;
  if (beam.half_angle > kRightAngle) return false;
  return std::ranges::all_of(
      corners, [&](const Vec3& c) { return dot(c - luminaire.position, beam.axis) <= 1e-9 - beam.depth; });
}

Vec3 direction_in(const Beam& beam, double u, double v) {
  const Frame frame(beam.half_angle < std::numbers::pi ? beam.axis : Vec3{0, 0, 1});
  const double z = 1 - u * (1 - std::cos(beam.half_angle)), r = std::sqrt(std::max(0.0, 1 - z * z));
  const double phi = 2 * std::numbers::pi * v;
  return frame.to_world(r * std::cos(phi), r * std::sin(phi), z);
}

}  // namespace clerestory
