#include "solver/methods/gauss_seidel.h"

#include <algorithm>

#include "solver/model/parallel.h"

namespace clerestory {

Solution gauss_seidel(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct,
                      const GatherOptions& options, const Monitor& monitor) {
  // Rows are taken in blocks: what comes from outside a block is gathered for all its rows in parallel, then the
  // block's own part row by row. The order of updates is that of the textbook, so the result does not depend on
  // threads.
  constexpr std::size_t kBlock = 256;
  FullMatrixSystem system(patches, F, E_direct);
  const std::size_t n = system.size();
  std::vector<double> outside(kBlock);
  return system.iterate("gauss-seidel", options, monitor, [&] {
    for (std::size_t k = 0; k < system.B.size(); ++k) {
      std::vector<double>& B = system.B[k];
      for (std::size_t first = 0; first < n; first += kBlock) {
        const std::size_t last = std::min(n, first + kBlock);
        parallel_for(last - first, 16, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = first + begin; i < first + end; ++i)
            outside[i - first] = system.gather(i, B, 0, first) + system.gather(i, B, last, n);
        });
        for (std::size_t i = first; i < last; ++i)
          B[i] = system.source[k][i] + system.rho[k][i] * (outside[i - first] + system.gather(i, B, first, last)) +
                 system.passed_of(k, i, B);
      }
    }
    system.update_irradiance();
    system.update_residual();
  });
}

}  // namespace clerestory
