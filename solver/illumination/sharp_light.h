#pragma once
// A light small enough to draw the edges of shadows: the sun, or a luminaire.

#include <cstdint>
#include <span>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/lights/near_planes.h"

namespace clerestory {

/// How much of a light a point sees.
enum class LightSeen : std::uint8_t { none, part, all };

/// The sun or a luminaire, or the image of one, as a disc or an opening with a rim.
class SharpLight {
 public:
  SharpLight(const Problem& problem, const PlacedSun& sun) : problem_(&problem), sun_(&sun) {}
  SharpLight(const Problem& problem, const PlacedLuminaire& luminaire) : problem_(&problem), luminaire_(&luminaire) {}

  /// What it gives at p on a plane of normal n where nothing blocks, of an image about that, luminous mean [W/m2].
  double open_irradiance(const Vec3& p, const Vec3& n) const;
  /// Whether any of a triangle may see it: not where its image's beam passes by.
  bool may_reach(std::span<const Vec3, 3> corners) const;
  /// From which of up to 16 points on a surface of normal n its centre is seen: a bit each.
  std::uint16_t see_centre(std::span<const Vec3> points, const Vec3& n) const;
  bool sees_centre(const Vec3& p, const Vec3& n) const { return see_centre({&p, 1}, n) != 0; }
  /// By sixteen rays to its rim, one where it is a point: its width is known to 2 %.
  LightSeen seen(const Vec3& p, const Vec3& n) const;

 private:
  ShadowSegment to_centre(const Vec3& p, const Vec3& n) const;
  ShadowSegment to_rim(const Vec3& from, int k) const;
  std::uint16_t free(std::span<const ShadowSegment> segments) const;

  const Problem* problem_;
  const PlacedSun* sun_ = nullptr;
  const PlacedLuminaire* luminaire_ = nullptr;
};

/// A problem's suns and luminaires, suns first; of more than `most` luminaires those of most power.
std::vector<SharpLight> sharp_lights(const Problem& problem, std::size_t most);

}  // namespace clerestory
