#include "solver/model/random_stream.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace clerestory {
namespace {

TEST(Sobol4, EveryPrefixOfAPowerOfTwoHasOnePointInEachSlab) {
  // The property that makes it worth having: in each dimension, 2^k points fall one into each of 2^k equal slabs.
  for (const std::uint64_t key : {1ULL, 77ULL, 0xdeadbeefcafeULL})
    for (const std::size_t n : {16u, 256u, 1024u})
      for (std::size_t dim = 0; dim < 4; ++dim) {
        std::set<std::size_t> slabs;
        for (std::size_t i = 0; i < n; ++i)
          slabs.insert(
              static_cast<std::size_t>(sobol4(static_cast<std::uint32_t>(i), key)[dim] * static_cast<double>(n)));
        EXPECT_EQ(slabs.size(), n) << "dimension " << dim << ", key " << key;
      }
}

TEST(Sobol4, FirstTwoDimensionsFillEveryElementaryRectangle) {
  const std::size_t n = 256;
  for (std::size_t columns = 1; columns <= n; columns *= 2) {
    std::set<std::size_t> cells;
    for (std::size_t i = 0; i < n; ++i) {
      const auto u = sobol4(static_cast<std::uint32_t>(i), 5);
      cells.insert(static_cast<std::size_t>(u[0] * static_cast<double>(columns)) * n +
                   static_cast<std::size_t>(u[1] * static_cast<double>(n / columns)));
    }
    EXPECT_EQ(cells.size(), n) << columns << " columns";
  }
}

TEST(Sobol4, IntegratesASmoothFunctionFasterThanRandomNumbers) {
  // The product of 2 u_k has integral 1 and standard deviation 1.47; 1,024 independent points would err by 0.046.
  double worst = 0;
  for (std::uint64_t key = 0; key < 20; ++key) {
    double sum = 0;
    for (std::uint32_t i = 0; i < 1024; ++i) {
      const auto u = sobol4(i, stream_key(9, key));
      sum += 16 * u[0] * u[1] * u[2] * u[3];
    }
    worst = std::max(worst, std::abs(sum / 1024 - 1));
  }
  EXPECT_LT(worst, 0.046 / 4);
}

TEST(RandomStream, IsUniformAndDiffersBetweenKeys) {
  double sum = 0;
  constexpr int kCount = 100'000;
  RandomStream random(1, 2, 3);
  for (int i = 0; i < kCount; ++i) sum += random.uniform();
  EXPECT_NEAR(sum / kCount, 0.5, 4 * 0.2887 / std::sqrt(kCount));
  EXPECT_NE(RandomStream(1, 2, 3).bits(), RandomStream(1, 3, 2).bits());
  EXPECT_EQ(RandomStream(1, 2, 3).bits(), RandomStream(1, 2, 3).bits());
}

}  // namespace
}  // namespace clerestory
