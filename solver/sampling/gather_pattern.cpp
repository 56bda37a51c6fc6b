#include "solver/sampling/gather_pattern.h"

#include <algorithm>
#include <bit>

#include "solver/model/assert.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr int kMostHalvings = 4;  ///< a stratum of interest gets up to 16 times the least

std::array<float, 3> local_direction(double u, double v) {
  const double r = std::sqrt(u), phi = 2 * std::numbers::pi * v;
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
          static_cast<float>(std::sqrt(std::max(0.0, 1 - u)))};
}

}  // namespace

int RayBudget::least() const { return std::bit_width(static_cast<unsigned>(std::max(1, rays / strata()))) - 1; }
int RayBudget::deepest() const { return most_rays > rays ? least() + kMostHalvings : least(); }

Strata::Strata(const RayBudget& budget, std::uint64_t key, std::uint64_t pilot_key)
    : budget_(budget), deepest_(budget.deepest()) {
  CLERESTORY_ASSERT(budget.grid % 8, ==, 0);
  CLERESTORY_ASSERT(budget.rays, >=, budget.strata());
  const auto count = static_cast<std::uint32_t>(budget.strata());
  const auto stratum_at = [&](const auto& u) { return static_cast<std::size_t>(budget_.stratum_of(u[0], u[1])); };
  // Every run of grid x grid points of the sequence has one in each stratum.
  fresh_.resize(std::size_t{count} << deepest_);
  for (std::uint32_t k = 0; k < fresh_.size(); ++k) {
    const auto u = sobol4(k, key);
    fresh_[(stratum_at(u) << deepest_) + k / count] = local_direction(u[0], u[1]);
  }
  pilot_.resize(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const auto u = sobol4(k, pilot_key);
    pilot_[stratum_at(u)] = local_direction(u[0], u[1]);
  }
}

GatherPattern::GatherPattern(const GatherQuality& quality, std::uint64_t seed)
    : quality_(quality),
      bundle_(quality.bundle, stream_key(seed, kGatherBundle), stream_key(seed, kGatherPilots)),
      area_cells_(quality.area.last, stream_key(seed, kGatherAreas)),
      sun_key_(stream_key(seed, kGatherSunPoints)) {
  const std::uint64_t bright_key = stream_key(seed, kGatherBrightChoices);
  for (int k = 0; k < quality.bright_rays; ++k) {
    const auto u = sobol4(static_cast<std::uint32_t>(k), bright_key);
    bright_choices_.push_back({u[0], u[1], u[2]});
  }
  for (std::uint32_t k = 0; k < kBrightPilots; ++k) {
    const auto u = sobol4(k, stream_key(seed, kGatherBrightPilots));
    bright_pilots_.push_back({u[0], u[1], u[2]});
  }
}

int GatherPattern::stratum_of(const Frame& frame, const Vec3& direction) const {
  const auto uv = square_of_direction(frame, direction);
  return quality_.bundle.stratum_of(uv[0], uv[1]);
}

}  // namespace clerestory
