#include "solver/paths/path_balance.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

/// A path x_0 ... x_m with its light, every density at random.
struct Path {
  std::vector<PathPart> parts;  ///< parts[i - 1] leads from x_(i-1) to x_i
  PathEnd end;

  Path(std::size_t m, std::uint64_t seed) {
    RandomStream random(seed, m);
    const auto density = [&] { return std::exp(6 * random.uniform() - 3); };
    for (std::size_t i = 0; i < m; ++i) parts.push_back({density(), density(), random.uniform() < 0.7});
    end = {density(), density(), density()};
  }
  /// Density of reaching x_i from the receiver.
  double from_eye(std::size_t i) const {
    double product = 1;
    for (std::size_t k = 0; k < i; ++k) product *= parts[k].from_eye;
    return product;
  }
  /// Density of all that joins x_(i-1) and x_i.
  double joined(std::size_t i) const {
    if (!parts[i - 1].can_join) return 0;
    double product = from_eye(i - 1) * end.from_light;
    for (std::size_t k = i; k < parts.size(); ++k) product *= parts[k].from_light;
    return product;
  }
};

TEST(PathBalance, WeightsAreEachWaysShareOfTheDensityOfAll) {
  for (std::size_t m = 0; m < 7; ++m)
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const Path path(m, seed);
      double all = path.from_eye(m) * (path.end.met + path.end.shadow_ray);
      for (std::size_t i = 1; i <= m; ++i) all += path.joined(i);

      std::vector<double> before{0}, beyond(m + 1);
      for (const PathPart& part : path.parts) before.push_back(joints_before(part, before.back()));
      beyond[m] = path.end.beyond();
      for (std::size_t i = m; i > 0; --i) beyond[i - 1] = joints_beyond(path.parts[i - 1], beyond[i]);

      EXPECT_NEAR(path.end.all(before[m]) * path.from_eye(m) / all, 1, 1e-12);
      for (std::size_t i = 1; i <= m; ++i) {
        if (!path.parts[i - 1].can_join) continue;
        EXPECT_NEAR(weight_of_joint(path.parts[i - 1], before[i - 1], beyond[i]) * all / path.joined(i), 1, 1e-12);
      }
    }
}

}  // namespace
}  // namespace clerestory
