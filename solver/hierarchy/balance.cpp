#include "solver/hierarchy/balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "solver/hierarchy/gather_links.h"
#include "solver/model/assert.h"
#include "solver/model/units.h"
#include "solver/spaces/energy.h"

namespace clerestory {
namespace {

constexpr int kMostSweeps = 1'000;  // safety net; reaching it sets StopReason::iteration_limit

/// L lanes of the right-hand sides, from lane `first` on. Beyond their number lanes are dark.
///
/// One and three lanes gather all of B in every sweep. Eight gather what the last sweep added to it: in floats, which
/// are exact enough for what gets less and less, but would keep the residual of B from vanishing.
template <std::size_t L>
class System {
 public:
  /// first_guess  freed with the last of its lanes.
  System(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& M,
         const Field& E_direct, Field& first_guess, std::size_t first)
      : p_(patches),
        transport_(transport),
        n_(patches.patch_count()),
        first_(first),
        count_(std::min(L, static_cast<std::size_t>(E_direct.channels) - first)),
        gather_(tree, transport),
        source_(n_),
        B_(n_),
        FB_(n_),
        r_(n_) {
    const auto channels = static_cast<std::size_t>(p_.channels);
    for (std::size_t l = 0; l < L; ++l) channel_[l] = (first + l) % channels;
    const auto lanes = static_cast<std::size_t>(E_direct.channels);
    const auto load = [&](const Field& from, std::size_t i) {
      Lanes<L> x;
      std::copy_n(from.value.data() + i * lanes + first_, count_, x.lane.data());
      return x;
    };
    for (std::size_t i = 0; i < n_; ++i) FB_[i] = load(E_direct, i);
    for (std::size_t i = 0; i < n_; ++i) {
      const Lanes<L> emitted = load(M, i), scatters = scattered(FB_, i);
      for (std::size_t l = 0; l < L; ++l) {
        source_[i].lane[l] = emitted.lane[l] + scatters.lane[l];
        scale_.lane[l] += p_.area[i] * (emitted.lane[l] + FB_[i].lane[l]);
      }
    }
    if (first_guess.size() == n_ && first_guess.channels == E_direct.channels)
      for (std::size_t i = 0; i < n_; ++i) B_[i] = load(first_guess, i);
    else
      B_ = source_;
    if (first + L >= lanes) first_guess = {};
    if constexpr (kBySteps) {  // from B = 0: what is missing is all that is sent
      r_.swap(source_);
      FB_.assign(n_, {});
    }
    find_losses(tree);
    sweep();
  }

  /// From B: what arrives, its residual, the ambient irradiance that makes that vanish, and B of the next sweep.
  void sweep() {
    gather_(B_, arrives_of_B());
    find_residual();
    // Without ambient irradiance every sweep helps, as no row reflects more than arrives.
    if (residual() > kGrows * least_) uses_ambient_ = false;
    least_ = std::min(least_, residual());
    find_ambient();
    take_step();
  }

  /// Of B as it was gathered, before its step: what spaces send each other is in it.
  double residual() const {
    double worst = 0;
    for (std::size_t l = 0; l < L; ++l)
      if (scale_.lane[l] > 0) worst = std::max(worst, left_.lane[l] / scale_.lane[l]);
    return worst;
  }

  /// E += what arrives over links.
  void add_to(Field& E) const {
    for (std::size_t i = 0; i < n_; ++i) {
      const Lanes<L> comes_back = by_channel(F_albedo_, i);
      const Lanes<L>& e = e_[transport_.space[i]];
      for (std::size_t l = 0; l < count_; ++l)
        E.value[i * static_cast<std::size_t>(E.channels) + first_ + l] +=
            FB_[i].lane[l] + e.lane[l] * comes_back.lane[l];
    }
  }

 private:
  Lanes<L> by_channel(const Field& x, std::size_t i) const {
    Lanes<L> out;
    const double* at = x.value.data() + i * static_cast<std::size_t>(x.channels);
    if (x.channels == 1)
      for (std::size_t l = 0; l < L; ++l) out.lane[l] = at[0];
    else
      for (std::size_t l = 0; l < L; ++l) out.lane[l] = at[channel_[l]];
    return out;
  }
  /// PatchSet::scattered()
  Lanes<L> scattered(const std::vector<Lanes<L>>& E, std::size_t i) const {
    Lanes<L> out = by_channel(p_.rho, i);
    const Lanes<L> here = E[i];
    for (std::size_t l = 0; l < L; ++l) out.lane[l] *= here.lane[l];
    for (const PatchSet::Behind& other : p_.patches_behind(i)) {
      const Lanes<L> tau = by_channel(p_.tau, i);
      for (std::size_t l = 0; l < L; ++l) out.lane[l] += tau.lane[l] * E[other.patch].lane[l] * other.share;
    }
    return out;
  }

  /// What is lost of an ambient irradiance of 1 in each space, by channel.
  void find_losses(const ElementTree& tree) {
    albedo_ = F_albedo_ = lost_ = Field(n_, p_.channels);
    for (std::size_t i = 0; i < n_; ++i) albedo_.set(i, p_.albedo(i));
    Field nodes;
    pull(tree, albedo_, nodes);
    gather_and_push(transport_, tree, nodes, F_albedo_);
    ambient_loss_.resize(transport_.spaces);
    for (std::size_t i = 0; i < n_; ++i) {
      lost_.set(i, albedo_[i] - p_.scattered(F_albedo_, i));
      ambient_loss_[transport_.space[i]] += p_.area[i] * lost_[i];
    }
  }

  std::vector<Lanes<L>>& arrives_of_B() { return kBySteps ? source_ : FB_; }

  /// And its sum in each space.
  void find_residual() {
    const std::vector<Lanes<L>>& arrives = arrives_of_B();
    e_.assign(transport_.spaces, {});
    left_ = {};
    for (std::size_t i = 0; i < n_; ++i) {
      const Lanes<L> leaves = scattered(arrives, i), B = B_[i];
      const double area = p_.area[i];
      Lanes<L> r = kBySteps ? r_[i] : source_[i], e = e_[transport_.space[i]];
      for (std::size_t l = 0; l < L; ++l) r.lane[l] = r.lane[l] + leaves.lane[l] - B.lane[l];
      for (std::size_t l = 0; l < L; ++l) e.lane[l] += area * r.lane[l];
      for (std::size_t l = 0; l < L; ++l) left_.lane[l] += area * std::abs(r.lane[l]);
      r_[i] = r;
      e_[transport_.space[i]] = e;
      if constexpr (kBySteps) {
        Lanes<L> FB = FB_[i];
        const Lanes<L> more = arrives[i];
        for (std::size_t l = 0; l < L; ++l) FB.lane[l] += more.lane[l];
        FB_[i] = FB;
      }
    }
  }

  /// What makes the residual vanish in the mean of each space.
  void find_ambient() {
    for (std::size_t s = 0; s < e_.size(); ++s)
      for (std::size_t l = 0; l < L; ++l) {
        const double loss = ambient_loss_[s].c[channel_[l]];
        e_[s].lane[l] = loss > 0 && uses_ambient_ ? e_[s].lane[l] / loss : 0;
      }
  }

  void take_step() {
    for (std::size_t i = 0; i < n_; ++i) {
      const Lanes<L> albedo = by_channel(albedo_, i), lost = by_channel(lost_, i), e = e_[transport_.space[i]];
      Lanes<L> r = r_[i], B = kBySteps ? Lanes<L>{} : B_[i];
      for (std::size_t l = 0; l < L; ++l) r.lane[l] -= e.lane[l] * lost.lane[l];
      for (std::size_t l = 0; l < L; ++l) B.lane[l] = B.lane[l] + e.lane[l] * albedo.lane[l] + r.lane[l];
      B_[i] = B;
    }
  }

  static constexpr bool kBySteps = L == 8;
  static constexpr double kGrows = 2;  ///< where spaces light each other so much that correcting each overshoots

  const PatchSet& p_;
  const Transport& transport_;
  std::size_t n_, first_, count_;
  std::array<std::size_t, L> channel_;  ///< of each lane
  LinkGather<L> gather_;
  std::vector<Lanes<L>> source_;        ///< by steps: what arrives of B_
  std::vector<Lanes<L>> B_;             ///< by steps: what was added to B last
  std::vector<Lanes<L>> FB_, r_;        ///< all that arrives; M + rho E - B before the ambient irradiance e
  Field albedo_, F_albedo_, lost_;      ///< by channel; lost: albedo less what comes back of it
  std::vector<Spectrum> ambient_loss_;  ///< by space: sum A lost [m2]
  Lanes<L> scale_, left_;
  std::vector<Lanes<L>> e_;  ///< by space
  bool uses_ambient_ = true;
  double least_ = 1e300;  ///< residual so far
};

struct Sweeps {
  long count = 0;
  double residual = 0;
  StopReason stop = StopReason::converged;
};

template <std::size_t L>
Sweeps sweep_until(System<L>& system, double residual, const Monitor& monitor) {
  Sweeps done;
  for (done.residual = system.residual(); done.residual > residual; done.residual = system.residual()) {
    if (done.count == kMostSweeps) done.stop = StopReason::iteration_limit;
    if (monitor.should_stop()) done.stop = why_stopped(monitor);
    if (done.stop != StopReason::converged) break;
    system.sweep();
    ++done.count;
  }
  return done;
}

Losses on_its_way(const Transport& transport, std::size_t i) {
  return losses(Spectrum(transport.arrives[i]), Spectrum(transport.escapes[i]), transport.has_gloss);
}

/// B, and where the light ends.
void end_of_one(const PatchSet& patches, const Transport& transport, const Field& M, Balanced& s) {
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const Spectrum radiosity = M[i] + patches.scattered(s.E, i);
    s.B.set(i, radiosity);
    s.energy[0] += where_light_ends(patches, i, s.E[i], radiosity, on_its_way(transport, i));
  }
}

/// The same for any number: sums by lane of what where_light_ends() says of each leaf [W].
void end_of_many(const PatchSet& patches, const Transport& transport, const Field& M, Balanced& s) {
  const auto lanes = static_cast<std::size_t>(M.channels), channels = static_cast<std::size_t>(patches.channels);
  std::vector<double> absorbed(lanes), escaped(lanes);
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const Losses loss = on_its_way(transport, i);
    const Spectrum rho = patches.rho[i], albedo = patches.albedo(i);
    const double *E = &s.E.value[i * lanes], *emitted = &M.value[i * lanes];
    double* B = &s.B.value[i * lanes];
    for (std::size_t l = 0; l < lanes; ++l) B[l] = emitted[l] + rho.c[l % channels] * E[l];
    for (const PatchSet::Behind& other : patches.patches_behind(i))
      for (std::size_t l = 0; l < lanes; ++l)
        B[l] += patches.tau[i].c[l % channels] * s.E.value[other.patch * lanes + l] * other.share;
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::size_t c = l % channels;
      absorbed[l] += patches.area[i] * ((1 - albedo.c[c]) * E[l] + loss.lost.c[c] * B[l]);
      escaped[l] += patches.area[i] * loss.escapes.c[c] * B[l];
    }
  }
  const auto mean = [&](const std::vector<double>& flux, std::size_t first) {
    return luminous_mean(channels == 1 ? Spectrum(flux[first])
                                       : Spectrum(flux[first], flux[first + 1], flux[first + 2]));
  };
  for (std::size_t k = 0; k < s.energy.size(); ++k) {
    s.energy[k].absorbed = mean(absorbed, k * channels);
    s.energy[k].escaped = mean(escaped, k * channels);
  }
}

}  // namespace

Balanced balance(const PatchSet& patches, const ElementTree& tree, const Transport& transport, const Field& M,
                 const Field& E_direct, Field B, double residual, const Monitor& monitor) {
  CLERESTORY_ASSERT(M.channels, ==, E_direct.channels);
  Balanced s;
  const auto lanes = static_cast<std::size_t>(E_direct.channels), channels = static_cast<std::size_t>(patches.channels);
  const auto solve = [&]<std::size_t L>(std::size_t first) {
    System<L> system(patches, tree, transport, M, E_direct, B, first);
    const Sweeps done = sweep_until(system, residual, monitor);
    if (s.E.value.empty()) s.E = E_direct;
    system.add_to(s.E);
    s.iterations = std::max(s.iterations, done.count);
    s.residual = std::max(s.residual, done.residual);
    if (done.stop != StopReason::converged) s.stop = done.stop;
  };
  if (lanes == 1) solve.template operator()<1>(0);
  if (lanes == 3) solve.template operator()<3>(0);
  for (std::size_t first = 0; first < lanes && lanes != 1 && lanes != 3; first += 8)
    solve.template operator()<8>(first);
  CLERESTORY_ASSERT(all_finite(s.E), ==, true);

  s.B = Field(patches.patch_count(), E_direct.channels);
  s.energy.resize(lanes / channels);
  if (s.energy.size() == 1)
    end_of_one(patches, transport, M, s);
  else
    end_of_many(patches, transport, M, s);
  return s;
}

}  // namespace clerestory
