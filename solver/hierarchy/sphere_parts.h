#pragma once
// How light from each part of the sphere is shared out among the members of a cluster.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "solver/hierarchy/receivers.h"
#include "solver/model/vec.h"

namespace clerestory {

/// Rows of a cluster. A part is 0.17 sr wide, which blurs what a member gets by its orientation by some percent.
inline constexpr std::size_t kSphereParts = 72;

/// Parts of the sphere that a cluster tells apart: zones of equal height in equal sectors, 0 .. kSphereParts - 1.
std::uint16_t part_of_sphere(const Vec3& d);

/// Of all light from one part, the share of each member against an even share by area: the mean over its rays, by their
/// weight.
class PartShares {
 public:
  void clear() { sum_ = {}, weight_ = {}; }
  /// A ray of this weight from `part`; share by member, see ReceiverArea::find_shares().
  void add(std::uint16_t part, double weight, std::span<const double> share);
  /// Appends one share a member.
  void write(std::uint16_t part, std::size_t members, std::vector<float>& out) const;

 private:
  std::array<std::array<double, kMostMembers>, kSphereParts> sum_{};
  std::array<double, kSphereParts> weight_{};
};

}  // namespace clerestory
