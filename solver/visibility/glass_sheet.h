#pragma once
// How much light a sheet of glass passes and reflects, by the angle at which it comes.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "solver/model/channels.h"

namespace clerestory {

inline constexpr double kGlassIndex = 1.52;  ///< refractive index of common window glass

/// What a clear sheet of n = 1.52 passes at normal incidence, (1 - R) / (1 + R) with R = ((n - 1) / (n + 1))^2: 0.9183.
inline constexpr double kClearGlass = 2 * kGlassIndex / (kGlassIndex * kGlassIndex + 1);

/// A thin sheet: refractive index, and the share of the light that one crossing at normal incidence leaves over.
struct GlassSheet {
  double index = kGlassIndex;
  double internal = 1;  ///< [1]
};

/// The sheet that passes `transmittance` in 0..1 at normal incidence. Up to kClearGlass its index is 1.52 and it
/// absorbs the rest; above that it absorbs nothing and its index is what reflects no more than is left, as a coating
/// would; 1 is a hole.
GlassSheet fit_glass_sheet(double transmittance);

/// What becomes of light [1]; the rest is absorbed.
struct SheetShares {
  double transmittance = 0, reflectance = 0;
};

/// Of unpolarised light that comes at cosine cos_theta to the normal, in 0..1, from either side:
///   T = mean over both polarisations of (1 - R)^2 a / (1 - R^2 a^2),  a = internal^(1 / cos_inside),
///   and reflected the mean of R + R a T of either polarisation,
/// R by Fresnel, all reflections between the two faces summed without interference.
SheetShares sheet_shares(const GlassSheet& sheet, double cos_theta);

/// The same from a table over the cosine, by channel; within 1e-4, at grazing angles 1e-3 of what is reflected.
class GlassTable {
 public:
  struct Shares {
    Spectrum transmittance, reflectance;
  };

  /// transmittance  at normal incidence.
  explicit GlassTable(const Spectrum& transmittance);
  Spectrum transmittance(double cos_theta) const {
    const Place at = place(cos_theta);
    return value_[at.i].transmittance * (1 - at.t) + value_[at.i + 1].transmittance * at.t;
  }
  Spectrum reflectance(double cos_theta) const {
    const Place at = place(cos_theta);
    return value_[at.i].reflectance * (1 - at.t) + value_[at.i + 1].reflectance * at.t;
  }

 private:
  static constexpr std::size_t kSteps = 1024;
  struct Place {
    std::size_t i;
    double t;
  };
  static Place place(double cos_theta) {
    const double steps = std::abs(cos_theta) * kSteps;
    const std::size_t i = std::min(static_cast<std::size_t>(steps), kSteps - 1);
    return {i, std::min(steps - static_cast<double>(i), 1.0)};
  }
  std::vector<Shares> value_;
};

}  // namespace clerestory
