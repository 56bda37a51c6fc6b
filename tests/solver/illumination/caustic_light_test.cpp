// Caustics as direct light: closed forms of curved mirrors in the sun, gloss by other rays, parts that sum.

#include "solver/illumination/caustic_light.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/gloss_light.h"
#include "solver/illumination/place_lights.h"
#include "solver/lights/layers_of_times.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/run/solve.h"
#include "tests/support/curved_mirrors.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
constexpr double kPi = std::numbers::pi, kSunlight = 500, kReflectance = 0.9;

/// With the caustics of so many particles.
test::LitPatches lit(PatchSet patches, Lights lights, std::size_t particles, std::size_t legs_of_point) {
  test::LitPatches scene(std::move(patches), std::move(lights));
  scene.lights.caustics = find_caustics(scene.problem, particles, legs_of_point, 1);
  return scene;
}
Lights sun_at(const Vec3& direction) {
  Lights lights;
  lights.suns = {{{normalized(direction), Spectrum(kSunlight)}}};
  return lights;
}
double landed(const test::LitPatches& scene) {
  double sum = 0;
  each_landing(scene.problem, scene.lights.caustics.legs, [&](const CausticLanding& l) { sum += l.flux[0]; });
  return sum;
}

constexpr double kEnd = test::CylinderMirror::kEnd, kHeight = test::CylinderMirror::kHeight;
constexpr double kPerAngle = kReflectance * kSunlight / std::numbers::sqrt2;
PatchBuilder cylinder() { return test::cylinder_mirror(400, kReflectance); }
const double kAll = kPerAngle * kHeight * 2 * std::sin(kEnd);  // flux of all of them
/// Of one way to a place in the plane at height z: where it is, and what it brings.
struct OnPlane {
  Vec3 place;
  double E;
};
OnPlane on_plane(double a, double s, double z) {
  return {{-std::cos(a) + s * std::cos(2 * a), std::sin(a) - s * std::sin(2 * a), z},
          kPerAngle * std::cos(a) / std::abs(std::cos(a) - 2 * s)};
}

TEST(CausticLight, OfACylinderIsTheNephroidOfTheClosedFormOnTheFloorAndInTheAir) {
  const test::LitPatches scene = lit(cylinder().build(), sun_at({1, 0, 1}), 1 << 19, 1600);
  EXPECT_NEAR(landed(scene), kAll, 0.002 * kAll);
  // Away from the bright line, where another way may come, too, and from the ends of the light.
  std::vector<ReceivingPoint> points;
  std::vector<double> expected;
  for (const double z : {0.0, 0.1})
    for (const double a : {-25.0, -10.0, 5.0, 25.0})
      for (const double s : {0.1, 0.18, 0.26}) {
        const OnPlane at = on_plane(a * kPi / 180, s, z);
        points.push_back({at.place + Vec3{0, 0, z > 0 ? 0 : scene.rays.lift()}, {0, 0, 1}});
        expected.push_back(at.E);
      }
  const auto found = caustic_irradiance(scene.problem, points.size(), [&](std::size_t i) { return points[i]; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double sigma = std::sqrt(found.variance[i]);
    EXPECT_LT(sigma, 0.05 * expected[i]) << i;  // 1600 legs, as a pilot has it, under a kernel count as 1200
    EXPECT_NEAR(found.E[i][0], expected[i], 0.02 * expected[i] + sigma)
        << i;  // they are strata, and so have less noise
  }
  double mean = 0;  // what kernels blur would show here: noise is 1 %
  for (std::size_t i = 0; i < points.size(); ++i)
    mean += found.E[i][0] / expected[i] / static_cast<double>(points.size());
  EXPECT_NEAR(mean, 1, 0.01);
  // From below nothing comes, nor outside of the light.
  const auto none = caustic_irradiance(scene.problem, 2, [&](std::size_t i) {
    return i == 0 ? ReceivingPoint{{-0.8, 0, 0.05}, {0, 0, -1}} : ReceivingPoint{{1, 1, 1e-4}, {0, 0, 1}};
  });
  EXPECT_EQ(none.E[0][0], 0);
  EXPECT_EQ(none.E[1][0], 0);
}

TEST(CausticLight, BesideAPartitionIsWhatItIsThereAndNotHalf) {
  // On the line y = 0 light moves along x alone. A thin wall stands there.
  PatchBuilder b = cylinder();
  b.material(0).rectangle({-0.9, 0, 0}, {0.8, 0, 0}, {0, 0, 0.01}).rectangle({-0.9, 0, 0}, {0, 0, 0.01}, {0.8, 0, 0});
  const test::LitPatches scene = lit(b.build(), sun_at({1, 0, 1}), 1 << 19, 400);
  std::vector<ReceivingPoint> points;
  std::vector<double> expected;
  for (const double s : {0.12, 0.16, 0.2, 0.24, 0.28}) {
    const OnPlane at = on_plane(0, s, 0);
    points.push_back({at.place + Vec3{0, 1e-4, scene.rays.lift()}, {0, 0, 1}});
    expected.push_back(at.E);
  }
  const auto found = caustic_irradiance(scene.problem, points.size(), [&](std::size_t i) { return points[i]; });
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(found.E[i][0], expected[i], 0.03 * expected[i] + 3.5 * std::sqrt(found.variance[i])) << i;
}

TEST(CausticLight, OfAParaboloidGoesToItsFocus) {
  // As much as falls on a ring passes: E = rho E_sun r dr / (r' dr').
  constexpr double kDisc = test::Paraboloid::kDisc, kH = test::Paraboloid::kDiscHeight;
  const test::LitPatches scene = lit(test::paraboloid(100, 400, kReflectance).build(), sun_at({0, 0, 1}), 1 << 19, 400);
  const auto& passes_at = test::Paraboloid::passes_at;
  double rim = kDisc;  // of what meets the disc
  while (passes_at(rim) < kDisc) rim += 1e-6;
  const double all = kReflectance * kSunlight * kPi * (rim * rim - kDisc * kDisc);
  EXPECT_NEAR(landed(scene), all, 0.002 * all);
  for (const double r : {0.27, 0.31}) {
    const double step = 1e-5, passed = passes_at(r),
                 E = kReflectance * kSunlight * r * step /
                     (passed * (passes_at(r + step / 2) - passes_at(r - step / 2)));
    // Facets show as rings: the mean of eight places around.
    const auto found = caustic_irradiance(scene.problem, 8, [&](std::size_t i) {
      const double phi = 0.1 + 0.7 * static_cast<double>(i);
      return ReceivingPoint{{passed * std::cos(phi), passed * std::sin(phi), kH - scene.rays.lift()}, {0, 0, -1}};
    });
    double mean = 0;
    for (std::size_t i = 0; i < 8; ++i) mean += found.E[i][0] / 8;
    EXPECT_NEAR(mean, E, 0.02 * E + 3.5 * std::sqrt(found.variance[0] / 8)) << r;
  }
}

TEST(CausticLight, OfCurvedGlossIsWhatRaysAllAroundFindWithPatience) {
  // Lobes just narrow enough to be left to particles, in 80 planes.
  PatchBuilder b(0);
  b.rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
  b.glossy(0, {Spectrum(0.8), 60.0, 1});
  for (int k = 0; k < 80; ++k) {
    const auto at = [](int i) {
      const double a = kPi * i / 80;
      return Vec3{std::cos(a), std::sin(a), 0.3};
    };
    b.rectangle(at(k + 1), at(k) - at(k + 1), {0, 0, 0.6});
  }
  Lights lamps;
  lamps.luminaires = {test::point_lamp({0.1, 0.1, 1.2}, 100), test::point_lamp({0.4, -0.4, 0.9}, 60)};
  const PatchSet patches = b.build();
  const test::LitPatches scene = lit(patches, lamps, 1 << 17, 400), without(patches, lamps);
  ASSERT_EQ(scene.lights.caustics.sides.size(), 2u * 2 * 80);
  const GlossLight rest(scene.problem), all(without.problem);
  for (const Vec3& p : {Vec3{0, 0, 0.01}, Vec3{0.3, -0.2, 0.3}, Vec3{-0.4, 0.3, 0.2}}) {
    const double reference = all.irradiance(p, {0, 0, 1}, 1 << 17, 3).sum()[0];
    const auto caustics = caustic_irradiance(scene.problem, 1, [&](std::size_t) {
      return ReceivingPoint{p, {0, 0, 1}};
    });
    const double found = caustics.E[0][0] + rest.irradiance(p, {0, 0, 1}, 1 << 15, 5).sum()[0];
    EXPECT_GT(caustics.E[0][0], 0.05 * reference);
    EXPECT_NEAR(found, reference, 0.02 * reference + 3 * std::sqrt(caustics.variance[0])) << p.x;  // both have noise
  }
}

TEST(CausticLight, IsPartOfDirectLightAndOfItsRows) {
  Lights lights = sun_at({1, 0, 1});
  lights.luminaires = {test::point_lamp({0.5, 0, 1}, 50)};
  const test::LitPatches scene = lit(cylinder().build(), lights, 1 << 14, 100);
  test::LitPatches without = lit(cylinder().build(), lights, 1 << 14, 100);
  without.lights.caustics = {};
  DirectRows rows;
  const DirectLight with = direct_light(Illumination(scene.problem), {}, {}, &rows),
                    bare = direct_light(Illumination(without.problem), {});
  const Field caustics = caustics_on_patches(scene.problem, scene.lights.caustics.legs);
  double by_sun = 0;
  each_landing(scene.problem, scene.lights.caustics.legs, [&](const CausticLanding& l) {
    if (l.light == 1) by_sun += l.flux[0];
  });
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GT(caustics[i][0], 0);
    EXPECT_NEAR(with.E[i][0], bare.E[i][0] + caustics[i][0], 1e-9 * with.E[i][0]);
    double sum = 0;
    for (const RowEntry& e : rows.rows[i]) sum += double{e.weight[0]};
    EXPECT_NEAR(sum, with.E[i][0], 1e-5 * sum);  // floats
  }
  // The sun brings it in; the luminaire's own rays know its flux.
  EXPECT_GT(by_sun, 0);
  EXPECT_NEAR(with.energy.emitted - bare.energy.emitted, by_sun, 1e-6 * by_sun);
}

TEST(CausticLight, OfOneOfSeveralTimesIsThatOfItsSun) {
  Lights mean = sun_at({1, 0, 1});
  mean.suns.push_back(mean.suns.front());
  mean.times = 2;
  for (std::size_t t = 0; t < 2; ++t) mean.suns[t].time = t, mean.suns[t].normal_irradiance *= t == 0 ? 0.5 : 0.25;
  const test::LitPatches scene = lit(cylinder().build(), mean, 1 << 14, 100);
  for (std::size_t t = 0; t < 2; ++t) {
    double flux = 0;
    const Lights then = lights_at(scene.lights, t);
    for (const CausticLeg& leg : std::span<const CausticLeg>(then.caustics.legs)) {
      EXPECT_EQ(leg.light, 0u);
      flux += double{leg.flux[0]};
    }
    const double all = kAll * (t == 0 ? 1 : 0.5);
    EXPECT_NEAR(flux, all, 0.03 * all) << t;  // half of the particles choose either sun
  }
}

TEST(CausticLight, IsTheSameForAnyNumberOfThreads) {
  const auto run = [] {
    const test::LitPatches scene = lit(cylinder().build(), sun_at({1, 0, 1}), 1 << 14, 100);
    return caustic_irradiance(scene.problem, 50,
                              [&](std::size_t i) {
                                return ReceivingPoint{{-0.9 + 0.02 * static_cast<double>(i), 0.05, 0.02}, {0, 0, 1}};
                              })
        .E.value;
  };
  set_thread_count(1);
  const std::vector<double> one = run();
  set_thread_count(4);
  EXPECT_EQ(run(), one);
  set_thread_count(0);
}

class CausticOfMethod : public testing::TestWithParam<Method> {};

TEST_P(CausticOfMethod, IsThatOfParticlesThatKnowNoOtherWay) {
  // Half a ring of 100 facets and a lamp in a room: the light on the floor inside of the ring, much of it the caustic,
  // and on the ceiling, where a part of it goes on.
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {3, 0, 0}, {0, 1.5, 0}, 3, 2).rectangle({0, 2.2, 0}, {3, 0, 0}, {0, 0.8, 0}, 3, 1);
  b.rectangle({0, 1.5, 0}, {1, 0, 0}, {0, 0.7, 0}).rectangle({2, 1.5, 0}, {1, 0, 0}, {0, 0.7, 0});
  const std::size_t first = 2 * (6 + 3 + 2);
  b.rectangle({1, 1.5, 0}, {1, 0, 0}, {0, 0.7, 0}, 6, 4);
  const std::size_t end = first + 2 * 24;
  b.rectangle({0, 0, 2}, {0, 3, 0}, {3, 0, 0}, 3, 3);
  b.rectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 2}, 3, 2).rectangle({3, 0, 0}, {0, 0, 2}, {0, 3, 0}, 2, 3);
  b.rectangle({0, 0, 0}, {0, 0, 2}, {3, 0, 0}, 2, 3).rectangle({0, 3, 0}, {3, 0, 0}, {0, 0, 2}, 3, 2);
  b.mirror(0.9);
  const auto at = [](int k) {
    const double a = kPi * k / 100;
    return Vec3{1.5 + 0.5 * std::cos(a), 1.6 + 0.5 * std::sin(a), 0.001};
  };
  for (int k = 0; k < 100; ++k) b.rectangle(at(k), at(k + 1) - at(k), {0, 0, 0.3});
  LightSpec spec;
  spec.luminaires = {test::point_lamp({1.5, 0.7, 1.2}, 10)};
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights = place_lights(spec, patches, rays);
  const Problem problem{patches, rays, lights};
  SolveOptions options{.method = Method::particles, .accuracy = Accuracy::fine};
  const Solution reference = solve_on_patches(problem, options);
  lights.caustics = find_caustics(problem, 1 << 18, 800, 1);
  options.method = GetParam(), options.accuracy = Accuracy::standard;
  const bool by_elements = GetParam() == Method::hierarchical, by_paths = is_by_paths(GetParam());
  SolvedPatches solved;
  if (by_elements) {
    solved = solve(problem, test::unjoined_lightmap(patches), 1.0, options);
  } else {
    solved.solution = solve_on_patches(problem, options);
  }
  const PatchSet& elements = by_elements ? solved.elements : patches;
  const auto flux = [&](const PatchSet& set, const Field& E, bool on_ceiling) {
    double sum = 0;
    for (std::size_t i = 0; i < set.patch_count(); ++i) {
      const auto& [u, v, w] = set.corner_positions(PatchId{i});
      const Vec3 middle = (u + v + w) / 3;
      const bool counts = on_ceiling
                              ? middle.z > 1.999
                              : middle.z < 1e-9 && std::abs(middle.x - 1.5) < 0.5 && middle.y > 1.5 && middle.y < 2.2;
      if (counts) sum += set.area[i] * E[i][0];
    }
    return sum;
  };
  const double noise = by_paths ? 0.04 : 0.02;  // paths: 2 % from seed to seed on so few patches
  for (const bool on_ceiling : {false, true}) {
    const double expected = flux(patches, reference.E, on_ceiling);
    EXPECT_NEAR(flux(elements, solved.solution.E, on_ceiling), expected, noise * expected) << on_ceiling;
  }
  double caustic = 0;
  const Field E = caustics_on_patches(problem, lights.caustics.legs);
  for (std::size_t i = first; i < end; ++i) caustic += E[i][0] * patches.area[i];
  EXPECT_GT(caustic, 0.2 * flux(patches, reference.E, false));
  const EnergyBalance& energy = solved.solution.energy;
  EXPECT_NEAR(energy.absorbed + energy.escaped, energy.emitted, noise * energy.emitted);
}
INSTANTIATE_TEST_SUITE_P(Methods, CausticOfMethod,
                         testing::Values(Method::hierarchical, Method::progressive, Method::path,
                                         Method::bidirectional),
                         [](const auto& m) { return std::string(kMethodNames[static_cast<std::size_t>(m.param)]); });

TEST(CausticLight, PlaneMirrorsHaveNone) {
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).mirror(0.9).rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const test::LitPatches scene = lit(b.build(), sun_at({1, 0, 1}), 1 << 10, 100);
  EXPECT_TRUE(scene.lights.caustics.sides.empty());
  EXPECT_TRUE(scene.lights.caustics.legs.empty());
}

}  // namespace
}  // namespace clerestory
