#pragma once
// What a method returns: radiosity and irradiance of every patch, the energy balance, and how it got there.

#include <string>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/monitor.h"
#include "solver/model/slit_light.h"

namespace clerestory {

/// Flux [W], luminous mean over the channels.
struct EnergyBalance {
  double emitted = 0;   ///< by surfaces and luminaires; from sky and sun, what arrives on surfaces first
  double absorbed = 0;  ///< by surfaces and glass
  double escaped = 0;   ///< left the scene
  /// (emitted - absorbed - escaped) / emitted [1], never corrected away.
  double imbalance() const { return emitted > 0 ? (emitted - absorbed - escaped) / emitted : 0; }

  EnergyBalance& operator+=(const EnergyBalance& b) {
    emitted += b.emitted, absorbed += b.absorbed, escaped += b.escaped;
    return *this;
  }
};

enum class StopReason { converged, time_limit, interrupted, iteration_limit };

/// Of work that stopped because the monitor said so.
inline StopReason why_stopped(const Monitor& monitor) {
  return monitor.is_interrupted() ? StopReason::interrupted : StopReason::time_limit;
}

struct Solution {
  std::string method;
  Field E;          ///< N, mean irradiance of each patch, ambient included [W/m2]
  Field B;          ///< N, radiosity M + rho E [W/m2]
  Field std_error;  ///< N, standard error of E; empty unless the method is a random estimate of known error
  EnergyBalance energy;
  StopReason stop = StopReason::converged;
  long iterations = 0;  ///< shots, sweeps or paths, as the method counts
  double residual = 0;  ///< unshot or changed flux / emitted flux [1]
  unsigned long long rays = 0;
  std::size_t clusters = 0, links = 0;  ///< of the hierarchy, where there is one
  double flux_per_ray = 0;              ///< carried by a ray of a shot; sets the noise of shooting [W]
  std::vector<std::string> log;         ///< a line a round, for --verbose
  SlitLight slit_light;                 ///< where the method needed to know it
  std::string stopped_at;  ///< of a run that was stopped: which of its rounds the result is, in the log's words
};

}  // namespace clerestory
