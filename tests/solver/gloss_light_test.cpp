// Light by way of glossy surfaces: closed forms, quadrature, and all methods against each other.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/illumination/illumination.h"
#include "solver/model/units.h"
#include "solver/paths/path_tracer.h"
#include "solver/run/solve.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
constexpr double kPi = std::numbers::pi;

Gloss phong(double specular, double exponent) { return {Spectrum(specular), exponent, 1}; }
Gloss ggx(double specular, double roughness) { return {Spectrum(specular), {}, roughness}; }

/// A glossy floor of 2 a by 2 a at z = 0, black otherwise.
PatchSet floor_of(const Gloss& gloss, double a) {
  return PatchBuilder(0).glossy(0, gloss).rectangle({-a, -a, 0}, {2 * a, 0, 0}, {0, 2 * a, 0}).build();
}

double by_gloss(const PatchSet& patches, const Lights& lights, const Vec3& p, const Vec3& n, int count) {
  const RayScene rays(patches);
  const Problem problem{patches, rays, lights};
  return GlossLight(problem).irradiance(p, n, count, 7).sum()[0];
}

TEST(GlossLight, NarrowLobesShowALampAsAMirrorDoes) {
  Lights lights;
  lights.luminaires = {test::point_lamp({0, 0, 2}, 4 * kPi)};  // 1 W/sr
  const Vec3 sensor{1.5, 0, 1};
  const double d2 = 1.5 * 1.5 + 3 * 3, cosine = 3 / std::sqrt(d2);
  const double as_mirror = 0.8 * cosine / d2;
  EXPECT_NEAR(by_gloss(floor_of(ggx(0.8, 0.05), 20), lights, sensor, {0, 0, -1}, 256), as_mirror, 0.01 * as_mirror);
  // The albedo of a narrow Phong lobe is the cosine's share of what it is at normal incidence.
  EXPECT_NEAR(by_gloss(floor_of(phong(0.8, 1e5), 20), lights, sensor, {0, 0, -1}, 256), as_mirror * cosine,
              0.01 * as_mirror);
  EXPECT_EQ(by_gloss(floor_of(phong(0.8, 1e5), 20), lights, sensor, {0, 0, 1}, 256), 0);
}

TEST(GlossLight, NarrowLobesShowTheSunAsAMirrorDoes) {
  Lights lights;
  const double elevation = 40 * kPi / 180;
  lights.suns = {{Sun{{std::cos(elevation), 0, std::sin(elevation)}, Spectrum(100.0)}}};
  const double as_mirror = 0.8 * 100 * std::sin(elevation);
  for (const double roughness : {0.02, 0.1})
    EXPECT_NEAR(by_gloss(floor_of(ggx(0.8, roughness), 200), lights, {0, 0, 2}, {0, 0, -1}, 256), as_mirror,
                0.02 * as_mirror)
        << roughness;
}

TEST(GlossLight, WideLobesGiveWhatTheirValuesSumTo) {
  Lights lights;
  lights.luminaires = {test::point_lamp({0, 0, 2}, 4 * kPi), test::point_lamp({-1, 1, 0.7}, 2 * kPi)};
  const Vec3 sensor{0.6, -0.4, 1}, n = normalized({0.3, 0.2, -1});
  constexpr double kHalf = 3;
  for (const Gloss& gloss : {phong(0.5, 0), phong(0.5, 8), phong(0.5, 120), ggx(0.5, 0.3), ggx(0.5, 0.9)}) {
    const Lobe lobe(gloss);
    const Vec3 up{0, 0, 1};
    double E = 0;
    constexpr int kCells = 600;
    const double cell = 2 * kHalf / kCells;
    for (int i = 0; i < kCells; ++i)
      for (int j = 0; j < kCells; ++j) {
        const Vec3 x{-kHalf + (i + 0.5) * cell, -kHalf + (j + 0.5) * cell, 0}, to = normalized(sensor - x);
        const double kernel = std::max(0.0, -dot(n, to)) * to.z / dot(sensor - x, sensor - x) * cell * cell;
        if (!(kernel > 0)) continue;
        for (const PlacedLuminaire& lamp : lights.luminaires) {
          const Vec3 way = lamp.position - x, d = normalized(way);
          E += kernel * lobe.evaluate(up, d, to)[0] * test::as_point(lamp).power[0] / (4 * kPi) * d.z / dot(way, way);
        }
      }
    EXPECT_NEAR(by_gloss(floor_of(gloss, kHalf), lights, sensor, n, 4096), E, 0.02 * E)
        << (gloss.exponent ? "exponent " : "roughness ") << gloss.exponent.value_or(gloss.roughness);
  }
}

class EveryMethod : public testing::TestWithParam<Method> {};

PatchSet furnace() {
  return PatchBuilder(0)
      .glossy(0.3, ggx(0.4, 0.3), 100)
      .box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 3, 3}, true)
      .build();
}

TEST_P(EveryMethod, HasOneRadianceInAFurnaceOfGloss) {
  const PatchSet patches = furnace();
  const RayScene rays(patches);
  const Lights lights;
  SolveOptions options;
  options.method = GetParam(), options.accuracy = Accuracy::draft, options.check_laws = true;
  const SolvedPatches solved = solve({patches, rays, lights}, test::unjoined_lightmap(patches), 1.0, options);
  const PatchSet& elements = solved.elements.patch_count() > 0 ? solved.elements : patches;
  const double expected = 100 / (1 - 0.3 - 0.4);
  // Corners of this mesh lie in the corners of the room, where a point knows no side.
  std::vector<double> E = solved.solution.E.value;
  std::ranges::nth_element(E, E.begin() + static_cast<long>(E.size() / 2));
  EXPECT_NEAR(E[E.size() / 2], expected, 0.01 * expected);
  for (const LawCheck& law : solved.laws) {
    if (law.law == Law::row_sums) {
      EXPECT_TRUE(law.holds());
    }
  }
  const EnergyBalance& energy = solved.solution.energy;
  EXPECT_NEAR(energy.emitted, 100 * elements.total_area(), 1e-6 * energy.emitted);
  // 32,768 particles that land three times know it to a half of a percent.
  const double tolerance = GetParam() == Method::particles ? 0.03 : 0.01;
  EXPECT_NEAR(energy.absorbed, energy.emitted, tolerance * energy.emitted);
  EXPECT_NEAR(energy.escaped, 0, 1e-6 * energy.emitted);
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod,
                         testing::Values(Method::hierarchical, Method::progressive, Method::gauss_seidel,
                                         Method::jacobi, Method::path, Method::bidirectional, Method::particles),
                         [](const auto& m) {
                           std::string name(kMethodNames[static_cast<std::size_t>(m.param)]);
                           std::erase(name, '-');
                           return name;
                         });

TEST(Gloss, PathsFromMetalToMetalHaveAnHonestSpread) {
  // Most light goes over a lobe, many times: E = M / (1 - rho - specular), 50 times what is emitted.
  const PatchSet patches = PatchBuilder(0)
                               .glossy(0.03, ggx(0.95, 0.4), 100)
                               .box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {1, 1, 1}, true)
                               .build();
  const RayScene rays(patches);
  const Lights lights;
  const Problem problem{patches, rays, lights};
  unsigned long long count = 0;
  const PathEstimate E = trace_paths_at_point(Illumination(problem), {1, 1, 1}, {0, 0, 1}, 5, 4096, count);
  EXPECT_NEAR(E.E[0], 5000, 4 * E.std_error[0] + 1);
  EXPECT_LT(E.std_error[0], 500);  // paths of 50 surfaces
}

TEST(Gloss, GathersAgreeWithPathsInAPolishedRoom) {
  // Floor and one wall are polished, so that light of the lamps goes over both; a third lamp is behind a pane.
  PatchBuilder builder(0.5);
  builder.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {4, 3, 3}, true);
  builder.glossy(0.2, phong(0.5, 300)).rectangle({0.01, 0.01, 0.01}, {3.98, 0, 0}, {0, 2.98, 0}, 4, 3);
  builder.glossy(0.1, ggx(0.6, 0.2)).rectangle({0.01, 0.01, 0.02}, {0, 2.98, 0}, {0, 0, 2.4}, 3, 3);
  builder.glass(0.8).rectangle({3.2, 0, 0.02}, {0, 3, 0}, {0, 0, 2.5});
  const PatchSet patches = builder.build();
  const RayScene rays(patches);
  Lights lights;
  lights.luminaires = {test::point_lamp({1, 1, 2}, 20), test::point_lamp({2.5, 2, 1.2}, 10),
                       test::point_lamp({3.6, 1.5, 1.5}, 20)};
  const Problem problem{patches, rays, lights};
  SolveOptions options;
  options.method = Method::gauss_seidel;
  const Solution solution = solve_on_patches(problem, options);
  for (const SensorPoint& at : {SensorPoint{{2, 1.5, 2.4}, {0, 0, -1}}, SensorPoint{{3, 2.8, 1}, {0, -1, 0}},
                                SensorPoint{{1, 1, 1}, {0, 0, 1}}, SensorPoint{{3.9, 1, 1}, {-1, 0, 0}}}) {
    const double gathered = irradiance_at_sensors(problem, solution, {&at, 1}, options).E[0][0];
    unsigned long long count = 0;
    const PathEstimate paths = trace_paths_at_point(Illumination(problem), at.position, at.normal, 3, 8192, count);
    EXPECT_NEAR(gathered, paths.E[0], 4 * paths.std_error[0] + 0.03 * paths.E[0]) << at.position.x;
    EXPECT_LT(paths.std_error[0], 0.05 * paths.E[0]);
  }
}

}  // namespace
}  // namespace clerestory
