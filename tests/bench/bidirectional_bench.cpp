// Paths from both ends against paths from the receiver: at points all over the lit surfaces of a scene, or those of a
// file, whether they agree, and how much longer the one takes for the error of the other. Prints one CSV row a scene.
//   bidirectional_bench SECONDS SCENE[:POINTS.csv] ...

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "io/read_scene.h"
#include "io/read_sensors.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/paths/bidirectional.h"
#include "solver/sampling/unit_square.h"
#include "tests/bench/bare_problem.h"

namespace clerestory {
namespace {

constexpr std::size_t kPoints = 64;
constexpr int kPaths = 32;  ///< of a replicate

/// Of a point, in rounds of independent replicates of stratified paths [lx].
struct Mean {
  double sum = 0, squares = 0, count = 0;

  void add(double x) { sum += x, squares += x * x, ++count; }
  double mean() const { return sum / count; }
  /// Of the mean.
  double variance() const { return (squares / count - mean() * mean()) / (count - 1); }
};

struct Judged {
  std::vector<Mean> at;
  double seconds = 0;  ///< of CPU

  double mean() const {
    double sum = 0;
    for (const Mean& m : at) sum += m.mean();
    return sum / static_cast<double>(at.size());
  }
  /// Mean over the points.
  double variance() const {
    double sum = 0;
    for (const Mean& m : at) sum += m.variance();
    return sum / static_cast<double>(at.size());
  }
};

/// One thread, until its time is up, and sixteen rounds at least.
Judged judge(const PathEstimator& estimator, const std::vector<ReceivingPoint>& points, std::uint64_t seed,
             double seconds) {
  Judged judged{std::vector<Mean>(points.size())};
  const std::clock_t start = std::clock();
  unsigned long long rays = 0;
  for (std::uint64_t round = 0; round < 16 || judged.seconds < seconds; ++round) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::uint64_t key = stream_key(seed, i, round);
      judged.at[i].add(photometric(
          trace_replicate(estimator, points[i].p, points[i].n, key, 0, kPaths * static_cast<int>(kReplicates), rays)));
    }
    judged.seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }
  return judged;
}

/// Even over the area of all patches.
std::vector<ReceivingPoint> points_on(const Problem& problem) {
  const PatchSet& patches = problem.patches;
  std::vector<ReceivingPoint> points;
  RandomStream random(19, 1);
  while (points.size() < kPoints) {
    double left = random.uniform() * patches.total_area();
    std::size_t i = 0;
    for (; i + 1 < patches.patch_count() && left >= patches.area[i]; ++i) left -= patches.area[i];
    const double u = random.uniform(), v = random.uniform();
    const Vec3 n = patches.normal[i];
    points.push_back({problem.rays.off_surface(point_on_triangle(patches.corner_positions(PatchId{i}), u, v), n), n});
  }
  return points;
}

void compare(const std::string& argument, double seconds) {
  const std::size_t colon = argument.find(':');
  const Scene scene = read_scene(argument.substr(0, colon));
  const BareProblem bare(scene);
  const Problem& problem = bare.problem;
  const PatchSet& patches = problem.patches;
  const RayScene& rays = problem.rays;
  std::vector<ReceivingPoint> points;
  if (colon == argument.npos) {
    points = points_on(problem);
  } else {
    const std::vector<SensorPoint> sensors = read_sensors(argument.substr(colon + 1)).points;
    for (std::size_t k = 0; k < std::min(kPoints, sensors.size()); ++k) {
      const SensorPoint& s = sensors[k * sensors.size() / std::min(kPoints, sensors.size())];
      points.push_back({rays.beside_surfaces(s.position - patches.origin, s.normal), s.normal});
    }
  }

  const Illumination light(problem);
  const Bidirectional bidirectional(light);
  const Judged one = judge(light, points, 1, seconds), both = judge(bidirectional.estimator(), points, 2, seconds);
  double chi2 = 0, difference = 0, of_difference = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double d = both.at[i].mean() - one.at[i].mean(), v = both.at[i].variance() + one.at[i].variance();
    if (v > 0) chi2 += d * d / v;
    difference += d, of_difference += v;
  }
  const auto n = static_cast<double>(points.size());
  std::printf("%s,%zu,%.5g,%.5g,%.2f,%.2f,%.3g,%.3g,%.3g\n", argument.c_str(), points.size(), one.mean(), both.mean(),
              difference / std::sqrt(std::max(of_difference, 1e-300)), chi2 / n, std::sqrt(one.variance()) / one.mean(),
              std::sqrt(both.variance()) / both.mean(),
              one.variance() * one.seconds / (both.variance() * both.seconds));
  std::fflush(stdout);
}

}  // namespace
}  // namespace clerestory

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: bidirectional_bench SECONDS SCENE[:POINTS.csv] ...\n";
    return 1;
  }
  clerestory::set_thread_count(1);
  std::puts("scene,points,path_lx,bidirectional_lx,sigmas,chi2,path_error,bidirectional_error,times_faster");
  try {
    for (int k = 2; k < argc; ++k) clerestory::compare(argv[k], std::stod(argv[1]));
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 1;
  }
}
