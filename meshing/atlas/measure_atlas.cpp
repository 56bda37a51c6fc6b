#include "meshing/atlas/measure_atlas.h"

#include <algorithm>
#include <cmath>

#include "solver/model/parallel.h"

namespace clerestory {

namespace {

/// Shares of area by error, in steps of a tenth of a percent of its logarithm's size: finer than anybody asks.
class Histogram {
 public:
  void add(double error, double area) {
    const double place = error > kLeast ? std::log(error / kLeast) * kStepsPerE : 0;
    area_[std::min(static_cast<std::size_t>(place), area_.size() - 1)] += area;
  }
  void add(const Histogram& other) {
    for (std::size_t i = 0; i < area_.size(); ++i) area_[i] += other.area_[i];
  }
  double share_below(double error) const {
    const auto end = static_cast<std::size_t>(std::log(error / kLeast) * kStepsPerE);
    double below = 0;
    for (std::size_t i = 0; i < end; ++i) below += area_[i];
    return all() > 0 ? below / all() : 1;
  }
  double quantile(double share) const {
    double sum = 0;
    const double wanted = share * all();
    for (std::size_t i = 0; i < area_.size(); ++i)
      if ((sum += area_[i]) >= wanted) return i == 0 ? 0 : kLeast * std::exp((static_cast<double>(i) + 1) / kStepsPerE);
    return 0;
  }

 private:
  static constexpr double kLeast = 1e-6, kStepsPerE = 100;
  double all() const {
    double sum = 0;
    for (const double a : area_) sum += a;
    return sum;
  }
  std::vector<double> area_ = std::vector<double>(2500, 0.0);
};

}  // namespace

AtlasError measure_atlas(const WrittenResult& result, const Field& value, const LightmapAtlas& atlas) {
  std::vector<double> darkest(result.surfaces.size(), 0.0);
  for (std::size_t t = 0; t < result.triangles.size(); ++t)
    for (const std::uint32_t p : result.triangles[t])
      darkest[result.surface[t]] = std::max(darkest[result.surface[t]], 1e-3 * value.at(p, 0));

  struct Found {
    Histogram histogram;
    double worst = 0;
    std::uint32_t surface = 0;
    Vec3 place;
  };
  constexpr std::size_t kBlock = 4096;
  std::vector<Found> blocks((result.triangles.size() + kBlock - 1) / kBlock);
  parallel_for(blocks.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t block = from; block < to; ++block)
      for (std::size_t t = block * kBlock; t < std::min(result.triangles.size(), (block + 1) * kBlock); ++t) {
        Found& found = blocks[block];
        const auto& points = result.triangles[t];
        const auto& uv = atlas.uv[t];
        const std::array<Vec3, 3> corner{result.points[points[0]], result.points[points[1]], result.points[points[2]]};
        const auto error_at = [&](double a, double b, double c) {
          const auto mix = [&](std::size_t k) {
            return static_cast<float>(a * uv[0][k] + b * uv[1][k] + c * uv[2][k]);
          };
          const double f = a * value.at(points[0], 0) + b * value.at(points[1], 0) + c * value.at(points[2], 0);
          const double difference = std::abs(atlas.lookup(mix(0), mix(1), 0) - f);
          if (difference == 0) return 0.0;
          const double error = difference / std::max({f, darkest[result.surface[t]], 1e-30});
          if (error > found.worst) {
            found.worst = error, found.surface = result.surface[t];
            found.place = corner[0] * a + corner[1] * b + corner[2] * c;
          }
          return error;
        };
        // Points that halve each edge often enough: evenly over the triangle, at the middles of its parts and of
        // theirs.
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto& a = uv[k];
          const auto& b = uv[(k + 1) % 3];
          longest =
              std::max(longest, std::hypot(double{a[0] - b[0]} * atlas.width, double{a[1] - b[1]} * atlas.height));
        }
        const int parts = std::clamp(static_cast<int>(std::ceil(1.4 * longest)), 1, 1000);
        const double area =
            length(cross(corner[1] - corner[0], corner[2] - corner[0])) / 2 / (double{1} * parts * parts);
        for (int i = 0; i < parts; ++i)
          for (int j = 0; j < parts - i; ++j) {
            found.histogram.add(error_at((i + 1. / 3) / parts, (j + 1. / 3) / parts, (parts - i - j - 2. / 3) / parts),
                                area);
            if (i + j + 1 < parts)
              found.histogram.add(
                  error_at((i + 2. / 3) / parts, (j + 2. / 3) / parts, (parts - i - j - 4. / 3) / parts), area);
          }
        for (int i = 0; i < parts; ++i) {
          const double s = static_cast<double>(i) / parts;
          error_at(1 - s, s, 0), error_at(0, 1 - s, s), error_at(s, 0, 1 - s);
        }
      }
  });
  Histogram all;
  AtlasError error;
  for (const Found& found : blocks) {
    all.add(found.histogram);
    if (found.worst > error.worst)
      error.worst = found.worst, error.worst_surface = found.surface, error.worst_place = found.place;
  }
  error.share_within_1_percent = all.share_below(0.01);
  error.p95 = all.quantile(0.95), error.p99 = all.quantile(0.99);
  return error;
}

}  // namespace clerestory
