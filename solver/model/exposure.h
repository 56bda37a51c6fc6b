#pragma once
// From light to what a screen shows.

#include <cstdint>

#include "solver/model/channels.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Factor [m2/W] from light, irradiance or radiosity, to linear values of a screen, of which 1 is white: 2^ev times
/// the one that shows irradiance as it is in the middle of the rooms (geometric mean by area, open air left out
/// where there are rooms) as kMiddleLight, or less, so that four fifths of them are no brighter than 0.8. 1 where no
/// light is.
double exposure_of(const WrittenResult& result, double ev);
inline constexpr double kMiddleLight = 0.36;  ///< a surface that reflects half of it is middle grey, 0.18

/// sRGB of a linear value, clipped to [0, 1].
/// Source: IEC 61966-2-1:1999.
double srgb_encoded(double linear);
std::uint8_t srgb_byte(double linear);

}  // namespace clerestory
