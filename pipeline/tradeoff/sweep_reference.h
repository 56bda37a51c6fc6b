#pragma once
// What all rows of a sweep are judged by: unbiased paths at the same points of the surfaces, sharper with every round,
// and gathers where these are not enough.

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/observer.h"
#include "pipeline/prepare.h"
#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
#include "solver/model/scene.h"
#include "solver/model/vec.h"

namespace clerestory {

struct ReferencePoint {
  Vec3 p;  ///< on the surface, scene's frame [m]
  Vec3 n;  ///< unit normal of the side that is looked at
  std::uint32_t room;
  double weight;                          ///< the area it stands for, in proportion
  double E = 0, std_error = 0;            ///< illuminance by paths [lx]
  double gather = -1, other_gather = -1;  ///< the same by two gathers; negative: there are none [lx]
};

struct ReferenceRoom {
  std::string name;
  double area = 0;        ///< [m2]
  bool is_large = false;  ///< a hundredth of all area at least: its error counts by itself
};

/// Illuminance at points that are spread over the rooms as those of the measured error are, on the surfaces as they
/// were read: nothing is simplified, and no result that is judged has a part in it.
class SweepReference {
 public:
  struct OutOfTime {};

  /// scene    outlives it.
  /// throws   InputError as solve_scene(); OutOfTime when it is not ready at `end`.
  SweepReference(const Scene& scene, std::uint64_t seed, Observer& observer,
                 std::chrono::steady_clock::time_point end = std::chrono::steady_clock::time_point::max());
  SweepReference(const SweepReference&) = delete;
  SweepReference& operator=(const SweepReference&) = delete;

  /// Traces so many paths more from each point. Stopped by the monitor it adds nothing, and returns false.
  bool add_paths(int paths, const Monitor& monitor);

  /// For rooms where paths are too noisy: solves its own mesh at that accuracy, and gathers twice from each point.
  /// Paths then judge the gathers, as in the measured error. Stopped by the monitor it adds nothing, and returns false.
  /// Once only.
  bool add_gathers(Accuracy accuracy, const Monitor& monitor);

  const std::vector<ReferencePoint>& points() const { return points_; }
  const std::vector<ReferenceRoom>& rooms() const { return rooms_; }
  long long paths() const { return paths_; }  ///< from each point so far
  bool has_gathers() const { return points_[0].gather >= 0; }
  /// Root mean square of the points' standard errors in a room, relative to its mean [1]; infinite where nothing was
  /// found. With gathers: of these, and of the mean of all paths in the room.
  double std_error_of(std::uint32_t room) const;
  /// Whether it can judge a room at all: where its error is half of the mean, most of the light is not found.
  bool tells(std::uint32_t room) const { return std_error_of(room) <= 0.5; }
  /// How far a surface of the reference may be off the one that was read [m].
  double tolerance() const { return tolerance_; }
  double diagonal() const { return diagonal_; }  ///< of the model [m]

 private:
  ReceivingPoint place(std::size_t i) const;
  std::uint64_t seed_, rounds_ = 0;
  PreparedToSolve prepared_;
  std::vector<ReferencePoint> points_;
  std::vector<ReferenceRoom> rooms_;
  Field caustics_;  ///< at the points, of particles of its own [W/m2]
  long long paths_ = 0;
  double tolerance_ = 0, diagonal_ = 0;
};

}  // namespace clerestory
