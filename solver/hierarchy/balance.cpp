#include "solver/hierarchy/balance.h"

#include <cmath>

#include "solver/hierarchy/gather_links.h"
#include "solver/model/assert.h"
#include "solver/model/units.h"
#include "solver/spaces/energy.h"

namespace clerestory {
namespace {

constexpr int kMostSweeps = 1'000;  // safety net; reaching it sets StopReason::iteration_limit

class System {
 public:
  System(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& M,
         const Field& E_direct, Field first_guess)
      : B(std::move(first_guess)),
        p_(patches),
        tree_(tree),
        transport_(transport),
        n_(patches.patch_count()),
        channels_(static_cast<std::size_t>(patches.channels)),
        lanes_(static_cast<std::size_t>(E_direct.channels)) {
    source_ = FB = r_ = Field(n_, E_direct.channels);
    albedo_ = F_albedo_ = lost_ = Field(n_, p_.channels);
    scale_.resize(lanes_);
    for (std::size_t i = 0; i < n_; ++i) {
      albedo_.set(i, p_.albedo(i));
      for_lanes(i, [&](std::size_t l, std::size_t k, std::size_t c) {
        source_.value[k] = M.value[k] + scattered(E_direct, i, l, c);
        scale_[l] += p_.area[i] * (M.value[k] + E_direct.value[k]);
      });
    }
    if (B.size() != n_ || B.channels != E_direct.channels) B = source_;
    gather(albedo_, F_albedo_);
    ambient_loss_.resize(transport.spaces * channels_);
    for (std::size_t i = 0; i < n_; ++i) {
      lost_.set(i, albedo_[i] - p_.scattered(F_albedo_, i));
      for (std::size_t c = 0; c < channels_; ++c)
        ambient_loss_[transport.space[i] * channels_ + c] += p_.area[i] * lost_.value[i * channels_ + c];
    }
    update();
  }

  /// Calls visit(lane, its place in fields of lanes, the place of its channel in fields of channels) at leaf i.
  template <class Visit>
  void for_lanes(std::size_t i, const Visit& visit) const {
    for (std::size_t l = 0; l < lanes_; l += channels_)
      for (std::size_t c = 0; c < channels_; ++c) visit(l + c, i * lanes_ + l + c, i * channels_ + c);
  }
  /// PatchSet::scattered() of one lane; c: the place of its channel.
  double scattered(const Field& E, std::size_t i, std::size_t lane, std::size_t c) const {
    double out = p_.rho.value[c] * E.value[i * lanes_ + lane];
    for (const PatchSet::Behind& other : p_.patches_behind(i))
      out += p_.tau.value[c] * E.value[other.patch * lanes_ + lane] * other.share;
    return out;
  }

  void sweep() {
    for (std::size_t k = 0; k < B.value.size(); ++k) B.value[k] += r_.value[k];
    update();
  }
  double residual() const {
    std::vector<double> left(lanes_);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t l = 0; l < lanes_; ++l) left[l] += p_.area[i] * std::abs(r_.value[i * lanes_ + l]);
    double worst = 0;
    for (std::size_t l = 0; l < lanes_; ++l)
      if (scale_[l] > 0) worst = std::max(worst, left[l] / scale_[l]);
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
    std::vector<double> e(transport_.spaces * lanes_);
    for (std::size_t i = 0; i < n_; ++i) {
      double* e_i = e.data() + transport_.space[i] * lanes_;
      for_lanes(i, [&](std::size_t l, std::size_t k, std::size_t c) {
        r_.value[k] = source_.value[k] + scattered(FB, i, l, c) - B.value[k];
        e_i[l] += p_.area[i] * r_.value[k];
      });
    }
    for (std::size_t k = 0; k < e.size(); ++k) {
      const double loss = ambient_loss_[k / lanes_ * channels_ + k % lanes_ % channels_];
      e[k] = loss > 0 ? e[k] / loss : 0;
    }
    for (std::size_t i = 0; i < n_; ++i) {
      const double* e_i = e.data() + transport_.space[i] * lanes_;
      for_lanes(i, [&](std::size_t l, std::size_t k, std::size_t c) {
        B.value[k] += e_i[l] * albedo_.value[c];
        FB.value[k] += e_i[l] * F_albedo_.value[c];
        r_.value[k] -= e_i[l] * lost_.value[c];
      });
    }
  }

  const PatchSet& p_;
  const ElementTree& tree_;
  const Transport& transport_;
  std::size_t n_, channels_, lanes_;
  Field source_, r_, nodes_;          ///< by lane
  Field albedo_, F_albedo_, lost_;    ///< by channel; lost: albedo less what comes back of it
  std::vector<double> scale_;         ///< by lane
  std::vector<double> ambient_loss_;  ///< by space and channel: sum A lost [m2]
};

/// Lanes of one right-hand side as a spectrum.
Spectrum spectrum(const Field& x, std::size_t i, std::size_t first, int channels) {
  const double* at = x.value.data() + i * static_cast<std::size_t>(x.channels) + first;
  return channels == 1 ? Spectrum(at[0]) : Spectrum(at[0], at[1], at[2]);
}

}  // namespace

Balanced balance(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& M,
                 const Field& E_direct, Field B, double residual, const Monitor& monitor) {
  CLERESTORY_ASSERT(M.channels, ==, E_direct.channels);
  Balanced s;
  System system(patches, tree, transport, M, E_direct, std::move(B));
  for (s.residual = system.residual(); s.residual > residual; s.residual = system.residual()) {
    if (s.iterations == kMostSweeps) s.stop = StopReason::iteration_limit;
    if (monitor.should_stop()) s.stop = why_stopped(monitor);
    if (s.stop != StopReason::converged) break;
    system.sweep();
    ++s.iterations;
  }
  CLERESTORY_ASSERT(all_finite(system.FB), ==, true);

  const std::size_t n = patches.patch_count();
  const auto lanes = static_cast<std::size_t>(E_direct.channels), channels = static_cast<std::size_t>(patches.channels);
  s.E = s.B = Field(n, E_direct.channels);
  s.energy.resize(lanes / channels);
  for (std::size_t k = 0; k < s.E.value.size(); ++k) s.E.value[k] = E_direct.value[k] + system.FB.value[k];
  for (std::size_t i = 0; i < n; ++i) {
    system.for_lanes(i, [&](std::size_t l, std::size_t k, std::size_t c) {
      s.B.value[k] = M.value[k] + system.scattered(s.E, i, l, c);
    });
    const Losses on_its_way = losses(Spectrum(transport.arrives[i]), Spectrum(transport.escapes[i]));
    for (std::size_t k = 0; k < s.energy.size(); ++k)
      s.energy[k] += where_light_ends(patches, i, spectrum(s.E, i, k * channels, patches.channels),
                                      spectrum(s.B, i, k * channels, patches.channels), on_its_way);
  }
  return s;
}

}  // namespace clerestory
