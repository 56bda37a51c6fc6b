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

/// The row of one group in surface_form_factors().
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
  /// Two triangles, or parts of them, between which something may stand.
  struct Blocked {
    std::array<Vec3, 3> p, q;
    std::uint32_t i, j;     ///< the patches that they are parts of
    std::uint64_t key = 0;  ///< of their random stream
    int parted = 0;         ///< times
    double unoccluded = 0;  ///< A_p F_pq [m2]
    double V = 0, std_error = 0;
    int found_by = 0;  ///< samples
    int samples = 0;   ///< of the next time
    double variance() const { return unoccluded * std_error * unoccluded * std_error; }
  };
  enum class Sight { none, open, blocked };
  struct Row;

  Sight sight(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q, std::uint32_t i, std::uint32_t j,
              Row& work) const;
  void sample(Blocked& pair, std::uint64_t round) const;
  bool look(std::span<const std::uint32_t> members, const std::function<bool(double)>& goes_on);
  bool sample_all(std::uint64_t round, const std::function<bool(double)>& goes_on);
  std::vector<PairSum> sampled_sums() const;
  bool choose_samples(bool after_pilot);
  bool part_those_that_want_many();

  const PatchSet& patches_;
  const RayScene& rays_;
  const Blockers& blockers_;
  const PatchGroups& groups_;
  const SurfaceFactorOptions& options_;
  std::vector<PairSum> exact_;    ///< by group: pairs that nothing blocks, or that are hidden
  std::vector<Blocked> blocked_;  ///< the others
  double least_ = 0, most_ = 0;   ///< samples of a pair, its parts together
};

}  // namespace clerestory
