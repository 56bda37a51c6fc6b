#include "solver/model/sky_shape.h"

#include <array>
#include <cstddef>

namespace clerestory {

SkyShape cie_general_shape(int type) {
  struct Row {
    double a, b, c, d, e;
  };
  constexpr std::array<Row, 15> kTable{{{4.0, -0.70, 0, -1.0, 0.00},
                                        {4.0, -0.70, 2, -1.5, 0.15},
                                        {1.1, -0.80, 0, -1.0, 0.00},
                                        {1.1, -0.80, 2, -1.5, 0.15},
                                        {0.0, -1.00, 0, -1.0, 0.00},
                                        {0.0, -1.00, 2, -1.5, 0.15},
                                        {0.0, -1.00, 5, -2.5, 0.30},
                                        {0.0, -1.00, 10, -3.0, 0.45},
                                        {-1.0, -0.55, 2, -1.5, 0.15},
                                        {-1.0, -0.55, 5, -2.5, 0.30},
                                        {-1.0, -0.55, 10, -3.0, 0.45},
                                        {-1.0, -0.32, 10, -3.0, 0.45},
                                        {-1.0, -0.32, 16, -3.0, 0.30},
                                        {-1.0, -0.15, 16, -3.0, 0.30},
                                        {-1.0, -0.15, 24, -2.8, 0.15}}};
  const Row& row = kTable.at(static_cast<std::size_t>(type - 1));
  // f(90 degrees) = 1: the standard subtracts the exponential there.
  return {row.a, row.b, 1 - row.c * std::exp(row.d * std::numbers::pi / 2), row.c, row.d, row.e};
}

SkyShape cie_clear_shape() { return {-1, -0.32, 0.91, 10, -3, 0.45}; }

}  // namespace clerestory
