#include "solver/model/lightmap_atlas.h"

#include <cstddef>

namespace clerestory {

float LightmapAtlas::lookup(float u, float v, int channel) const {
  const double x = std::clamp(double{u} * width - 0.5, 0.0, width - 1.0);
  const double y = std::clamp(double{v} * height - 0.5, 0.0, height - 1.0);
  const int i = std::min(static_cast<int>(x), width - 2), j = std::min(static_cast<int>(y), height - 2);
  const auto texel = [&](int column, int row) {
    return double{at(static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column),
                     channel)};
  };
  const double s = x - i, t = y - j;
  return static_cast<float>((1 - t) * ((1 - s) * texel(i, j) + s * texel(i + 1, j)) +
                            t * ((1 - s) * texel(i, j + 1) + s * texel(i + 1, j + 1)));
}

}  // namespace clerestory
