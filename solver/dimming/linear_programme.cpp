#include "solver/dimming/linear_programme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <coin/Clp_C_Interface.h>

#include "solver/model/assert.h"

namespace clerestory {

std::optional<std::vector<double>> least_cost(const LinearProgramme& p) {
  const std::size_t n = p.cost.size(), m = p.at_least.size();
  CLERESTORY_ASSERT(p.upper.size(), ==, n);
  CLERESTORY_ASSERT(p.A.size(), ==, m * n);

  // Clp takes what is nearer to a limit than 1e-7 for the limit. So that this is little to the conditions too, it works
  // on scale_k x_k, with no coefficient above 1.
  std::vector<double> scale(n, 1.0), cost(n), upper(n);
  for (std::size_t i = 0; i < m * n; ++i) scale[i % n] = std::max(scale[i % n], std::abs(p.A[i]));
  for (std::size_t k = 0; k < n; ++k) cost[k] = p.cost[k] / scale[k], upper[k] = p.upper[k] * scale[k];
  if (const double most = n > 0 ? std::ranges::max(cost) : 0; most > 0)
    for (double& c : cost) c /= most;

  // By columns, without the zeros.
  std::vector<CoinBigIndex> start = {0};
  std::vector<int> row;
  std::vector<double> value;
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t i = 0; i < m; ++i)
      if (p.A[i * n + k] != 0) row.push_back(static_cast<int>(i)), value.push_back(p.A[i * n + k] / scale[k]);
    start.push_back(static_cast<CoinBigIndex>(row.size()));
  }
  const std::vector<double> lower(n, 0.0), no_limit(m, std::numeric_limits<double>::infinity());

  const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex*)> model(Clp_newModel(), Clp_deleteModel);
  Clp_setLogLevel(model.get(), 0);
  Clp_loadProblem(model.get(), static_cast<int>(n), static_cast<int>(m), start.data(), row.data(), value.data(),
                  lower.data(), upper.data(), cost.data(), p.at_least.data(), no_limit.data());
  Clp_initialDualSolve(model.get());
  constexpr int kOptimal = 0, kInfeasible = 1;
  const int status = Clp_status(model.get());
  if (status == kInfeasible) return std::nullopt;
  if (status != kOptimal)
    throw std::runtime_error("Clp ended with status " + std::to_string(status) + " on " + std::to_string(m) + " x " +
                             std::to_string(n));
  const double* x = Clp_primalColumnSolution(model.get());
  std::vector<double> found(n);
  for (std::size_t k = 0; k < n; ++k) found[k] = x[k] / scale[k];
  return found;
}

}  // namespace clerestory
