#pragma once
// Numbers -> colours that are told apart as evenly as the numbers are.

#include <array>

namespace clerestory {

/// sRGB in [0, 1] of t in [0, 1] (clipped), from dark blue over green to yellow.
/// Source: viridis by van der Walt and Smith, 2015 (CC0); the fit by polynomials of sixth degree by Zucker, 2019 (CC0),
/// within 0.01 of it.
std::array<double, 3> viridis(double t);

/// Where a value stands in [low, high], 0 < low if by logarithm; clipped to [0, 1].
double place_in_range(double value, double low, double high, bool by_logarithm);

}  // namespace clerestory
