#pragma once
// Daylight coefficients of a point: how much of each part of the sky, and of the sun at each node, arrives there.

#include <cstddef>
#include <span>
#include <vector>

#include "solver/annual/reflected_daylight.h"
#include "solver/annual/sky_parts.h"
#include "solver/illumination/light_rows.h"

namespace clerestory {

/// Luminous mean, of white light.
struct PointCoefficients {
  std::vector<float> straight;   ///< of the fine parts of the sky and the ground: E = sum of it times radiance [sr]
  std::vector<float> reflected;  ///< by lane of ReflectedDaylight
};

/// Memory that points need in turn: what a row has of each element.
class RowSums {
 public:
  explicit RowSums(std::size_t elements) : weight_(elements) {}
  void add(std::uint32_t element, const RowEntry& e);
  /// visit(element, weight of each channel) for those that were added to, in the order in which they first were; then
  /// forgets them.
  template <class Visit>
  void take(const Visit& visit) {
    for (const std::uint32_t e : touched_) {
      visit(e, weight_[e]);
      weight_[e] = {};
    }
    touched_.clear();
  }

 private:
  std::vector<std::array<float, kMaxChannels>> weight_;
  std::vector<std::uint32_t> touched_;
};

/// Adds a row of gather_point() under any sky, `share` times.
///
/// n  unit normal there. Where the row says that nothing hides the sky or the ground, what it sees of their parts is
///    exact.
void add_row(const LightRow& row, const Vec3& n, const SkyParts& fine, const ReflectedDaylight& reflected, double share,
             RowSums& sums, PointCoefficients& out);

}  // namespace clerestory
