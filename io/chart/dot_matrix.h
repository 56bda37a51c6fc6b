#pragma once
// Letters of character displays, five dots wide and seven high, as strokes between neighbouring dots.

#include <vector>

namespace clerestory {

inline constexpr double kDotsToNext = 6;     ///< from a letter to the next
inline constexpr double kDotsAboveBase = 7;  ///< of a capital
inline constexpr double kLineOfDots = 10;    ///< from a line to the next

/// From dot to dot, x to the right and y down from the upper left one; a dot alone is a stroke to itself.
struct DotStroke {
  double x1, y1, x2, y2;
};
/// Of an ASCII character; others are drawn as '?'.
std::vector<DotStroke> strokes_of(char c);

}  // namespace clerestory
