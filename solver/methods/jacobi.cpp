#include "solver/methods/jacobi.h"

namespace clerestory {

Solution jacobi(const PatchSet& patches, const FormFactorMatrix& F, const Field& E_direct, const GatherOptions& options,
                const Monitor& monitor) {
  FullMatrixSystem system(patches, F, E_direct);
  std::vector<double> F_r(system.size());
  return system.iterate("jacobi", options, monitor, [&] {
    for (std::size_t k = 0; k < system.B.size(); ++k) {
      std::vector<double>& r = system.residual[k];
      system.gather_all(r, F_r);
      // The residual becomes r - w q, q = r - rho F r; least in the norm weighted by area at w = <r, q> / <q, q>.
      double r_q = 0, q_q = 0;
      for (std::size_t i = 0; i < system.size(); ++i) {
        const double q = r[i] - system.rho[k][i] * F_r[i] - system.passed(k, i, F_r);
        r_q += system.area[i] * r[i] * q, q_q += system.area[i] * q * q;
      }
      const double w = r_q > 0 && q_q > 0 ? r_q / q_q : 1;
      for (std::size_t i = 0; i < system.size(); ++i) {
        system.B[k][i] += w * r[i];
        system.FB[k][i] += w * F_r[i];
        r[i] -= w * (r[i] - system.rho[k][i] * F_r[i] - system.passed(k, i, F_r));
      }
    }
  });
}

}  // namespace clerestory
