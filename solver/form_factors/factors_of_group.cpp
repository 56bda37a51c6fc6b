#include "solver/form_factors/factors_of_group.h"

#include <algorithm>
#include <cmath>

#include "solver/form_factors/polygon_to_polygon.h"
#include "solver/form_factors/sampled.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

constexpr int kPilot = 256;               // samples of each pair that tell where more are worth most
constexpr double kVarianceFalls = 1.25;   // with the samples to this power (tests/convergence)
constexpr int kSamplesOfHidden = 16'384;  // where no ray arrives
constexpr int kWorthParting = 8'192;      // samples; sixteen pilots are half of that
constexpr int kMostPartings = 3;
constexpr double kAllSamples = 1 << 28;  // of all groups, unless the fewest are more: some seconds of a core
constexpr int kFewest = 32'768, kMost = 16'777'216;
/// What a pair gets at least: where pairs are few, factors are better than they have to be, in no time.
constexpr double kAllAtLeast = 1 << 24;
constexpr int kMostAtLeast = 16'384;
constexpr int kMostRounds = 6;

/// The four halves in length of a triangle.
std::array<std::array<Vec3, 3>, 4> quarters(const std::array<Vec3, 3>& t) {
  const Vec3 ab = (t[0] + t[1]) / 2, bc = (t[1] + t[2]) / 2, ca = (t[2] + t[0]) / 2;
  return {{{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}}};
}

}  // namespace

/// What one task needs and finds.
struct FactorsOfGroup::Row {
  std::vector<const Blocker*> in_shaft;
  std::vector<const Screen*> screens;
  std::vector<PairSum> to;
  std::vector<Blocked> blocked;
  std::size_t unblocked = 0;
};

FactorsOfGroup::Sight FactorsOfGroup::sight(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q, std::uint32_t i,
                                            std::uint32_t j, Row& work) const {
  const Box box = Box::around(p), other = Box::around(q);
  blockers_.in_shaft(box, other, work.in_shaft);
  const PairShaft shaft(p, patches_.normal[i], q, patches_.normal[j], blockers_.touching());
  if (std::ranges::none_of(work.in_shaft, [&](const Blocker* b) { return shaft.reached_by(*b); })) return Sight::open;
  blockers_.screens_in_shaft(box, other, work.screens);
  const bool hidden =
      std::ranges::any_of(work.screens, [&](const Screen* s) { return s->hides(p, q, blockers_.touching()); });
  return hidden ? Sight::none : Sight::blocked;
}

void FactorsOfGroup::sample(Blocked& pair, std::uint64_t round) const {
  const SampledVisibility V = sample_visibility({pair.p, patches_.normal[pair.i]}, {pair.q, patches_.normal[pair.j]},
                                                rays_, stream_key(pair.key, round), pair.samples);
  pair.V = V.value, pair.std_error = V.std_error, pair.found_by = pair.samples;
}

/// Sums what needs no rays, and sends a pilot where they are needed.
bool FactorsOfGroup::look(std::span<const std::uint32_t> members, const std::function<bool(double)>& goes_on) {
  const std::size_t n = patches_.patch_count();
  exact_.assign(groups_.name.size(), {});
  const auto row_of = [&](std::uint32_t i, Row& row) {
    row.to.assign(exact_.size(), {});
    const auto p = patches_.corner_positions(PatchId{std::size_t{i}});
    for (std::uint32_t j = 0; j < n; ++j) {
      if (i == j) continue;
      const auto q = patches_.corner_positions(PatchId{std::size_t{j}});
      const double unoccluded = exchange_area(p, q);
      if (unoccluded == 0) continue;
      PairSum& sum = row.to[groups_.group[j]];
      sum.unoccluded += unoccluded;
      const Sight seen = sight(p, q, i, j, row);
      if (seen == Sight::open) ++row.unblocked, sum.exchange += unoccluded;
      if (seen != Sight::blocked) continue;
      Blocked pair{p, q, i, j, stream_key(options_.seed, i, j), 0, unoccluded, 0, 0, 0, kPilot};
      sample(pair, 0);
      row.blocked.push_back(pair);
    }
  };
  // A slice of patches at a time: their rows would not fit in memory all at once when each patch is a group.
  constexpr std::size_t kSlice = 64;
  std::vector<Row> slice(kSlice);
  for (std::size_t first = 0; first < members.size(); first += kSlice) {
    if (!goes_on(0.5 * static_cast<double>(first) / static_cast<double>(members.size()))) return false;
    const std::size_t here = std::min(kSlice, members.size() - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) row_of(members[first + k], slice[k] = {});
    });
    for (std::size_t k = 0; k < here; ++k) {
      for (std::size_t g = 0; g < exact_.size(); ++g) {
        exact_[g].exchange += slice[k].to[g].exchange;
        exact_[g].unoccluded += slice[k].to[g].unoccluded;
      }
      pairs_unblocked += slice[k].unblocked;
      blocked_.insert(blocked_.end(), slice[k].blocked.begin(), slice[k].blocked.end());
    }
  }
  pairs_sampled = blocked_.size();
  rays_cast += blocked_.size() * std::size_t{kPilot};
  return true;
}

std::vector<PairSum> FactorsOfGroup::sampled_sums() const {
  std::vector<PairSum> sums = exact_;
  for (const Blocked& pair : blocked_) {
    PairSum& sum = sums[groups_.group[pair.j]];
    sum.exchange += pair.unoccluded * pair.V;
    sum.variance += pair.variance();
  }
  return sums;
}

/// Sets the samples of the next round: of all pairs to a group as few as bring its variance down to what is wanted,
/// where one more gains the same for each. False when no pair wants more than it had.
bool FactorsOfGroup::choose_samples(bool after_pilot) {
  // Least sum of n for sum v0 (n / n0)^-a = error^2: n = n0 (v0 / (n0 lambda))^(1 / (1 + a)).
  const std::vector<PairSum> found = sampled_sums();
  // Where no ray arrived, what is unseen falls like 1 / n.
  const auto falls = [&](std::size_t g) { return found[g].exchange > 0 ? kVarianceFalls : 2.0; };
  std::vector<double> needs(found.size(), 0.0), lambda(found.size(), 0.0);
  for (const Blocked& pair : blocked_) {
    const std::size_t g = groups_.group[pair.j];
    const double a = falls(g);
    needs[g] += std::pow(pair.variance(), 1 / (1 + a)) * std::pow(static_cast<double>(pair.found_by), a / (1 + a));
  }
  for (std::size_t g = 0; g < found.size(); ++g) {
    const double asked =
        found[g].exchange > 0 ? kFactorError * found[g].exchange : found[g].unoccluded / kSamplesOfHidden;
    if (!(needs[g] > 0) || (!after_pilot && found[g].variance <= asked * asked)) continue;  // reached
    // A little less than what is asked for: the estimate of an error is uncertain by a fifth.
    constexpr double kToBeSure = 0.85;
    lambda[g] = std::pow(kToBeSure * kToBeSure * asked * asked / needs[g], (1 + falls(g)) / falls(g));
  }
  bool more = false;
  for (Blocked& pair : blocked_) {
    const std::size_t g = groups_.group[pair.j];
    const double v0 = pair.variance(), n0 = pair.found_by, l = lambda[g];
    const double wanted = v0 > 0 && l > 0 ? n0 * std::pow(v0 / (n0 * l), 1 / (1 + falls(g))) : 0;
    const double of_all = std::pow(16.0, -pair.parted), most = std::max<double>(kPilot, most_ * of_all);
    const int samples =
        kPilot * static_cast<int>(std::ceil(std::clamp(wanted, std::min(least_ * of_all, most), most) / kPilot));
    pair.samples = after_pilot ? samples : std::max(samples, pair.found_by);
    more |= pair.samples > pair.found_by;
  }
  return more;
}

/// Pairs that want many samples become sixteen, of which those that are open or hidden need none.
bool FactorsOfGroup::part_those_that_want_many() {
  std::vector<Row> parts(blocked_.size());
  parallel_for(blocked_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Blocked& pair = blocked_[k];
      if (pair.samples < kWorthParting || pair.parted == kMostPartings) continue;
      Row& row = parts[k];
      row.to.resize(1);
      std::uint64_t number = 0;
      for (const auto& p : quarters(pair.p))
        for (const auto& q : quarters(pair.q)) {
          ++number;
          const double unoccluded = exchange_area(p, q);
          if (unoccluded == 0) continue;
          const Sight seen = sight(p, q, pair.i, pair.j, row);
          if (seen == Sight::open) row.to[0].exchange += unoccluded;
          if (seen != Sight::blocked) continue;
          Blocked part{p, q, pair.i, pair.j, stream_key(pair.key, number), pair.parted + 1, unoccluded,
                       0, 0, 0,      kPilot};
          sample(part, 0);
          row.blocked.push_back(part);
        }
    }
  });
  std::vector<Blocked> all;
  for (std::size_t k = 0; k < blocked_.size(); ++k) {
    if (parts[k].to.empty()) {
      all.push_back(blocked_[k]);
      continue;
    }
    exact_[groups_.group[blocked_[k].j]].exchange += parts[k].to[0].exchange;
    rays_cast += parts[k].blocked.size() * std::size_t{kPilot};
    all.insert(all.end(), parts[k].blocked.begin(), parts[k].blocked.end());
  }
  const bool any =
      all.size() != blocked_.size() || std::ranges::any_of(parts, [](const Row& row) { return !row.to.empty(); });
  blocked_ = std::move(all);
  return any;
}

/// Samples pairs anew that want more than they had; those of the pilot all, as its samples chose.
bool FactorsOfGroup::sample_all(std::uint64_t round, const std::function<bool(double)>& goes_on) {
  std::vector<Blocked*> wanted;
  for (Blocked& pair : blocked_)
    if (round == 1 || pair.samples > pair.found_by) wanted.push_back(&pair);
  constexpr std::size_t kSlice = 256;
  for (std::size_t first = 0; first < wanted.size(); first += kSlice) {
    if (!goes_on(0.5 + 0.5 * static_cast<double>(first) / static_cast<double>(wanted.size()))) return false;
    const std::size_t here = std::min(kSlice, wanted.size() - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) sample(*wanted[first + k], round);
    });
    for (std::size_t k = 0; k < here; ++k) rays_cast += static_cast<unsigned long long>(wanted[first + k]->samples);
  }
  return true;
}

bool FactorsOfGroup::find(std::span<const std::uint32_t> members, std::span<PairSum> sums,
                          const std::function<bool(double share)>& goes_on) {
  if (!look(members, goes_on)) return false;
  most_ = options_.most_samples;
  if (most_ == 0)
    most_ = std::clamp<double>(kAllSamples / static_cast<double>(groups_.name.size() * (pairs_sampled + 1)), kFewest,
                               kMost);
  least_ = std::clamp(kAllAtLeast / static_cast<double>(pairs_sampled + 1), 1.0, double{kMostAtLeast});
  do {
    choose_samples(true);
  } while (part_those_that_want_many());
  for (std::uint64_t round = 1; round <= kMostRounds; ++round) {
    if (!sample_all(round, goes_on)) return false;
    if (!choose_samples(false)) break;
  }
  std::ranges::copy(sampled_sums(), sums.begin());
  return true;
}

}  // namespace clerestory
