#pragma once
// The scene with its blinds in one state, ready to give a year of light at any point.

#include <memory>
#include <span>
#include <vector>

#include "pipeline/prepare.h"
#include "solver/annual/year_at_points.h"
#include "solver/methods/kept_transport.h"
#include "solver/model/scene.h"
#include "solver/run/solve.h"

namespace clerestory {

/// What all states have in common; all of it outlives them.
struct StateOptions {
  const SkyParts& fine;
  const SkyParts& coarse;
  const SunNodes& nodes;
  const YearLight& year;
  std::span<const DaylightHour> hours;
  double plan_reach;
  std::size_t sun_rays;
  const SolveOptions& solve;
  const AroundSolve& around;
};

class WindowState {
 public:
  /// scene  whose rays and lights, under the year's mean sky, the transport was found with; outlives this.
  WindowState(const Prepared& scene, KeptTransport kept, const StateOptions& how, const Monitor& monitor);
  /// The same for a scene that it owns, of which closed panes lack that share of their light.
  WindowState(std::unique_ptr<Prepared> scene, double share_taken, KeptTransport kept, const StateOptions& how,
              const Monitor& monitor);
  WindowState(const WindowState&) = delete;
  WindowState& operator=(const WindowState&) = delete;

  const YearLight& year() const { return scene_->year; }
  /// Share of the light of its closed panes that they lack; of those that lack least. 1 where none is closed.
  float share_taken() const { return share_taken_; }
  /// With the elements of the transport.
  const Problem& problem() const { return problem_; }

  /// Illuminance by the hour at points, see clerestory::year_at(). Thread safe.
  void year_at(std::span<const PlacesOfPoint> points, const GatherPattern& pattern, std::span<float> total,
               std::span<float> direct) const;
  /// Direct sun alone, wherever it may come from, in hours first, ..., first + count - 1: points x count by point,
  /// replaced [lx].
  void sun_at(std::span<const PlacesOfPoint> points, std::size_t first, std::size_t count,
              std::span<float> direct) const;

 private:
  std::unique_ptr<Prepared> own_;
  float share_taken_ = 1;
  PatchSet elements_;
  Problem problem_;
  Field B_;
  ReflectedDaylight reflected_;
  std::unique_ptr<Illumination> light_;
  std::unique_ptr<YearScene> scene_;
};

/// Groups of panes with blinds, by the order in which the scene's materials name them.
///
/// throws  InputError when there are more than blinds can be operated in.
std::vector<std::string> blind_groups(const std::vector<Material>& materials);

/// For each group of blinds a state in which it alone is closed, in that order.
///
/// open  the scene with all of them open.
void add_closed_states(const Scene& scene, const PreparedToSolve& open, const StateOptions& how, const Monitor& monitor,
                       std::vector<std::unique_ptr<WindowState>>& states);

}  // namespace clerestory
