#pragma once
// Gauss-Legendre nodes, computed once instead of copied from a table.

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace clerestory {

/// Nodes and weights on [-1, 1], exact for polynomials of degree 2 Points - 1, by Newton's method on the Legendre
/// polynomial from Chebyshev's guess.
template <std::size_t Points>
struct GaussLegendre {
  std::array<double, Points> node, weight;

  GaussLegendre() {
    constexpr auto n = static_cast<double>(Points);
    for (std::size_t k = 0; k < Points; ++k) {
      double x = -std::cos(std::numbers::pi * (static_cast<double>(k) + 0.75) / (n + 0.5));
      double slope = 1;
      for (int step = 0; step < 8; ++step) {
        double p = 1, before = 0;
        for (std::size_t m = 1; m <= Points; ++m) {
          const auto j = static_cast<double>(m);
          const double next = ((2 * j - 1) * x * p - (j - 1) * before) / j;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      node[k] = x;
      weight[k] = 2 / ((1 - x * x) * slope * slope);
    }
  }
};

}  // namespace clerestory
