#pragma once
// Gaps between surfaces through which the sky looks in: found once, then looked at like lamps.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solver/lights/lights.h"
#include "solver/model/patch_set.h"
#include "solver/visibility/ray_scene.h"

namespace clerestory {

/// Around an opening: all that most rays need to know of it.
struct OpeningSphere {
  explicit OpeningSphere(const LightArea& opening)
      : centre(opening.centre), normal(opening.normal), radius2(opening.radius * opening.radius) {}
  Vec3 centre, normal;
  double radius2;

  /// Whether the line from p along d (unit) passes it on the way out.
  bool is_passed(const Vec3& p, const Vec3& d) const {
    if (!(dot(d, normal) < 0)) return false;
    const Vec3 to_centre = centre - p;
    const double along = dot(to_centre, d);
    return dot(to_centre, to_centre) - along * along <= radius2;
  }
};

/// Where the ray from p along d (unit) passes the opening on its way out [m]; negative: it does not.
double way_out(const LightArea& opening, const Vec3& p, const Vec3& d);

/// Whether the ray from p along d (unit) passes it in either direction before it meets a surface at `distance`.
bool is_passed(const LightArea& opening, const Vec3& p, const Vec3& d, double distance);

inline constexpr std::uint32_t kNoOpening = 0xffffffff;

/// The first of `numbers`, in their order, that the ray passes before it meets a surface at `distance`, and that its
/// light therefore belongs to; kNoOpening: to none.
std::uint32_t first_way_out(std::span<const LightArea> openings, std::span<const std::uint32_t> numbers, const Vec3& p,
                            const Vec3& d, double distance);

/// Whether so many of some cosine-distributed rays escape that rays anywhere know the sky well enough, as they do out
/// of doors: openings are for where they seldom meet it.
bool sees_much_sky(std::span<const Hit> hits);

/// Upper bound of the form factor [1] from a surface element at p with normal n to the opening; 0 from outside of it.
double most_it_gives(const LightArea& opening, const Vec3& p, const Vec3& n);

/// Form factor [1] of the opening when nothing blocks it; 0 from outside of it.
double form_factor(const LightArea& opening, const Vec3& p, const Vec3& n);

/// An opening (or bright area) over a place.
struct AreaOver {
  double gives;  ///< form factor times brightness: what it gives where all of it is in view, about [W/(m2 sr)]
  std::uint32_t number;
};

/// Those over p that give most, in that order, up to `most`.
std::vector<AreaOver> areas_over(std::span<const LightArea> areas, const Vec3& p, const Vec3& n, std::size_t most);

/// What is worth being looked at.
struct AreasWanted {
  std::size_t most;      ///< so many at most
  double least_of_best;  ///< none that gives less than that share of the best [1]
};

/// Of those over p the ones in view that give most there, in the order of their numbers: many stand behind walls, and
/// nearer than what lights the room. Glass is air here.
///
/// from  point k of 16 (lifted) that look at them: of a patch, or p itself.
/// rays  how many were sent, added.
std::vector<std::uint32_t> areas_in_view(const RayScene& scene, std::span<const LightArea> areas, const Vec3& p,
                                         const Vec3& n, const std::function<Vec3(std::uint32_t)>& from,
                                         const AreasWanted& wanted, unsigned long long& rays);

/// Point of the opening, even over its area.
Vec3 point_of(const LightArea& opening, double u, double v);

/// Ray k of a sequence through points all over the opening, cosine-distributed around `side`, which is its normal or
/// the opposite.
Ray ray_through(const LightArea& opening, const Vec3& side, std::uint64_t key, std::uint32_t k, double lift);

/// Whether it is so narrow that rays meet it by chance only.
bool is_slit(const LightArea& opening);
std::vector<LightArea> slits_among(std::span<const LightArea> openings);

/// The gaps in the surfaces that have the sky on one side and a room on the other: windows, doors, rooflights, slits.
/// Slits also where surfaces are seen by them of which one side's are many times as bright.
///
/// A rim is an edge of a surface beyond which its plane goes on as air. Rims that close to a loop bound a hole; from
/// other rims the strip to what stands opposite in that plane is tried. Of these, those are kept that see the sky on
/// one side and not much of it on the other, and see what no larger one shows. Glass is air here.
///
/// patches  conforming; rays: of them. lights: local frame.
/// Threads: same result for any thread count. Cost: O(T log T) and 3 to 21 rays an edge of a surface, for the 20,000
/// longest; models of more than two million triangles are not searched.
std::vector<LightArea> find_openings(const PatchSet& patches, const RayScene& rays, const Lights& lights);

}  // namespace clerestory
