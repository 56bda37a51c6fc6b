#include "io/page/css_colour.h"

#include <cmath>
#include <cstdio>

#include "io/picture/colour_map.h"

namespace clerestory {

std::string css_colour(double t) {
  const auto rgb = viridis(t);
  const auto byte = [&](std::size_t k) { return static_cast<unsigned>(std::lround(255 * rgb[k])); };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(0), byte(1), byte(2));
  return text;
}

}  // namespace clerestory
