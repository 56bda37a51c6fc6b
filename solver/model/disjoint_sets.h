#pragma once
// Numbers joined into sets: patches that see each other, corners that share a point.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace clerestory {

/// Disjoint sets of 0 .. n - 1; a set is named by its smallest member, so names follow the order of the numbers.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace clerestory
