#pragma once
// The scale of false colours: which values, and which of them a legend names.

#include <span>
#include <vector>

namespace clerestory {

struct ValueScale {
  double low = 0, high = 1;  ///< low < high by 1e-9 of the larger, both within 1e15; 0 < low by logarithm
  bool by_logarithm = false;
};

/// Numbers to name, from low to high, both ends among them: multiples of 1, 2 or 5 x 10^n, at most `most` and the ends.
std::vector<double> ticks_of(const ValueScale& scale, int most);

/// Around nearly all values, 1 % at either end left out, and from there to numbers that are easy to read; from 0 unless
/// all are large beside their spread. Any scale where there are no values.
ValueScale scale_around(std::vector<float> values, bool by_logarithm);

}  // namespace clerestory
