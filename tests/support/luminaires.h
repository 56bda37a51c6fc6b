#pragma once
// Luminaires by what tests want to say of them.

#include "solver/lights/lights.h"

namespace clerestory::test {

inline PlacedLuminaire point_lamp(const Vec3& position, double power) {
  return {{"lamp", position, {}, PointLuminaire{Spectrum(power)}}};
}
inline PlacedLuminaire spot_lamp(const Vec3& position, const Vec3& direction, double intensity, double inner,
                                 double outer) {
  return {{"spot", position, {}, SpotLuminaire{direction, Spectrum(intensity), inner, outer}}};
}
inline const PointLuminaire& as_point(const Luminaire& lamp) { return std::get<PointLuminaire>(lamp.kind); }
inline const SpotLuminaire& as_spot(const Luminaire& lamp) { return std::get<SpotLuminaire>(lamp.kind); }
inline const WebLuminaire& as_web(const Luminaire& lamp) { return std::get<WebLuminaire>(lamp.kind); }

}  // namespace clerestory::test
