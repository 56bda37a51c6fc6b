#pragma once
// A result -> what a page's 3D view is drawn from, as elements of the page. io/page/solution.mjs reads it.
//
//   solution-head       JSON: centre, names, ranges, rooms as runs of triangles, luminaires
//   solution-positions  float32 x y z a point, relative to the centre [m]
//   solution-light      uint16 a point: 0 is no light, 1 to 65535 even steps of log(lx) between the head's `light`
//   solution-shades     uint8 a point, or three: sRGB of the radiosity as exposed
//   solution-corners    uint32 three a triangle, each as its distance back from the next new point
//   solution-runs       uint32 count, room, surface, material of the triangles that follow one another
//   solution-panes      float32 nine a triangle of glass
//   solution-layers     uint16 a point, layer by layer, between the head's `layers`; empty: there are none
//   solution-shares     uint8 as these: share of the radiosity in 255ths; empty: it is that of the illuminance
//
// All but the head are zlib streams in base 64, of numbers whose bytes of equal weight lie together.

#include <span>
#include <string>
#include <vector>

#include "solver/model/written_result.h"

namespace clerestory {

/// Illuminance in it is within 0.02 % of the result's, where that is at least 1e-9 of the largest.
///
/// levels     of isolux lines [lx]
/// low, high  of the colours [lx]
struct SolutionData {
  std::string elements;
  std::vector<std::string> parts;  ///< names of what can be looked at alone, as in the head
};
SolutionData solution_data(const WrittenResult& result, std::span<const double> levels, double low, double high);

}  // namespace clerestory
