#pragma once
// The paths that references are made of: from points, or from both ends.

#include <optional>

#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
#include "solver/paths/bidirectional.h"

namespace clerestory {

/// Rays of a path beyond which all find all light of so bright a room, and a few tell as much as many.
inline constexpr double kLongPath = 200;

/// Whichever knows the points better for its rays, as pilots at some of them tell, which are used for nothing else:
/// paths from both ends where those from points have four times their variance for the same rays, or miss much of their
/// light. Where paths are so long that all find all light, they are from points. Narrow gloss that lamps or the sun
/// shine on is for paths from points alone, which look for images in it.
class ReferencePaths {
 public:
  /// light  outlives this.
  ReferencePaths(const Illumination& light, std::size_t points, const PointOf& point_of, std::uint64_t key,
                 const Monitor& monitor);

  const PathEstimator& estimator() const { return estimator_; }
  bool are_from_both_ends() const { return from_both_ends_; }

 private:
  std::optional<Bidirectional> both_;
  bool from_both_ends_ = false;
  PathEstimator estimator_;
};

}  // namespace clerestory
