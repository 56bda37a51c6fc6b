#pragma once
// Which triangles of a result cover the faces of a model.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/model/vec.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// What covers a corner of one side of a face.
struct CornerCover {
  static constexpr std::uint32_t kNone = 0xffffffff, kPane = 0xfffffffe;
  std::uint32_t triangle = kNone;  ///< of the result
  std::array<float, 3> weight{};   ///< of its points, sum 1

  /// Nothing covers it: it lies under something, and the light is that nearest to it; or it has none as its face is too
  /// narrow for the mesher to keep.
  bool is_hidden = false;

  bool is_lit() const { return triangle < kPane; }
  bool is_pane() const { return triangle == kPane; }
};

struct CoveredModel {
  /// 6 a triangle of the model: the corners of its front, then of its back. A side has either no covering corner or
  /// all three; a pane's are all kPane.
  std::vector<CornerCover> covering;
  double missing_share = 0;  ///< of the result's area, that is on no triangle of the model [1]
};

/// triangles  of the model, scene's frame [m], counter-clockwise around the front.
CoveredModel cover_model(const WrittenResult& result, std::span<const std::array<Vec3, 3>> triangles);

}  // namespace clerestory
