#include "solver/lights/point_luminaire.h"

#include <numbers>

#include "solver/model/units.h"

namespace clerestory {

Spectrum intensity(const PointLuminaire& luminaire, const Vec3&) { return luminaire.power / (4 * std::numbers::pi); }

Spectrum power(const PointLuminaire& luminaire) { return luminaire.power; }

LightBounds bounds(const PointLuminaire& luminaire, const Vec3& position) {
  return {position, position, {}, std::numbers::pi, luminous_mean(intensity(luminaire, {}))};
}

}  // namespace clerestory
