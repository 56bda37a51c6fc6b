#include "solver/openings/slit_gains.h"

#include <algorithm>
#include <cmath>

namespace clerestory {

std::size_t SlitGains::bin(const LightArea& slit, double distance) {
  const double widths = distance * 2 * slit.radius / slit.area;
  return std::min(kBins - 1, static_cast<std::size_t>(std::log2(std::max(1.0, widths))));
}

}  // namespace clerestory
