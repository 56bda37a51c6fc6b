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
constexpr std::size_t kMostParts = 1 << 18;  // held at a time

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
  std::vector<Ends> parts;
  std::size_t unblocked = 0;
};

FactorsOfGroup::Ends FactorsOfGroup::ends_of(const Blocked& pair) const {
  if (pair.ends != kWhole) return parts_[pair.ends];
  return {patches_.corner_positions(PatchId{std::size_t{pair.i}}),
          patches_.corner_positions(PatchId{std::size_t{pair.j}}), stream_key(options_.seed, pair.i, pair.j)};
}

FactorsOfGroup::Sight FactorsOfGroup::sight(const Ends& ends, std::uint32_t i, std::uint32_t j, Row& work) const {
  const Box box = Box::around(ends.p), other = Box::around(ends.q);
  blockers_.in_shaft(box, other, work.in_shaft);
  const PairShaft shaft(ends.p, patches_.normal[i], ends.q, patches_.normal[j], blockers_.touching());
  if (std::ranges::none_of(work.in_shaft, [&](const Blocker* b) { return shaft.reached_by(*b); })) return Sight::open;
  blockers_.screens_in_shaft(box, other, work.screens);
  const bool hidden = std::ranges::any_of(
      work.screens, [&](const Screen* s) { return s->hides(ends.p, ends.q, blockers_.touching()); });
  return hidden ? Sight::none : Sight::blocked;
}

void FactorsOfGroup::sample(Blocked& pair, const Ends& ends, std::uint64_t round) const {
  const SampledVisibility V = sample_visibility({ends.p, patches_.normal[pair.i]}, {ends.q, patches_.normal[pair.j]},
                                                rays_, stream_key(ends.key, round), pair.samples);
  pair.V = V.value, pair.std_error = V.std_error, pair.found_by = pair.samples;
}

/// Sums what needs no rays, and sends a pilot where they are needed.
void FactorsOfGroup::look_from(std::uint32_t i, Row& row) const {
  row.to.assign(groups_.name.size(), {});
  const auto p = patches_.corner_positions(PatchId{std::size_t{i}});
  for (std::uint32_t j = 0; j < patches_.patch_count(); ++j) {
    if (i == j) continue;
    const Ends ends{p, patches_.corner_positions(PatchId{std::size_t{j}}), stream_key(options_.seed, i, j)};
    const double unoccluded = exchange_area(ends.p, ends.q);
    if (unoccluded == 0) continue;
    PairSum& sum = row.to[groups_.group[j]];
    sum.unoccluded += unoccluded;
    const Sight seen = sight(ends, i, j, row);
    if (seen == Sight::open) ++row.unblocked, sum.exchange += unoccluded;
    if (seen != Sight::blocked) continue;
    Blocked pair{.i = i, .j = j, .ends = kWhole, .samples = kPilot, .unoccluded = unoccluded};
    sample(pair, ends, 0);
    row.blocked.push_back(pair);
  }
}

/// The next block: members from block_end_ on, until no more are to be held.
bool FactorsOfGroup::look(std::span<const std::uint32_t> members, const GoesOn& goes_on) {
  // A slice of patches at a time: their rows would not fit in memory all at once when each patch is a group.
  constexpr std::size_t kSlice = 64;
  const std::size_t n = patches_.patch_count();
  exact_.assign(groups_.name.size(), {});
  blocked_.clear(), parts_.clear();
  pairs_unblocked_here_ = 0;
  // Memory that is not written to costs nothing; growing would hold it twice.
  blocked_.reserve(std::min((members.size() - block_end_) * n, options_.pairs_held + kSlice * n));
  std::vector<Row> slice(kSlice);
  while (block_end_ < members.size() && blocked_.size() < options_.pairs_held) {
    if (!goes_on(static_cast<double>(block_end_) / static_cast<double>(members.size()))) return false;
    const std::size_t first = block_end_, here = std::min(kSlice, members.size() - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) look_from(members[first + k], slice[k] = {});
    });
    for (std::size_t k = 0; k < here; ++k) {
      for (std::size_t g = 0; g < exact_.size(); ++g) {
        exact_[g].exchange += slice[k].to[g].exchange;
        exact_[g].unoccluded += slice[k].to[g].unoccluded;
      }
      pairs_unblocked_here_ += slice[k].unblocked;
      blocked_.insert(blocked_.end(), slice[k].blocked.begin(), slice[k].blocked.end());
    }
    block_end_ += here;
  }
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

/// By group, to compare blocks: the variance that each is best allowed goes with it (choose_samples).
std::vector<double> FactorsOfGroup::needs() const {
  std::vector<double> sums(groups_.name.size(), 0.0);
  for (const Blocked& pair : blocked_)
    sums[groups_.group[pair.j]] += std::pow(pair.variance(), 1 / (1 + kVarianceFalls));
  return sums;
}

/// Sets the samples of the next round: of all pairs to a group as few as bring its variance down to what is wanted,
/// where one more gains the same for each. False when no pair wants more than it had.
bool FactorsOfGroup::choose_samples(bool after_pilot) {
  // Least sum of n for sum v0 (n / n0)^-a = error^2: n = n0 (v0 / (n0 lambda))^(1 / (1 + a)).
  const std::vector<PairSum> found = sampled_sums();
  // Where no ray arrived, what is unseen falls like 1 / n.
  const auto exchange = [&](std::size_t g) { return elsewhere_[g].exchange + found[g].exchange; };
  const auto falls = [&](std::size_t g) { return exchange(g) > 0 ? kVarianceFalls : 2.0; };
  std::vector<double> needs(found.size(), 0.0), lambda(found.size(), 0.0);
  for (const Blocked& pair : blocked_) {
    const std::size_t g = groups_.group[pair.j];
    const double a = falls(g);
    needs[g] += std::pow(pair.variance(), 1 / (1 + a)) * std::pow(static_cast<double>(pair.found_by), a / (1 + a));
  }
  for (std::size_t g = 0; g < found.size(); ++g) {
    const double error = exchange(g) > 0 ? kFactorError * exchange(g)
                                         : (elsewhere_[g].unoccluded + found[g].unoccluded) / kSamplesOfHidden;
    const double asked = error * error * share_[g];
    if (!(needs[g] > 0) || (!after_pilot && found[g].variance <= asked)) continue;  // reached
    // A little less than what is asked for: the estimate of an error is uncertain by a fifth.
    constexpr double kToBeSure = 0.85;
    lambda[g] = std::pow(kToBeSure * kToBeSure * asked / needs[g], (1 + falls(g)) / falls(g));
  }
  bool more = false;
  for (Blocked& pair : blocked_) {
    const std::size_t g = groups_.group[pair.j];
    const double v0 = pair.variance(), n0 = pair.found_by, l = lambda[g];
    const double wanted = v0 > 0 && l > 0 ? n0 * std::pow(v0 / (n0 * l), 1 / (1 + falls(g))) : 0;
    const double of_all = std::pow(16.0, -parted(pair));
    const double most = kPilot * std::max(1.0, std::floor(most_ * of_all / kPilot));  // no more than were asked for
    const int samples =
        kPilot * static_cast<int>(std::ceil(std::clamp(wanted, std::min(least_ * of_all, most), most) / kPilot));
    pair.samples = after_pilot ? samples : std::max(samples, pair.found_by);
    more |= pair.samples > pair.found_by;
  }
  return more;
}

/// Pairs that want many samples become sixteen, of which those that are open or hidden need none.
bool FactorsOfGroup::part_those_that_want_many() {
  std::vector<std::size_t> wanting;
  for (std::size_t k = 0; k < blocked_.size(); ++k)
    if (blocked_[k].samples >= kWorthParting && parted(blocked_[k]) < kMostPartings) wanting.push_back(k);
  if (wanting.empty()) return false;
  const auto part = [&](const Blocked& pair, Row& row) {
    const Ends whole = ends_of(pair);
    row.to.resize(1);
    std::uint64_t number = 0;
    for (const auto& p : quarters(whole.p))
      for (const auto& q : quarters(whole.q)) {
        const Ends ends{p, q, stream_key(whole.key, ++number), whole.parted + 1};
        const double unoccluded = exchange_area(p, q);
        if (unoccluded == 0) continue;
        const Sight seen = sight(ends, pair.i, pair.j, row);
        if (seen == Sight::open) row.to[0].exchange += unoccluded;
        if (seen != Sight::blocked) continue;
        row.blocked.push_back({.i = pair.i, .j = pair.j, .ends = kWhole, .samples = kPilot, .unoccluded = unoccluded});
        sample(row.blocked.back(), ends, 0);
        row.parts.push_back(ends);
      }
  };
  constexpr std::size_t kSlice = 256;
  std::vector<Row> slice(kSlice);
  std::vector<Blocked> all;
  std::size_t kept = 0;  // of blocked_, those before it are in `all`
  for (std::size_t first = 0; first < wanting.size() && parts_.size() < kMostParts; first += kSlice) {
    const std::size_t here = std::min(kSlice, wanting.size() - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) part(blocked_[wanting[first + k]], slice[k] = {});
    });
    for (std::size_t k = 0; k < here; ++k) {
      const std::size_t parted_one = wanting[first + k];
      all.insert(all.end(), blocked_.data() + kept, blocked_.data() + parted_one);
      kept = parted_one + 1;
      exact_[groups_.group[blocked_[parted_one].j]].exchange += slice[k].to[0].exchange;
      rays_cast += slice[k].blocked.size() * std::size_t{kPilot};
      for (std::size_t m = 0; m < slice[k].blocked.size(); ++m) {
        all.push_back(slice[k].blocked[m]);
        all.back().ends = static_cast<std::uint32_t>(parts_.size());
        parts_.push_back(slice[k].parts[m]);
      }
    }
  }
  if (kept == 0) return false;  // no more are to be held
  all.insert(all.end(), blocked_.data() + kept, blocked_.data() + blocked_.size());
  blocked_ = std::move(all);
  return true;
}

/// Samples pairs anew that want more than they had; those of the pilot all, as its samples chose.
bool FactorsOfGroup::sample_all(std::uint64_t round, const GoesOn& goes_on) {
  std::vector<Blocked*> wanted;
  for (Blocked& pair : blocked_)
    if (round == 1 || pair.samples > pair.found_by) wanted.push_back(&pair);
  constexpr std::size_t kSlice = 256;
  for (std::size_t first = 0; first < wanted.size(); first += kSlice) {
    if (!goes_on(static_cast<double>(first) / static_cast<double>(wanted.size()))) return false;
    const std::size_t here = std::min(kSlice, wanted.size() - first);
    parallel_for(here, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) sample(*wanted[first + k], ends_of(*wanted[first + k]), round);
    });
    for (std::size_t k = 0; k < here; ++k) rays_cast += static_cast<unsigned long long>(wanted[first + k]->samples);
  }
  return true;
}

/// Samples the block at hand until its share of the error is reached, or the most samples are used up.
bool FactorsOfGroup::settle(const GoesOn& goes_on) {
  do {
    choose_samples(true);
  } while (part_those_that_want_many());
  for (std::uint64_t round = 1; round <= kMostRounds; ++round) {
    if (!sample_all(round, goes_on)) return false;
    if (!choose_samples(false)) break;
  }
  return true;
}

bool FactorsOfGroup::find(std::span<const std::uint32_t> members, std::span<PairSum> sums, const GoesOn& goes_on) {
  std::vector<PairSum> all(groups_.name.size());
  std::vector<double> all_need(all.size(), 0.0);
  const auto add_block = [](std::span<PairSum> to, const std::vector<PairSum>& found) {
    for (std::size_t g = 0; g < found.size(); ++g) {
      to[g].exchange += found[g].exchange, to[g].unoccluded += found[g].unoccluded;
      to[g].variance += found[g].variance;
    }
  };
  std::size_t blocks = 0;
  for (block_end_ = 0; block_end_ < members.size(); ++blocks) {
    if (!look(members, [&](double share) { return goes_on(0.5 * share); })) return false;
    add_block(all, sampled_sums());
    const std::vector<double> need = needs();
    for (std::size_t g = 0; g < need.size(); ++g) all_need[g] += need[g];
    pairs_unblocked += pairs_unblocked_here_, pairs_sampled += blocked_.size();
  }
  most_ = options_.most_samples;
  if (most_ == 0)
    most_ = std::clamp<double>(kAllSamples / static_cast<double>(groups_.name.size() * (pairs_sampled + 1)), kFewest,
                               kMost);
  least_ = std::clamp(kAllAtLeast / static_cast<double>(pairs_sampled + 1), 1.0, double{kMostAtLeast});
  if (most_ < 2 * kPilot) {  // nothing to choose: the pilots are what was asked for
    add_block(sums, all);
    return true;
  }

  const auto size = static_cast<double>(members.size());
  if (blocks > 1) block_end_ = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t begin = blocks > 1 ? block_end_ : 0;
    if (blocks > 1 && !look(members, [&](double share) { return goes_on(0.5 + 0.5 * share); })) return false;
    const std::vector<PairSum> here = sampled_sums();
    share_ = needs(), elsewhere_ = all;
    for (std::size_t g = 0; g < here.size(); ++g) {
      share_[g] = all_need[g] > 0 ? share_[g] / all_need[g] : 1;
      elsewhere_[g].exchange = std::max(0.0, elsewhere_[g].exchange - here[g].exchange);
      elsewhere_[g].unoccluded = std::max(0.0, elsewhere_[g].unoccluded - here[g].unoccluded);
    }
    const auto from = static_cast<double>(begin), to = static_cast<double>(block_end_);
    if (!settle([&](double share) { return goes_on(0.5 + 0.5 * (from + share * (to - from)) / size); })) return false;
    add_block(sums, sampled_sums());
  }
  return true;
}

}  // namespace clerestory
