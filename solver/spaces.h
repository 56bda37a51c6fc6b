#pragma once
// Patches that see each other, directly or over others.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace clerestory {

/// Disjoint sets of patch numbers; a space is named by its smallest patch.
class Spaces {
 public:
  explicit Spaces(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }

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
