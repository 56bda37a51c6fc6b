#include "solver/gather_pattern.h"

#include <algorithm>
#include <bit>

#include "solver/model/random_stream.h"
#include "solver/sampling.h"

namespace clerestory {
namespace {

constexpr int kMostHalvings = 4;  ///< a stratum of interest gets up to 16 times the least

std::array<float, 3> local_direction(double u, double v) {
  const double r = std::sqrt(u), phi = 2 * std::numbers::pi * v;
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
          static_cast<float>(std::sqrt(std::max(0.0, 1 - u)))};
}

}  // namespace

GatherPattern::GatherPattern(const GatherQuality& quality, std::uint64_t seed)
    : quality_(quality), sun_key_(stream_key(seed, 4)) {
  const auto count = static_cast<std::uint32_t>(strata());
  least_ = std::bit_width(static_cast<unsigned>(std::max(1, quality.rays / strata()))) - 1;
  deepest_ = quality.most_rays > quality.rays ? least_ + kMostHalvings : least_;
  const std::uint64_t key = stream_key(seed, 1), pilot_key = stream_key(seed, 2), lamp_key = stream_key(seed, 3);
  const auto stratum_at = [&](double u, double v) {
    return static_cast<std::size_t>(stratum(static_cast<int>(u * quality_.grid), static_cast<int>(v * quality_.grid)));
  };
  // Every run of grid x grid points of the sequence has one in each stratum.
  fresh_.resize(std::size_t{count} << deepest_);
  for (std::uint32_t k = 0; k < fresh_.size(); ++k) {
    const auto u = sobol4(k, key);
    fresh_[(stratum_at(u[0], u[1]) << deepest_) + k / count] = local_direction(u[0], u[1]);
  }
  pilot_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto u = sobol4(k, pilot_key);
    pilot_[stratum_at(u[0], u[1])] = local_direction(u[0], u[1]);
  }
  for (int k = 0; k < quality.lamp_rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), lamp_key);
    lamp_choices_.push_back({u[0], u[1], u[2]});
  }
}

int GatherPattern::stratum_of(const Frame& frame, const Vec3& direction) const {
  const auto uv = square_of_direction(frame, direction);
  return stratum(static_cast<int>(uv[0] * quality_.grid), static_cast<int>(uv[1] * quality_.grid));
}

}  // namespace clerestory
