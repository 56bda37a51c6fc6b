#pragma once
// Which sides of a model are glossy, the lobes of their materials, and the planes that they lie in.

#include <array>
#include <cstdint>
#include <vector>

#include "solver/model/gloss.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/mirror_planes.h"

namespace clerestory {

class GlossySides {
 public:
  GlossySides() = default;
  /// diameter  of the model [m].
  GlossySides(const PatchSet& patches, double diameter);

  bool empty() const { return lobes_.empty(); }
  /// Null: that side is not glossy.
  const Lobe* lobe(TriangleId t, Side side) const {
    if (empty() || !t.valid() || number_[t][side] == kNone) return nullptr;
    return &lobes_[number_[t][side]];
  }

  /// One of the planes that glossy sides lie in.
  struct Plane {
    MirrorPlane place;
    double sharpness = 0;  ///< of its narrowest lobe
  };
  /// Those of largest area.
  const std::vector<Plane>& planes() const { return planes_; }
  /// Of a glossy triangle, its number there; kNoPlane: it is in none of them.
  std::uint32_t plane(TriangleId t) const { return plane_[t]; }
  /// Null, or the lobe of that side where it is so narrow that rays all around do not find a light over it, and in no
  /// plane that they look at: particles find what it sends on (illumination/caustic_legs.h).
  const Lobe* narrow_without_plane(TriangleId t, Side side) const {
    const Lobe* of_side = lobe(t, side);
    return of_side && of_side->sharpness() >= kNarrow && plane_[t] == kNoPlane ? of_side : nullptr;
  }

 private:
  static constexpr double kNarrow = 50;  // exponent, by judgement
  static constexpr std::uint16_t kNone = 0xffff;
  std::vector<Lobe> lobes_;  ///< by glossy material
  // By triangle; empty without gloss.
  std::vector<std::array<std::uint16_t, 2>> number_;  ///< in lobes_, by Side
  std::vector<std::uint32_t> plane_;
  std::vector<Plane> planes_;
};

}  // namespace clerestory
