#pragma once
// Least cost under linear conditions. COIN-OR Clp stays inside.

#include <optional>
#include <vector>

namespace clerestory {

/// Least cost . x with 0 <= x <= upper and A x >= at_least.
struct LinearProgramme {
  std::vector<double> cost;      ///< n
  std::vector<double> upper;     ///< n, > 0
  std::vector<double> A;         ///< m x n, row by row, of the order of 1: conditions are held to 1e-7
  std::vector<double> at_least;  ///< m
};

/// An x of least cost; nothing where no x holds all conditions. The same programme gives the same bits.
///
/// Cost: 1,000 rows of 10 columns take about a millisecond.
/// throws  std::runtime_error when Clp gives up, which numbers of very different size may bring about.
/// Source: Forrest & Hall, COIN-OR Linear Programming Solver (Clp), its dual simplex method.
std::optional<std::vector<double>> least_cost(const LinearProgramme& programme);

}  // namespace clerestory
