#include "solver/methods/particles.h"

#include <atomic>
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "meshing/make_lightmap.h"
#include "solver/methods/path.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/joined_vertices.h"
#include "tests/support/many_lights.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

struct Room {
  PatchSet patches;
  RayScene rays{patches};
  Lights lights;
  Problem problem{patches, rays, lights};
  VertexLightmap map = make_lightmap(patches);
  explicit Room(PatchSet p) : patches(test::joined(std::move(p))) {}
};

/// Closed cube of 1 m whose surfaces are all alike: E = M / (1 - rho).
PatchSet furnace(double rho, double exitance) {
  PatchBuilder b(rho);
  b.material(rho, exitance).box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {6, 6, 6}, true);
  return b.build();
}

TEST(Particles, AFurnaceIsEvenWithinStandardErrorsThatAreHonest) {
  for (const double rho : {0.0, 0.5, 0.9}) {
    SCOPED_TRACE(rho);
    Room room(furnace(rho, 10));
    const Illumination light(room.problem);
    const Solution s = trace_particles(light, {.particles = 400}, &room.map);
    const double E = 10 / (1 - rho);
    const auto judge = [&](const Field& x, const Field& std_error, double share) {
      double chi2 = 0, mean = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        chi2 += std::pow((x[i][0] - E) / std_error[i][0], 2) / static_cast<double>(x.size());
        mean += x[i][0] / static_cast<double>(x.size());
        EXPECT_NEAR(x[i][0], E, 6 * std_error[i][0]);
      }
      EXPECT_NEAR(mean, E, share * E);
      // Of 32 batches the squared ratio has mean 31 / 29 and variance 2.6; neighbouring points share particles.
      EXPECT_NEAR(chi2, 31.0 / 29, 0.35);
    };
    judge(s.E, s.std_error, 0.01);
    judge(room.map.E, room.map.std_error, 0.01);
    EXPECT_NEAR(s.energy.emitted, 60, 1e-9);
    EXPECT_NEAR(s.energy.imbalance(), 0, 0.01);
    EXPECT_EQ(s.energy.escaped, 0);
  }
}

TEST(Particles, AFurnaceOfGlossIsEvenToo) {
  // What goes on by the lobe lands elsewhere: E = M / (1 - rho - specular) where the lobe's albedo is the same at all
  // angles, as that of GGX is.
  for (const double roughness : {0.1, 0.6}) {
    PatchBuilder b;
    b.glossy(0.3, {Spectrum(0.4), {}, roughness}, 10).box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {6, 6, 6}, true);
    Room room(b.build());
    const Solution s = trace_particles(Illumination(room.problem), {.particles = 1600}, &room.map);
    double mean = 0;
    for (std::size_t i = 0; i < s.E.size(); ++i) {
      EXPECT_NEAR(s.E[i][0], 10 / 0.3, 6 * s.std_error[i][0]) << roughness;
      mean += s.E[i][0] / static_cast<double>(s.E.size());
    }
    for (std::size_t p = 0; p < room.map.E.size(); ++p)
      EXPECT_NEAR(room.map.E[p][0], 10 / 0.3, 6 * room.map.std_error[p][0]) << roughness;
    EXPECT_NEAR(mean, 10 / 0.3, 0.01 * mean);
    EXPECT_NEAR(s.energy.imbalance(), 0, 0.01);
  }
}

TEST(Particles, ErrorFallsAsTheRootOfTheirNumber) {
  // Of patches, in a room that nothing makes even: a lamp in one corner.
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {6, 6, 6}, true);
  Room room(b.build());
  room.lights.luminaires.push_back({{"lamp", {0.5, 0.4, 1.7}, {}, PointLuminaire{Spectrum(100)}}});
  const Illumination light(room.problem);
  const Solution reference = trace_particles(light, {.particles = 8'000, .seed = 2});
  std::vector<double> x, y;
  for (const double particles : {100.0, 400.0, 1600.0}) {
    const Solution s = trace_particles(light, {.particles = particles, .seed = 3});
    double squares = 0, said = 0;
    for (std::size_t i = 0; i < room.patches.patch_count(); ++i) {
      squares += std::pow(s.E[i][0] - reference.E[i][0], 2) - std::pow(reference.std_error[i][0], 2);
      said += std::pow(s.std_error[i][0], 2);
    }
    EXPECT_NEAR(said / squares, 1, 0.25) << particles;
    x.push_back(std::log(static_cast<double>(s.iterations))), y.push_back(std::log(squares) / 2);
  }
  // 432 patches tell an rms to 3 %, the slope to 0.03; strata of the lamp's directions make it a little steeper.
  EXPECT_NEAR((y[2] - y[0]) / (x[2] - x[0]), -0.5, 0.08);
}

/// Every patch against paths from points all over it.
void expect_agreement(const Problem& problem, double particles, std::uint32_t paths_each) {
  const Illumination light(problem);
  const PatchSet& patches = problem.patches;
  const Solution s = trace_particles(light, {.particles = particles});
  double chi2 = 0, flux = 0, expected = 0, n = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    PathSum paths;
    const auto corners = patches.corner_positions(PatchId{i});
    unsigned long long rays = 0;
    for (std::uint32_t k = 0; k < paths_each; ++k) {
      const auto u = sobol4(k, stream_key(5, i));
      RandomStream random(stream_key(6, i, k));
      const Vec3 p = problem.rays.off_surface(point_on_triangle(corners, u[2], u[3]), patches.normal[i]);
      paths.add(trace_path(light, p, patches.normal[i], path_start({u[0], u[1]}, k, stream_key(7, i)), random, rays));
    }
    const double E = luminous_mean(paths.mean()),
                 error = std::hypot(luminous_mean(paths.std_error()), luminous_mean(s.std_error[i]));
    EXPECT_NEAR(luminous_mean(s.E[i]), E, 6 * error) << i;
    // Faces of 6 mm are met by a particle or none: that makes no normal distribution.
    if (patches.area[i] > 1e-3) chi2 += std::pow((luminous_mean(s.E[i]) - E) / error, 2), ++n;
    flux += patches.area[i] * luminous_mean(s.E[i]), expected += patches.area[i] * E;
  }
  EXPECT_NEAR(flux, expected, 0.02 * expected);
  EXPECT_LT(chi2 / n, 1.5);
  EXPECT_NEAR(s.energy.imbalance(), 0, 0.02);
}

TEST(Particles, AgreeWithPathsInARoomWithAllThatLightCanDo) {
  for (const int channels : {1, 3}) {
    SCOPED_TRACE(channels);
    expect_agreement(test::ManyLights(channels).problem, 4000, 300);
  }
}

TEST(Particles, AgreeWithPathsInAPolishedRoom) {
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 3, 3}, true);
  b.glossy(0.2, {Spectrum(0.5), 300, 1}).rectangle({0.01, 0.01, 0.01}, {3.98, 0, 0}, {0, 2.98, 0}, 4, 3);
  b.glossy(0.1, {Spectrum(0.6), {}, 0.2}).rectangle({0.01, 0.01, 0.02}, {0, 2.98, 0}, {0, 0, 2.4}, 3, 3);
  b.glass(0.8).rectangle({3.2, 0, 0.02}, {0, 3, 0}, {0, 0, 2.5});
  Room room(b.build());
  LightSpec lamps;
  for (const auto& [at, power] :
       {std::pair{Vec3{1, 1, 2}, 20.0}, {Vec3{2.5, 2, 1.2}, 10.0}, {Vec3{3.6, 1.5, 1.5}, 20.0}})
    lamps.luminaires.push_back({"lamp", at, {}, PointLuminaire{Spectrum(power)}});
  room.lights = place_lights(lamps, room.patches, room.rays);
  expect_agreement(room.problem, 8000, 500);
}

TEST(Particles, AreTheSameForAnyNumberOfThreads) {
  Room room(furnace(0.5, 10));
  const Illumination light(room.problem);
  set_thread_count(1);
  const Solution one = trace_particles(light, {.particles = 300}, &room.map);
  const Field E = room.map.E;
  set_thread_count(2);
  const Solution two = trace_particles(light, {.particles = 300}, &room.map);
  set_thread_count(0);
  EXPECT_EQ(one.E.value, two.E.value);
  EXPECT_EQ(one.energy.absorbed, two.energy.absorbed);
  EXPECT_EQ(E.value, room.map.E.value);
}

TEST(Particles, ARunThatIsStoppedHasFewerOfThemAndSaysSo) {
  Room room(furnace(0.5, 10));
  const Illumination light(room.problem);
  Monitor monitor;
  int reports = 0;
  std::atomic<bool> stop = false;
  monitor.progress = [&](std::string_view, double) { stop = ++reports > 6; };
  monitor.interrupted = [&] { return stop.load(); };
  const Solution s = trace_particles(light, {.particles = 2000}, &room.map, monitor);
  EXPECT_EQ(s.stop, StopReason::interrupted);
  EXPECT_GT(s.iterations, 0);
  EXPECT_LT(s.iterations, 2000 * static_cast<long>(room.patches.patch_count()) / 2);
  for (std::size_t i = 0; i < room.patches.patch_count(); ++i) EXPECT_NEAR(s.E[i][0], 20, 6 * s.std_error[i][0]);

  Monitor late;
  late.deadline = std::chrono::steady_clock::now();
  const Solution first = trace_particles(light, {.particles = 100'000}, &room.map, late);
  EXPECT_EQ(first.stop, StopReason::time_limit);
  EXPECT_NEAR(first.E[0][0], 20, 4);  // of the first round
}

TEST(Particles, WithoutLightThereIsNone) {
  Room room(furnace(0.5, 0));
  const Solution s = trace_particles(Illumination(room.problem), {}, &room.map);
  for (const double E : s.E.value) EXPECT_EQ(E, 0);
  for (const double E : room.map.E.value) EXPECT_EQ(E, 0);
  EXPECT_EQ(s.energy.imbalance(), 0);
}

}  // namespace
}  // namespace clerestory
