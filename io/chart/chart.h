#pragma once
// A picture of lines, discs and words, as SVG and as PNG. No font and no display is needed for either.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace clerestory {

struct Ink {
  std::uint8_t r = 0, g = 0, b = 0;
};

/// From the upper left corner, y down, in pixels. Later shapes lie over earlier ones.
struct Chart {
  struct Line {
    double x1, y1, x2, y2, width;
    Ink ink;
  };
  struct Disc {
    double x, y, radius;
    Ink ink;
  };
  enum class Anchor { start, middle, end };
  /// One line of ASCII; y is that of its baseline, size the height of a line.
  struct Words {
    double x, y, size;
    Anchor anchor;
    std::string text;
    Ink ink;
  };
  int width = 0, height = 0;
  std::vector<std::variant<Line, Disc, Words>> shapes;
};

/// As an element that stands alone or inside of a page.
std::string svg_of(const Chart& chart);

/// As the bytes of a PNG file, white where nothing is drawn. Words are set in strokes of a 5 x 7 dot matrix.
///
/// throws  InputError as require_picture_files().
std::string png_of(const Chart& chart);

}  // namespace clerestory
