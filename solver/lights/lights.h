#pragma once
// The light of a scene as a solve wants it: where it stands among the patches, and what was found out about it.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "solver/lights/caustic_leg.h"
#include "solver/model/box.h"
#include "solver/model/light_spec.h"
#include "solver/visibility/mirror_planes.h"

namespace clerestory {

/// Plane of a surface that a luminaire stands so near to that rays in float may start on its wrong side.
struct NearPlane {
  Vec3 normal;            ///< unit
  double offset = 0;      ///< dot(normal, x) = offset in the plane [m]
  double clearance = 0;   ///< distance that ends of rays keep from it [m], > 0
  bool is_mount = false;  ///< the luminaire is mounted in it: in the very plane, as recessed downlights are

  double height(const Vec3& x) const { return dot(normal, x) - offset; }
};

/// A luminaire, or its image behind mirrors or panes.
struct PlacedLuminaire : Luminaire {
  MirrorWay way{};                       ///< of an image: the planes (RayScene::mirrors) that show it
  std::vector<NearPlane> near_planes{};  ///< of surfaces around it; see find_near_planes()
  double share = 1;         ///< about what is left of its light on that way; how much an image is worth looking for [1]
  std::uint32_t shows = 0;  ///< of an image: the luminaire, by number

  bool is_image() const { return !way.empty(); }
};

/// The sun, or its image.
struct PlacedSun : Sun {
  MirrorWay way{};          ///< as of PlacedLuminaire
  double share = 1;         ///< as of PlacedLuminaire
  std::uint32_t shows = 0;  ///< of an image: the sun, by number among suns

  bool is_image() const { return !way.empty(); }
};

/// A plane polygon that light comes out of on one side: a gap between surfaces through which the sky or a bright room
/// looks into a room, or bright patches that lie together. Only a hint where to look: what it misses is found as well.
struct LightArea {
  std::vector<Vec3> corners;                   ///< counter-clockwise around the normal, local frame [m]
  std::vector<std::array<Vec3, 3>> triangles;  ///< that cover it, wound alike [m]
  Vec3 centre, normal;                         ///< normal: unit, to where the light goes
  double radius = 0, area = 0;                 ///< radius: farthest point from the centre [m], area [m2]
  double brightness = 0;                       ///< mean radiance that comes out of it [W/(m2 sr)]
  bool sees_sky = true;                        ///< false: of an opening that only surfaces send light through
  std::optional<Box> reach;                    ///< where it is in view, about; none: not known
};

/// Positions are in the local frame of the patches.
struct Lights {
  std::vector<PlacedLuminaire> luminaires;  ///< the scene's, then images
  std::optional<Sky> sky;
  std::vector<PlacedSun> suns;  ///< the scene's, then images
  std::size_t times = 1;        ///< as of LightSpec
  double lost_in_mirrors =
      0;              ///< about the share of luminaires' and suns' light on ways that have no image, caustics apart [1]
  Caustics caustics;  ///< what turns their light and shows no image; empty: there is no such thing
  std::vector<LightArea> openings;  ///< found by find_openings(); sky without any is right as well, only noisier

  /// Those through which the sky is seen: they come first.
  std::span<const LightArea> sky_openings() const {
    const auto end = std::ranges::find(openings, false, &LightArea::sees_sky);
    return {openings.begin(), end};
  }

  bool empty() const { return luminaires.empty() && !sky && suns.empty(); }
};

}  // namespace clerestory
