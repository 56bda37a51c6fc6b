#pragma once
// A picture as numbers.

#include <cstddef>
#include <vector>

namespace clerestory {

/// Row by row from the top.
struct ViewImage {
  int width = 0, height = 0, channels = 1;
  std::vector<float> value;  ///< mean over each pixel, 0 where nothing is seen; rows of so many channels
  std::vector<float> seen;   ///< share of each pixel that shows something [1]

  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool empty() const { return seen.empty(); }
};

}  // namespace clerestory
