#pragma once
// What is seen through slits, whatever elements it is looked up on.

#include <vector>

namespace clerestory {

/// Radiosity where lines through each slit end, luminous mean [W/m2].
struct SlitLight {
  static constexpr float kNowhere = -1;   ///< of lines that end on no patch
  std::vector<std::vector<float>> there;  ///< by number in Lights::openings, by line; empty: not known, or no slits
};

}  // namespace clerestory
