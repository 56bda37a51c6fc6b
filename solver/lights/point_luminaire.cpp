#include "solver/lights/point_luminaire.h"

#include <numbers>

#include "solver/model/units.h"

namespace clerestory {

Spectrum intensity(const PointLuminaire& lamp, const Vec3&) { return lamp.power / (4 * std::numbers::pi); }

Spectrum power(const PointLuminaire& lamp) { return lamp.power; }

LightBounds bounds(const PointLuminaire& lamp, const Vec3& position) {
  return {position, position, {}, std::numbers::pi, luminous_mean(intensity(lamp, {}))};
}

}  // namespace clerestory
