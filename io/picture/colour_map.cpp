#include "io/picture/colour_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace clerestory {

std::array<double, 3> viridis(double t) {
  constexpr std::size_t kTerms = 7;
  constexpr double c[kTerms][3] = {
      {0.2777273272234177, 0.005407344544966578, 0.3340998053353061},
      {0.1050930431085774, 1.404613529898575, 1.384590162594685},
      {-0.3308618287255563, 0.214847559468213, 0.09509516302823659},
      {-4.634230498983486, -5.799100973351585, -19.33244095627987},
      {6.228269936347081, 14.17993336680509, 56.69055260068105},
      {4.776384997670288, -13.74514537774601, -65.35303263337234},
      {-5.435455855934631, 4.645852612178535, 26.3124352495832},
  };
  const double x = std::clamp(t, 0.0, 1.0);
  std::array<double, 3> rgb{};
  for (std::size_t i = kTerms; i-- > 0;)
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = rgb[k] * x + c[i][k];
  for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
  return rgb;
}

double place_in_range(double value, double low, double high, bool by_logarithm) {
  if (!(high > low)) return value < low ? 0 : 1;
  if (!by_logarithm) return std::clamp((value - low) / (high - low), 0.0, 1.0);
  return value <= low ? 0 : std::min(std::log(value / low) / std::log(high / low), 1.0);
}

}  // namespace clerestory
