#include "solver/hierarchy/sphere_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr int kZones = 6, kSectors = 12;  // about as wide as they are high, around the horizon
static_assert(kZones * kSectors == kSphereParts);

}  // namespace

std::uint16_t part_of_sphere(const Vec3& d) {
  const double turn = std::atan2(d.y, d.x) / (2 * std::numbers::pi) + 0.5;
  const int zone = std::clamp(static_cast<int>((d.z + 1) / 2 * kZones), 0, kZones - 1);
  const int sector = std::clamp(static_cast<int>(turn * kSectors), 0, kSectors - 1);
  return static_cast<std::uint16_t>(zone * kSectors + sector);
}

void PartShares::add(std::uint16_t part, double weight, std::span<const double> share) {
  for (std::size_t m = 0; m < share.size(); ++m) sum_[part][m] += weight * share[m];
  weight_[part] += weight;
}

void PartShares::write(std::uint16_t part, std::size_t members, std::vector<float>& out) const {
  const double weight = weight_[part];
  for (std::size_t m = 0; m < members; ++m) out.push_back(static_cast<float>(weight > 0 ? sum_[part][m] / weight : 1));
}

}  // namespace clerestory
