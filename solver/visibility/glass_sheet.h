#pragma once
// How much light passes a sheet of glass, by the angle at which it comes.

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

/// Share [1] of unpolarised light that passes at cosine cos_theta to the normal, in 0..1:
///   T = mean over both polarisations of (1 - R)^2 a / (1 - R^2 a^2),  a = internal^(1 / cos_inside),
/// R by Fresnel, all reflections between the two faces summed without interference.
double sheet_transmittance(const GlassSheet& sheet, double cos_theta);

/// The same from a table over the cosine, by channel; within 1e-4.
class GlassTable {
 public:
  /// transmittance  at normal incidence.
  explicit GlassTable(const Spectrum& transmittance);
  Spectrum at(double cos_theta) const {
    const double place = std::abs(cos_theta) * kSteps;
    const auto i = static_cast<std::size_t>(place);
    if (i >= kSteps) return value_[kSteps];
    const double t = place - static_cast<double>(i);
    return value_[i] * (1 - t) + value_[i + 1] * t;
  }

 private:
  static constexpr std::size_t kSteps = 1024;
  std::vector<Spectrum> value_;
};

}  // namespace clerestory
