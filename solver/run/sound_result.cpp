#include "solver/run/sound_result.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace clerestory {

void require_sound(Field& values, std::string_view name) {
  constexpr double kRounding = 1e-4;
  double largest = 0;
  for (const double x : values.value) {
    if (!std::isfinite(x)) throw std::logic_error(std::string(name) + " came out as no number");
    largest = std::max(largest, x);
  }
  for (double& x : values.value) {
    if (x < -kRounding * largest)
      throw std::logic_error(std::string(name) + " came out negative, as " + std::to_string(x));
    x = std::max(0.0, x);
  }
}

}  // namespace clerestory
