#pragma once
// The sky in parts, each taken for even: daylight coefficients know light by them.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "solver/model/sky_shape.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Counts that SkyParts knows.
inline constexpr std::array<std::size_t, 3> kSkyPartCounts{145, 577, 2305};

/// Reinhart's subdivision of Tregenza's 145 parts: rows of equal height from the horizon up, each of Tregenza's seven
/// rows parted m times either way, and a cap around the zenith of half a row's height: 144 m^2 + 1 parts. What is below
/// the horizon, the virtual ground, is one part more, the last.
/// Source: Tregenza, "Subdivision of the sky hemisphere for luminance measurements", 1987; Bourgeois, Reinhart & Ward,
/// "Standard daylight coefficient model for dynamic daylighting simulations", 2008.
class SkyParts {
 public:
  /// count  one of kSkyPartCounts.
  explicit SkyParts(std::size_t count);

  /// Of the sky, without the ground.
  std::size_t count() const { return row_begin_.back(); }
  std::size_t ground() const { return count(); }
  /// That the unit direction d lies in; z is up.
  std::size_t part_of(const Vec3& d) const;
  /// Unit direction to a part's middle.
  Vec3 middle(std::size_t part) const;
  /// A part's integral of cos(zenith angle) over its solid angle [sr]. They sum to pi.
  double on_horizontal(std::size_t part) const { return on_horizontal_[part]; }
  /// What a plane of unit normal n sees of each part and of the ground where nothing hides them: the integral of
  /// max(0, n . d), by quadrature [sr]. Of the ground what is left of pi. count() + 1 values.
  std::vector<float> on_plane(const Vec3& n) const;

  /// Mean radiance of each part relative to the zenith factor of the shape, weighted by cos(zenith angle); then scaled
  /// so that a horizontal plane has exactly `horizontal`, in the unit of that over sr.
  ///
  /// sun       unit, that the shape is bright around.
  /// radiance  count() values, replaced.
  void look_at(const SkyShape& shape, const Vec3& sun, double horizontal, std::span<float> radiance) const;

 private:
  std::size_t first_sample(std::size_t part) const { return part * samples_a_part(); }
  std::size_t samples_a_part() const { return side_ * side_; }

  std::size_t side_;                    ///< samples of a part, either way
  double row_height_;                   ///< [rad]
  std::vector<std::size_t> row_begin_;  ///< parts; the last row is the cap
  std::vector<double> on_horizontal_;   ///< by part [sr]
  std::vector<Vec3> sample_;            ///< directions of equal share of their part's on_horizontal
};

}  // namespace clerestory
