#pragma once
// Who watches a run.

#include <string>
#include <string_view>

namespace clerestory {

/// Told how far a run is and what it found, asked whether it should go on. Derive from it what is of interest.
class Observer {
 public:
  virtual ~Observer() = default;

  /// A stage of the work, and the share of it that is done [0, 1].
  virtual void progress(std::string_view /*stage*/, double /*done*/) {}
  /// A step of the work is done, and what comes next.
  virtual void step(const std::string& /*line*/) {}
  /// What the run does, for those who want to know more.
  virtual void note(const std::string& /*line*/) {}
  /// Something that a user should look at: light, energy or error that cannot be trusted, input that was assumed.
  virtual void warn(const std::string& /*line*/) {}
  /// From now on, a run that is ended early returns something.
  virtual void has_result() {}
  /// True ends the run early: what is solved so far is returned, marked so. Asked from any thread.
  virtual bool should_stop() const { return false; }
};

}  // namespace clerestory
