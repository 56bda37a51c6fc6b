#pragma once
// A light small enough to draw the edges of shadows: the sun, or a luminaire.

#include <cstdint>
#include <vector>

#include "solver/illumination/problem.h"

namespace clerestory {

/// How much of a light a point sees.
enum class LightSeen : std::uint8_t { none, part, all };

/// The sun or a luminaire, as a disc or an opening with a rim. Images in mirrors are none: their light has other edges,
/// those of the mirror.
class SharpLight {
 public:
  SharpLight(const Problem& problem, const PlacedSun& sun) : problem_(&problem), sun_(&sun) {}
  SharpLight(const Problem& problem, const PlacedLuminaire& luminaire) : problem_(&problem), luminaire_(&luminaire) {}

  /// What it gives at p on a plane of normal n where nothing blocks, luminous mean [W/m2].
  double open_irradiance(const Vec3& p, const Vec3& n) const;
  /// Segment to its centre, from p on a surface of normal n; both ends lifted.
  void segment(const Vec3& p, const Vec3& n, Vec3& from, Vec3& to) const;
  bool sees_centre(const Vec3& p, const Vec3& n) const;
  /// By sixteen rays to its rim, one where it is a point: its width is known to 2 %.
  LightSeen seen(const Vec3& p, const Vec3& n) const;

 private:
  Vec3 rim(const Vec3& p, int k) const;
  const Problem* problem_;
  const PlacedSun* sun_ = nullptr;
  const PlacedLuminaire* luminaire_ = nullptr;
};

/// All of a problem's lights that shadows may have edges of, suns first.
std::vector<SharpLight> sharp_lights(const Problem& problem);

}  // namespace clerestory
