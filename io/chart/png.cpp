#include "io/chart/draw.h"
#include "io/picture/encode.h"

namespace clerestory {

std::string png_of(const Chart& chart) {
  Pixels pixels(chart.width, chart.height, 255);
  draw(chart, pixels);
  return png_bytes(chart.width, chart.height, pixels.rgb);
}

}  // namespace clerestory
