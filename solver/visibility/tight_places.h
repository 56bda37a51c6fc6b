#pragma once
// Where surfaces lie too near each other for rays in float.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/model/box_tree.h"
#include "solver/model/patch_set.h"

namespace clerestory {

/// A triangle is tight when the end of a ray that is lifted off it by `lift` could be beyond another surface: when one
/// comes within two lifts of it, above or below, and not only beside an edge where surfaces meet at more than about 6
/// degrees. Panels close below a ceiling, sheets before each other, the apex of a wedge, facets where a sphere touches
/// a plane; and triangles no larger than a few lifts, which float cannot place.
///
/// Cost: O(T log T), about 1 us a triangle and core.
class TightPlaces {
 public:
  TightPlaces() = default;
  TightPlaces(const PatchSet& patches, double lift);

  bool any() const { return tree_.has_value(); }
  bool is_tight(TriangleId t) const { return t.valid() && !tight_.empty() && tight_[t] == Kind::tight; }
  /// Whether no place on triangle t lies within two lifts of a tight one; of most triangles.
  bool is_clear(TriangleId t) const { return tight_.empty() || tight_[t] == Kind::clear; }
  /// Whether p lies within two lifts of a tight triangle.
  bool contains(const Vec3& p) const;

 private:
  /// Cells of space; those that no tight triangle comes near to need no look at the triangles.
  class Cells {
   public:
    void lay(const std::vector<std::array<Vec3, 3>>& triangles, double reach);
    bool may_hold(const Vec3& p) const;

   private:
    using Range = std::array<std::array<std::size_t, 2>, 3>;  ///< by axis: first cell, and the one behind the last
    void mark(const std::array<Vec3, 3>& triangle, double reach, const Range& range);

    Vec3 lower_;
    double per_metre_ = 0;
    std::array<std::size_t, 3> count_{};
    std::vector<bool> is_near_;
  };

  double reach_ = 0;
  enum class Kind : std::uint8_t { clear, beside, tight };
  std::vector<Kind> tight_;                     ///< T; empty: all are clear
  std::vector<std::array<Vec3, 3>> triangles_;  ///< the tight ones
  std::optional<BoxTree<StoredBoxes>> tree_;    ///< of their boxes, grown by the reach
  Cells cells_;
};

}  // namespace clerestory
