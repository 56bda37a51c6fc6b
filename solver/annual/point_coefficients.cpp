#include "solver/annual/point_coefficients.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/model/units.h"
#include "solver/sampling/packed_direction.h"

namespace clerestory {
namespace {

/// What a luminous mean has of channel c.
double luminous_weight(int c, int channels) { return channels == 1 ? 1 : kLuminousWeights[c]; }

double luminous(const RowEntry& e, int channels) {
  double sum = 0;
  for (int c = 0; c < channels; ++c)
    sum += luminous_weight(c, channels) * double{e.weight[static_cast<std::size_t>(c)]};
  return sum;
}

}  // namespace

void RowSums::add(std::uint32_t element, const RowEntry& e) {
  auto& sum = weight_[element];
  if (sum[0] == 0 && sum[1] == 0 && sum[2] == 0) touched_.push_back(element);
  for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += e.weight[c];
}

void add_row(const LightRow& row, const Vec3& n, const SkyParts& fine, const ReflectedDaylight& reflected, double share,
             RowSums& sums, PointCoefficients& out) {
  constexpr double kWhole = 1e-4;  // of pi, that rounding leaves of a hemisphere in which nothing is in the way
  const int channels = reflected.channels;
  double open = 0;
  bool meets_patches = false;
  for (const RowEntry& e : row) {
    if (e.is_of_sky())
      open += luminous(e, channels);
    else if (!e.is_of_light())
      sums.add(e.number(), e), meets_patches = true;
  }
  if (!meets_patches && std::abs(open - std::numbers::pi) < kWhole * std::numbers::pi) {
    const std::vector<float> seen = fine.on_plane(n);
    for (std::size_t k = 0; k < seen.size(); ++k) out.straight[k] += static_cast<float>(share) * seen[k];
    return;
  }
  for (const RowEntry& e : row)
    if (e.is_of_sky())
      out.straight[fine.part_of(unpack_direction(e.number()))] += static_cast<float>(share * luminous(e, channels));
  float* const lanes = out.reflected.data();
  sums.take([&](std::uint32_t element, const auto& weight) {
    for (int c = 0; c < channels; ++c) {
      const auto w =
          static_cast<float>(share * luminous_weight(c, channels) * double{weight[static_cast<std::size_t>(c)]});
      const float* const B = reflected.of(element, c).data();
      for (std::size_t l = 0; l < reflected.lanes; ++l) lanes[l] += w * B[l];
    }
  });
}

}  // namespace clerestory
