#include "solver/hierarchy/balance.h"

#include <cmath>
#include <cstdio>

#include "solver/hierarchy/gather_links.h"
#include "solver/model/assert.h"
#include "solver/model/units.h"
#include "solver/spaces/energy.h"

namespace clerestory {
namespace {

constexpr int kMostSweeps = 1'000;  // safety net; reaching it sets StopReason::iteration_limit

class System {
 public:
  System(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& E_direct,
         Field first_guess)
      : B(std::move(first_guess)), p_(patches), tree_(tree), transport_(transport), n_(patches.patch_count()) {
    source_ = FB = r_ = albedo_ = F_albedo_ = lost_ = Field(n_, p_.channels);
    for (std::size_t i = 0; i < n_; ++i) {
      source_.set(i, p_.M[i] + p_.scattered(E_direct, i));
      albedo_.set(i, p_.albedo(i));
      scale_ += p_.area[i] * (p_.M[i] + E_direct[i]);
    }
    if (B.size() != n_ || B.channels != p_.channels) B = source_;
    gather(albedo_, F_albedo_);
    ambient_loss_.resize(transport.spaces);
    for (std::size_t i = 0; i < n_; ++i) {
      lost_.set(i, albedo_[i] - p_.scattered(F_albedo_, i));
      ambient_loss_[transport.space[i]] += p_.area[i] * lost_[i];
    }
    update();
  }

  void sweep() {
    for (std::size_t k = 0; k < B.value.size(); ++k) B.value[k] += r_.value[k];
    update();
  }
  double residual() const {
    Spectrum left;
    for (std::size_t i = 0; i < n_; ++i)
      left += p_.area[i] * Spectrum(std::abs(r_[i][0]), std::abs(r_[i][1]), std::abs(r_[i][2]));
    double worst = 0;
    for (int c = 0; c < p_.channels; ++c)
      if (scale_[c] > 0) worst = std::max(worst, left[c] / scale_[c]);
    return worst;
  }

  Field B, FB;

 private:
  void gather(const Field& leaves, Field& E) {
    pull(tree_, leaves, nodes_);
    gather_and_push(transport_, tree_, nodes_, E);
  }
  void update() {
    gather(B, FB);
    std::vector<Spectrum> e(transport_.spaces);
    for (std::size_t i = 0; i < n_; ++i) {
      r_.set(i, source_[i] + p_.scattered(FB, i) - B[i]);
      e[transport_.space[i]] += p_.area[i] * r_[i];
    }
    for (std::size_t s = 0; s < e.size(); ++s)
      for (int c = 0; c < kMaxChannels; ++c) e[s][c] = ambient_loss_[s][c] > 0 ? e[s][c] / ambient_loss_[s][c] : 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const Spectrum e_i = e[transport_.space[i]];
      B.add(i, e_i * albedo_[i]);
      FB.add(i, e_i * F_albedo_[i]);
      r_.set(i, r_[i] - e_i * lost_[i]);
    }
  }

  const PatchSet& p_;
  const ElementTree& tree_;
  const Transport& transport_;
  std::size_t n_;
  Field source_, r_, nodes_;
  Field albedo_, F_albedo_, lost_;  ///< lost: albedo less what comes back of it
  Spectrum scale_;
  std::vector<Spectrum> ambient_loss_;  ///< by space: sum A lost [m2]
};

}  // namespace

Solution balance(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& E_direct,
                 Field B, double residual, const Monitor& monitor) {
  Solution s;
  System system(patches, tree, transport, E_direct, std::move(B));
  const auto log = [&] {
    char line[80];
    std::snprintf(line, sizeof line, "sweep %ld, residual %.2g", s.iterations, s.residual);
    s.log.push_back(line);
  };
  for (s.residual = system.residual(); s.residual > residual; s.residual = system.residual()) {
    if (s.iterations == kMostSweeps) s.stop = StopReason::iteration_limit;
    if (monitor.should_stop()) s.stop = why_stopped(monitor);
    if (s.stop != StopReason::converged) break;
    system.sweep();
    ++s.iterations;
  }
  log();
  CLERESTORY_ASSERT(all_finite(system.FB), ==, true);

  const std::size_t n = patches.patch_count();
  s.E = s.B = Field(n, patches.channels);
  for (std::size_t i = 0; i < n; ++i) s.E.set(i, E_direct[i] + system.FB[i]);
  for (std::size_t i = 0; i < n; ++i) {
    const Spectrum radiosity = patches.M[i] + patches.scattered(s.E, i);
    s.B.set(i, radiosity);
    const Losses on_its_way = losses(Spectrum(transport.arrives[i]), Spectrum(transport.escapes[i]));
    s.energy += where_light_ends(patches, i, s.E[i], radiosity, on_its_way);
  }
  return s;
}

}  // namespace clerestory
