// Progressive shooting and path tracing in a closed room with two blocks and an area lamp 12 mm under the ceiling.
// Prints one CSV row a figure: what, value, unit, bar.

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "solver/methods/path.h"
#include "solver/methods/progressive.h"
#include "solver/model/parallel.h"
#include "solver/paths/path_tracer.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void row(const char* what, double value, const char* unit, const char* bar) {
  std::printf("%s,%.4g,%s,%s\n", what, value, unit, bar);
}

/// `cells` along the room's longest side.
PatchSet lamp_room(std::size_t cells) {
  test::PatchBuilder b(0.5);
  const std::size_t n = cells, block = cells / 4;
  b.box({0, 0, 0}, {5.5, 0, 0}, {0, 4.5, 0}, {0, 0, 2.8}, {n, n * 9 / 11, n / 2}, true);
  b.box({1.2, 1.0, 0.1}, {0.955, 0.296, 0}, {-0.355, 1.146, 0}, {0, 0, 1.9}, {block, block, block}, false);
  b.box({3.6, 2.3, 0.3}, {1.221, -0.446, 0}, {0.309, 0.845, 0}, {0, 0, 0.8}, {block, block, block}, false);
  b.material(0.5, 100).rectangle({2.3, 1.9, 2.788}, {0, 0.7, 0}, {0.9, 0, 0}, 4, 4);
  return b.build();
}

/// What a reference costs: relative standard error of irradiance at a point after a millisecond of one core, over the
/// room. CPU time, so that a busy machine does not show.
void reference_at_points() {
  const PatchSet patches = lamp_room(28);
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Illumination light(problem);
  double variance = 0, mean = 0, points = 0;
  unsigned long long traced = 0;
  const std::clock_t start = std::clock();
  for (std::size_t i = 0; i < patches.patch_count(); i += patches.patch_count() / 97 + 1, ++points) {
    const auto corner = patches.corner_positions(PatchId{i});
    const Vec3 p = (corner[0] + corner[1] + corner[2]) / 3 + patches.normal[i] * rays.lift();
    const PathEstimate e = trace_paths_at_point(light, p, patches.normal[i], stream_key(77, i), 1024, traced);
    variance += std::pow(e.std_error[0], 2), mean += e.E[0];
  }
  const double ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  row("path: standard error of a point after 1 ms of a core", 100 * std::sqrt(variance * ms) / mean, "%", "");
}

int run() {
  reference_at_points();
  const PatchSet patches = lamp_room(55);
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Illumination light(problem);
  row("patches of the room", static_cast<double>(patches.patch_count()), "1", "");

  const auto shoot_once = [&](int threads, double& time) {
    set_thread_count(threads);
    const double start = seconds();
    const DirectLight dark = direct_light(light, {});
    Solution s = shoot(problem, dark, measure_closure(problem, 64, 1), {.stop_fraction = 1e-2});
    time = seconds() - start;
    return s;
  };
  double one = 0, two = 0, again = 0;
  shoot_once(2, two);  // warm-up
  const Solution s = shoot_once(2, two);
  shoot_once(1, one);
  shoot_once(2, again);
  row("progressive: unshot at the end", s.residual, "1", "0.01");
  row("progressive: time on two threads", std::min(two, again), "s", "5");
  row("progressive: two threads against one", one / std::min(two, again), "1", "1.7");
  row("progressive: rays", static_cast<double>(s.rays) * 1e-6, "million", "");

  set_thread_count(2);
  DirectLight none_direct;
  none_direct.E = Field(patches.patch_count(), 1);
  const double start = seconds();
  const Solution reference = path_trace(light.problem, light, "path", none_direct, measure_closure(problem, 64, 1),
                                        {.paths = 1024, .seed = 7});
  const double path_time = seconds() - start;
  double difference = 0, noise = 0, mean = 0, area = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double a = patches.area[i], d = s.E[i][0] - reference.E[i][0];
    difference += a * d * d, noise += a * std::pow(reference.std_error[i][0], 2);
    mean += a * reference.E[i][0], area += a;
  }
  mean /= area;
  row("progressive: rms difference of patches to path", 100 * std::sqrt(difference / area) / mean, "%", "5");
  row("path: standard error in that difference (upper bound)", 100 * std::sqrt(noise / area) / mean, "%", "");
  row("path: a bounce and a shadow ray, each core", 2 * path_time * 1e6 / (static_cast<double>(reference.rays) / 2),
      "us", "1.5");
  return 0;
}

}  // namespace
}  // namespace clerestory

int main() { return clerestory::run(); }
