#include "solver/visibility/glass_sheet.h"

#include <algorithm>
#include <array>

namespace clerestory {
namespace {

/// Two faces of reflectance R with absorption between them, all reflections summed.
SheetShares slab(double R, double internal) {
  if (!(R < 1)) return {0, 1};
  const double goes_round = R * internal;
  const double passes = (1 - R) * (1 - R) * internal / (1 - goes_round * goes_round);
  return {passes, R + goes_round * passes};
}

}  // namespace

GlassSheet fit_glass_sheet(double transmittance) {
  const double T = transmittance;
  if (T > kClearGlass) {
    const double root = std::sqrt((1 - T) / (1 + T));  // of R: T = (1 - R) / (1 + R)
    return {(1 + root) / (1 - root), 1};
  }
  const double root = (kGlassIndex - 1) / (kGlassIndex + 1), R = root * root;
  // T R^2 a^2 + (1 - R)^2 a - T = 0 for a, the root that stays exact where T or R is small.
  const double b = (1 - R) * (1 - R);
  return {kGlassIndex, 2 * T / (b + std::sqrt(b * b + 4 * T * T * R * R))};
}

SheetShares sheet_shares(const GlassSheet& sheet, double cos_theta) {
  const double n = sheet.index, sin2 = 1 - cos_theta * cos_theta;
  const double cos_inside = std::sqrt(std::max(0.0, 1 - sin2 / (n * n)));
  const double along = n * cos_theta + cos_inside, across = cos_theta + n * cos_inside;
  if (!(along > 0)) return n > 1 ? SheetShares{0, 1} : SheetShares{1, 0};  // a hole at grazing incidence
  const double r_parallel = (n * cos_theta - cos_inside) / along, r_across = (cos_theta - n * cos_inside) / across;
  const double internal = cos_inside > 0 ? std::pow(sheet.internal, 1 / cos_inside) : 1;
  const SheetShares parallel = slab(r_parallel * r_parallel, internal), other = slab(r_across * r_across, internal);
  return {(parallel.transmittance + other.transmittance) / 2, (parallel.reflectance + other.reflectance) / 2};
}

GlassTable::GlassTable(const Spectrum& transmittance) : value_(kSteps + 1) {
  std::array<GlassSheet, kMaxChannels> sheet;
  for (int c = 0; c < kMaxChannels; ++c) sheet[static_cast<std::size_t>(c)] = fit_glass_sheet(transmittance[c]);
  for (std::size_t i = 0; i < value_.size(); ++i)
    for (int c = 0; c < kMaxChannels; ++c) {
      const SheetShares shares = sheet_shares(sheet[static_cast<std::size_t>(c)], static_cast<double>(i) / kSteps);
      value_[i].transmittance[c] = shares.transmittance;
      value_[i].reflectance[c] = shares.reflectance;
    }
}

}  // namespace clerestory
