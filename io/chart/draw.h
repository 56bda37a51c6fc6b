#pragma once
// Shapes onto pixels, without a font and without a display.

#include <cstdint>
#include <vector>

#include "io/chart/chart.h"

namespace clerestory {

/// sRGB, three bytes a pixel, row by row from the top.
struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Pixels() = default;
  Pixels(int w, int h, std::uint8_t grey)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h), grey) {}
  std::uint8_t* at(int x, int y) {
    return &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
  }
};

/// Puts `share` of the ink over a pixel.
void ink_pixel(std::uint8_t* pixel, const Ink& ink, double share);

/// Shapes are drawn by their distance: a pixel is covered as far as its middle is inside of the edge. Words are set in
/// strokes of a 5 x 7 dot matrix.
void draw(const Chart& chart, Pixels& onto);
/// A line over all corners, as one stroke: where its parts meet it is covered once.
struct Corner {
  double x, y;
};
void draw_stroke(const std::vector<Corner>& corners, double width, const Ink& ink, Pixels& onto);

/// Width of a line of words [pixel].
double width_of_words(const std::string& words, double size);

}  // namespace clerestory
