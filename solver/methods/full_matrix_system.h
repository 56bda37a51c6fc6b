#pragma once
// B = M + rho (E_direct + F B) on the full matrix: what the classic gathering methods share.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/methods/form_factor_matrix.h"
#include "solver/model/monitor.h"
#include "solver/model/patch_set.h"
#include "solver/model/solution.h"
#include "solver/spaces/energy.h"

namespace clerestory {

inline constexpr long kMostSweeps = 1'000;  ///< safety net; reaching it sets StopReason::iteration_limit

struct GatherOptions {
  /// Stop when sum A |M + rho E - B| of every channel is below this share of the flux sum A (M + rho E_direct) [1], >
  /// 0.
  double residual = 1e-7;
};

/// Radiosities under way, channel by channel, with the residual r = M + rho (E_direct + F B) - B.
///
/// Plain sweeps wear down slowly what a closed room keeps: light spread evenly decays by its reflectance only, 1e5
/// sweeps at 0.9999. So each sweep is followed by a coarse correction with one unknown per channel and space (patches
/// that see each other, directly or over others): an ambient irradiance e, B += e rho, such that the area-weighted
/// residual of the space vanishes,
///   e = sum A r / sum A rho (1 - F rho).
/// For diffusers, whose B has the part tau E of their other side, rho + tau takes the place of rho.
/// That is a Galerkin two-level method with the shape rho and the test function A, exact for a closed room of one
/// reflectance; what it leaves decays by 1e-7 within 10 to 60 sweeps, at 0.9999 as at 0.9.
class FullMatrixSystem {
 public:
  FullMatrixSystem(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct);

  std::size_t size() const { return n_; }
  int channels() const { return channels_; }

  /// sum_j F_ij x_j over j in [begin, end), closed rows made exact.
  double gather(std::size_t i, std::span<const double> x, std::size_t begin, std::size_t end) const;
  /// y_i = sum_j F_ij x_j for all i, in parallel.
  void gather_all(std::span<const double> x, std::span<double> y) const;
  /// What diffuser i passes of the light E that arrives behind it; 0 for other patches.
  double passed(std::size_t k, std::size_t i, std::span<const double> E) const {
    double sum = 0;
    for (const PatchSet::Behind& other : patches_.patches_behind(i)) sum += other.share * E[other.patch];
    return tau.empty() ? 0 : tau[k][i] * sum;
  }
  /// The same when x leaves the patches.
  double passed_of(std::size_t k, std::size_t i, std::span<const double> x) const {
    double sum = 0;
    for (const PatchSet::Behind& other : patches_.patches_behind(i)) sum += other.share * gather(other.patch, x, 0, n_);
    return tau.empty() ? 0 : tau[k][i] * sum;
  }

  /// FB from B, all channels, and the residual from both.
  void update_irradiance();
  void update_residual();
  void correct_ambient();
  /// Largest of the channels' sum A |r| / sum A (M + rho E_direct).
  double relative_residual() const;

  /// Runs sweep() + correct_ambient() until the residual is small; sweep() must leave B, FB and r up to date.
  /// Of a matrix that was stopped half-way, the energy balance counts as escaped what filled rows lose only; what the
  /// others could not place yet is its imbalance.
  template <class Sweep>
  Solution iterate(std::string method, const GatherOptions& options, const Monitor& monitor, Sweep sweep);

  // One array of n values per channel.
  std::vector<std::vector<double>> B, FB, residual;
  std::vector<std::vector<double>> source;    ///< M + rho E_direct, and what diffusers pass of it
  std::vector<std::vector<double>> rho, tau;  ///< tau empty without diffusers
  std::vector<double> area;

 private:
  Losses losses_of(std::size_t i) const;
  Solution finish(std::string method) const;

  const PatchSet& patches_;
  const FormFactorMatrix& F_;
  const Field& E_direct_;
  std::size_t n_;
  int channels_;
  std::vector<std::uint32_t> space_;  ///< of patch i
  std::size_t spaces_ = 0;
  // Per channel. Albedo: rho + tau. Lost: albedo less what comes back of it.
  std::vector<std::vector<double>> albedo_, F_albedo_, lost_;
  std::vector<std::vector<double>> ambient_loss_;  ///< per channel and space: sum A lost [m2]
};

/// "METHOD: sweep 3, residual 1.2e-05"
std::string sweep_line(const std::string& method, long sweep, double residual);

template <class Sweep>
Solution FullMatrixSystem::iterate(std::string method, const GatherOptions& options, const Monitor& monitor,
                                   Sweep sweep) {
  std::vector<std::string> log = F_.log();
  StopReason stop = StopReason::iteration_limit;
  long sweeps = 0;
  correct_ambient();
  while (true) {
    const double left = relative_residual();
    log.push_back(sweep_line(method, sweeps, left));
    // Of a matrix that was stopped half-way, a small residual says nothing.
    if (left <= options.residual && F_.complete) {
      stop = StopReason::converged;
      break;
    }
    if (!F_.complete || monitor.should_stop()) {
      stop = why_stopped(monitor);
      break;
    }
    if (sweeps >= kMostSweeps) break;
    // Digits gained of those wanted.
    const double wanted = std::log(options.residual), gained = std::log(std::min(1.0, left));
    monitor.report(method, wanted < 0 ? std::min(1.0, gained / wanted) : 0);
    sweep();
    correct_ambient();
    ++sweeps;
  }
  Solution solution = finish(std::move(method));
  solution.stop = stop;
  solution.iterations = sweeps;
  solution.residual = relative_residual();
  solution.log = std::move(log);
  return solution;
}

}  // namespace clerestory
