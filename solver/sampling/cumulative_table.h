#pragma once
// A choice among many, in proportion to their weights.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace clerestory {

/// By the running sum of the weights, so that near numbers choose near entries and strata stay strata; a guide by the
/// number finds the entry in O(1) on the mean. 12 bytes an entry.
class CumulativeTable {
 public:
  CumulativeTable() = default;
  /// weights  >= 0
  explicit CumulativeTable(std::span<const double> weights) {
    std::size_t last = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      sum_ += weights[i];
      end_.push_back(sum_);
      if (weights[i] > 0) last = i;
    }
    if (!(sum_ > 0)) {
      end_.clear();
      return;
    }
    for (double& end : end_) end /= sum_;
    std::fill(end_.begin() + static_cast<std::ptrdiff_t>(last), end_.end(), 1.0);
    guide_.resize(end_.size());
    std::size_t i = 0;
    for (std::size_t k = 0; k < guide_.size(); ++k) {
      while (end_[i] * static_cast<double>(guide_.size()) <= static_cast<double>(k)) ++i;
      guide_[k] = static_cast<std::uint32_t>(i);
    }
  }

  /// No entry has any weight.
  bool empty() const { return end_.empty(); }
  double sum() const { return sum_; }
  double probability(std::size_t i) const { return end_.empty() ? 0 : end_[i] - (i > 0 ? end_[i - 1] : 0); }

  struct Choice {
    std::size_t index;
    double probability;
    double rest;  ///< in [0, 1): where between the entry's ends the number lies, as good as a new one
  };
  /// pick  in [0, 1); not of an empty table.
  Choice choose(double pick) const {
    auto i = static_cast<std::size_t>(guide_[static_cast<std::size_t>(pick * static_cast<double>(guide_.size()))]);
    while (i > 0 && end_[i - 1] > pick) --i;  // the product was rounded up
    while (end_[i] <= pick) ++i;
    const double p = probability(i), from = i > 0 ? end_[i - 1] : 0;
    return {i, p, std::clamp((pick - from) / p, 0.0, 0x1.fffffffffffffp-1)};
  }

 private:
  double sum_ = 0;
  std::vector<double> end_;           ///< running sum up to and with the entry, over the whole
  std::vector<std::uint32_t> guide_;  ///< first entry that a number from k / size on may choose
};

}  // namespace clerestory
