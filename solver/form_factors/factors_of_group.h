#pragma once
// What leaves one group of triangles and arrives at each other.

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "solver/form_factors/shaft.h"
#include "solver/form_factors/surface_form_factors.h"

namespace clerestory {

/// Sums over the pairs of triangles of one pair of groups.
struct PairSum {
  double exchange = 0;    ///< sum A_p F_pq V_pq [m2]
  double unoccluded = 0;  ///< sum A_p F_pq [m2]
  double variance = 0;    ///< of exchange [m4]
};

/// The row of one group in surface_form_factors(). Groups with more blocked pairs than are held at a time are looked at
/// in blocks of their patches: once for what all of them need, and once more to sample, each with the share of the
/// variance that its pairs would have had beside the others. Memory is bounded, whatever the number of triangles: 50 MB
/// for pairs, as much again while some are parted, and 50 MB for 2^18 parts.
class FactorsOfGroup {
 public:
  FactorsOfGroup(const PatchSet& patches, const RayScene& rays, const Blockers& blockers, const PatchGroups& groups,
                 const SurfaceFactorOptions& options)
      : patches_(patches), rays_(rays), blockers_(blockers), groups_(groups), options_(options) {}

  /// Adds to the sums, by group. goes_on: told which share is done; false stops the work.
  bool find(std::span<const std::uint32_t> members, std::span<PairSum> sums,
            const std::function<bool(double share)>& goes_on);

  std::size_t pairs_unblocked = 0, pairs_sampled = 0;
  unsigned long long rays_cast = 0;

 private:
  /// Two triangles, or parts of them, between which something may stand. Small, as they are many.
  struct Blocked {
    std::uint32_t i, j;     ///< the patches that they are, or are parts of
    std::uint32_t ends;     ///< index in parts_; kWhole: they are the patches
    int found_by = 0;       ///< samples
    int samples = 0;        ///< of the next time
    double unoccluded = 0;  ///< A_p F_pq [m2]
    double V = 0, std_error = 0;
    double variance() const { return unoccluded * std_error * unoccluded * std_error; }
  };
  static constexpr std::uint32_t kWhole = 0xffffffff;
  struct Ends {
    std::array<Vec3, 3> p, q;
    std::uint64_t key = 0;  ///< of their random stream
    int parted = 0;         ///< times
  };
  enum class Sight { none, open, blocked };
  struct Row;
  using GoesOn = std::function<bool(double share)>;

  int parted(const Blocked& pair) const { return pair.ends == kWhole ? 0 : parts_[pair.ends].parted; }
  Ends ends_of(const Blocked& pair) const;
  Sight sight(const Ends& ends, std::uint32_t i, std::uint32_t j, Row& work) const;
  void sample(Blocked& pair, const Ends& ends, std::uint64_t round) const;
  void look_from(std::uint32_t i, Row& row) const;
  bool look(std::span<const std::uint32_t> members, const GoesOn& goes_on);
  bool settle(const GoesOn& goes_on);
  bool sample_all(std::uint64_t round, const GoesOn& goes_on);
  std::vector<PairSum> sampled_sums() const;
  std::vector<double> needs() const;
  bool choose_samples(bool after_pilot);
  bool part_those_that_want_many();

  const PatchSet& patches_;
  const RayScene& rays_;
  const Blockers& blockers_;
  const PatchGroups& groups_;
  const SurfaceFactorOptions& options_;
  double least_ = 0, most_ = 0;  ///< samples of a pair, its parts together
  // Of the block at hand, some members of the group:
  std::size_t block_end_ = 0;     ///< the member after it
  std::vector<PairSum> exact_;    ///< by group: pairs that nothing blocks, or that are hidden
  std::vector<Blocked> blocked_;  ///< the others
  std::vector<Ends> parts_;       ///< of those that are parts
  std::size_t pairs_unblocked_here_ = 0;
  std::vector<PairSum> elsewhere_;  ///< by group: what the pilots of all other blocks found
  std::vector<double> share_;       ///< by group: of the variance that is allowed
};

}  // namespace clerestory
