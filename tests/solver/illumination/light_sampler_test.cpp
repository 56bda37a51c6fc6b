#include "solver/illumination/light_sampler.h"

#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/geometry/polygon.h"
#include "solver/lights/luminaire.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using Lit = test::LitPatches;
constexpr double kPi = std::numbers::pi;

struct Place {
  Vec3 p, n;
};

Vec3 anywhere(RandomStream& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

/// Glowing triangles of sizes 0.01 to 0.3 and powers over 1e4 all over the unit cube, and a large dark floor under it.
PatchSet swarm(std::size_t count) {
  PatchBuilder b(0.5);
  b.rectangle({-50, -50, -1}, {101, 0, 0}, {0, 101, 0});
  RandomStream random(7, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i < 5) b.material(0.5, std::pow(10.0, static_cast<double>(i)));
    const Vec3 at = anywhere(random);
    const double size = 0.01 * std::pow(30.0, random.uniform());
    const auto corner = [&] { return at + (anywhere(random) - Vec3{0.5, 0.5, 0.5}) * size; };
    const Vec3 c0 = corner(), c1 = corner(), c2 = corner();
    b.triangle(c0, c1, c2);
  }
  return b.build();
}

/// Receivers in and around the unit cube and far off.
std::vector<Place> places(std::size_t count) {
  std::vector<Place> result;
  RandomStream random(3, 3);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = anywhere(random) * 2.0 - Vec3{0.5, 0.5, 0.5};
    const double u = random.uniform(), v = random.uniform();
    result.push_back({p, sphere_direction(u, v)});
  }
  result.push_back({{0.5, 0.5, 30}, {0, 0, -1}});
  result.push_back({{0.5, 0.5, -0.9}, {0, 0, 1}});
  return result;
}

/// Exact irradiance of all glowing patches at p, nothing blocking: a triangle is cut at p's horizon, and gives nothing
/// to what is behind it.
double exact_irradiance(const PatchSet& patches, const Place& at) {
  double E = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const auto c = patches.corner_positions(PatchId{i});
    if (patches.M[i].is_black() || dot(patches.normal[i], at.p - c[0]) <= 0) continue;
    const ClippedTriangle above = clip_to_front(c, HalfSpace::through(at.p, at.n), 0);
    E += patches.M[i][0] * point_to_polygon(at.p, at.n, above.corners());
  }
  return E;
}

struct Mean {
  double value = 0, std_error = 0;
};

/// Mean of f(k) over `count` independent samples.
template <class F>
Mean mean(int count, const F& f) {
  double sum = 0, squares = 0;
  for (int k = 0; k < count; ++k) {
    const double x = f(k);
    sum += x, squares += x * x;
  }
  const double value = sum / count;
  return {value, std::sqrt(std::max(0.0, squares / count - value * value) / count)};
}

LightSample draw(const LightSampler& sampler, const Place& at, RandomStream& random, bool bright_patches_only) {
  const double pick = random.uniform(), u = random.uniform(), v = random.uniform();
  return sampler.sample(sampler.receiver(at.p, at.n), pick, u, v, bright_patches_only);
}

TEST(LightTree, ProbabilitiesSumToOneWhereverLightCanReach) {
  for (const std::size_t count : {1u, 2u, 5u, 100u, 10'000u}) {
    const PatchSet patches = swarm(count);
    std::vector<LightBounds> lights;
    for (std::size_t i = 2; i < patches.patch_count(); ++i) {
      const auto c = patches.corner_positions(PatchId{i});
      Vec3 lower = c[0], upper = c[0];
      for (const Vec3& x : c) {
        lower = {std::min(lower.x, x.x), std::min(lower.y, x.y), std::min(lower.z, x.z)};
        upper = {std::max(upper.x, x.x), std::max(upper.y, x.y), std::max(upper.z, x.z)};
      }
      lights.push_back({lower, upper, patches.normal[i], 0, patches.M[i][0] * patches.area[i]});
    }
    const LightTree tree(lights, Falloff::cosine, 100);
    int reached = 0;
    for (const Place& at : places(20)) {
      double sum = 0;
      for (std::uint32_t l = 0; l < lights.size(); ++l) sum += tree.probability(l, {tree, at.p, at.n});
      // A node may promise light that none of its children then has: what is left over is nobody's.
      EXPECT_LE(sum, 1 + 1e-9);
      if (sum == 0) continue;
      ++reached;
      double wasted = 0;
      constexpr int kPicks = 4096;
      for (int k = 0; k < kPicks; ++k)
        wasted += tree.choose({tree, at.p, at.n}, (k + 0.5) / kPicks).probability == 0 ? 1.0 / kPicks : 0.0;
      // Equal steps of pick in each light's interval: off by less than a step each side of the few gaps.
      EXPECT_NEAR(sum + wasted, 1, 0.01 * (1 + (count > 100 ? 1 : 0))) << count;
    }
    EXPECT_GT(reached, count > 2 ? 10 : 2);
  }
}

TEST(LightTree, AReceiverThatWasAskedAllThingsAnswersLikeAFreshOne) {
  std::vector<LightBounds> lights;
  RandomStream random(4);
  for (int k = 0; k < 2000; ++k) {  // far more nodes than a receiver keeps
    const Vec3 p{10 * random.uniform(), 10 * random.uniform(), 10 * random.uniform()};
    lights.push_back({p, p, {0, 0, -1}, 0, 1 + random.uniform()});
  }
  const LightTree tree(lights, Falloff::cosine, 10);
  for (const Place& at : places(3)) {
    const LightTree::Receiver asked(tree, at.p, at.n);
    for (int round = 0; round < 2; ++round)
      for (std::uint32_t l = 0; l < lights.size(); ++l) {
        const std::uint32_t light = (l * 997u) % 2000u;
        ASSERT_EQ(tree.probability(light, asked), tree.probability(light, {tree, at.p, at.n}));
        const double pick = (l + 0.5) / 2000;
        const LightTree::Choice one = tree.choose(asked, pick), other = tree.choose({tree, at.p, at.n}, pick);
        ASSERT_EQ(one.light, other.light);
        ASSERT_EQ(one.probability, other.probability);
      }
  }
}

TEST(LightTree, DoesNotAskWhatIsOutOfReach) {
  // Lights in two rooms side by side, each of which reaches its own only.
  std::vector<LightBounds> lights;
  RandomStream random(7);
  for (std::uint32_t k = 0; k < 200; ++k) {
    const double room = k % 2;
    const Vec3 p{10 * (room + random.uniform()), 10 * random.uniform(), 3};
    lights.push_back({p, p, {0, 0, -1}, 0, 1 + random.uniform(), Box{{10 * room, 0, 0}, {10 * room + 10, 10, 3}}});
  }
  const LightTree tree(lights, Falloff::cosine, 20);
  for (const double x : {9.5, 10.5}) {
    const LightTree::Receiver at(tree, {x, 5, 1}, {0, 0, 1});
    double sum = 0;
    for (std::uint32_t l = 0; l < lights.size(); ++l) {
      const double probability = tree.probability(l, at);
      EXPECT_EQ(probability > 0, (l % 2 == 1) == (x > 10)) << "room of light " << l;
      sum += probability;
      const LightTree::Choice choice = tree.choose(at, (l + 0.5) / 200);
      if (choice.probability > 0) {
        EXPECT_DOUBLE_EQ(choice.probability, tree.probability(choice.light, at));
      }
    }
    EXPECT_GT(sum, 0.5);
    EXPECT_LE(sum, 1 + 1e-6);
  }
  EXPECT_FALSE(tree.reaches({30, 5, 1}, {0, 0, 1}));
}

TEST(LightTree, ChoosesAsOftenAsItSays) {
  const PatchSet patches = swarm(100);
  const Lit lit(patches);
  int judged = 0;
  for (const Place& at : places(20)) {
    std::map<std::size_t, int> chosen;
    RandomStream random(5, 5);
    constexpr int kDraws = 100'000;
    double chi_square = 0;
    int classes = 0;
    for (int k = 0; k < kDraws; ++k)
      if (const LightSample s = draw(lit.sampler, at, random, true); s.patch.valid()) ++chosen[s.patch];
    for (std::size_t i = 2; i < patches.patch_count(); ++i) {
      const auto c = patches.corner_positions(PatchId{i});
      bool whole = dot(patches.normal[i], at.p - c[0]) > 0;
      for (const Vec3& x : c) whole = whole && dot(at.n, x - at.p) > 0;
      if (!whole) continue;  // samples of half-hidden patches are not all valid
      const double distance = 1, cos_q = 1;
      const double expected = kDraws * patches.area[i] *
                              lit.sampler.density(PatchId{i}, lit.sampler.receiver(at.p, at.n), distance, cos_q, true);
      if (expected < 10) continue;
      chi_square += std::pow(chosen[i] - expected, 2) / expected;
      ++classes;
    }
    if (classes < 3) continue;
    ++judged;
    // Mean k, variance 2 k for k classes: 5 sigma.
    EXPECT_LT(chi_square, classes + 5 * std::sqrt(2.0 * classes));
  }
  EXPECT_GT(judged, 8);
}

TEST(LightSampler, DensityIsTheOneOfTheSampleThatWasDrawn) {
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({0.2, 0.3, 0.4}, 20));
  lights.suns.push_back({{normalized({0.3, -0.5, 0.8}), Spectrum(2)}});
  for (const std::size_t count : {1u, 30u, 3000u}) {
    const Lit lit(swarm(count), lights);
    RandomStream random(9, 9);
    int found = 0;
    for (const Place& at : places(40))
      for (int k = 0; k < 50; ++k) {
        const bool bright_patches_only = k % 2 == 0;
        const LightSample s = draw(lit.sampler, at, random, bright_patches_only);
        if (!s.patch.valid()) continue;
        ++found;
        const Vec3 normal = lit.patches.normal[s.patch];
        const double lifted = dot(normal, s.end - lit.patches.corner_positions(s.patch)[0]);
        const Vec3 d = s.end - normal * lifted - at.p;
        const double cos_q = -dot(normal, normalized(d));
        const double density =
            lit.sampler.density(s.patch, lit.sampler.receiver(at.p, at.n), length(d), cos_q, bright_patches_only);
        EXPECT_NEAR(density / s.density, 1, 1e-9 / cos_q) << count;
      }
    EXPECT_GT(found, count == 1 ? 20 : 300);
  }
}

TEST(LightSampler, OneOverTheDensityIsTheSolidAngleOnAverage) {
  // A square of side 2 h at height h fills a sixth of the sphere.
  PatchBuilder b(0.5);
  b.rectangle({-50, -50, -1}, {100, 0, 0}, {0, 100, 0}).material(0.5, 10);
  b.rectangle({-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, 4, 4);
  const Lit lit(b.build());
  RandomStream random(1, 2);
  const Place at{{0, 0, 0}, {0, 0, 1}};
  const Mean m = mean(100'000, [&](int) { return 1 / draw(lit.sampler, at, random, true).density; });
  EXPECT_NEAR(m.value, 4 * kPi / 6, 4 * m.std_error);
  EXPECT_LT(m.std_error, 0.01);
}

TEST(LightSampler, IrradianceIsExactOnAverageWithOneLightAndWithManyNearAndFar) {
  for (const std::size_t count : {1u, 10u, 1000u, 10'000u}) {
    const Lit lit(swarm(count));
    for (const Place& at : places(12)) {
      const double exact = exact_irradiance(lit.patches, at);
      RandomStream random(4, count);
      const Mean m = mean(20'000, [&](int) { return draw(lit.sampler, at, random, true).irradiance[0]; });
      EXPECT_NEAR(m.value, exact, 5 * m.std_error + 1e-9)
          << count << " lights, at " << at.p.x << ' ' << at.p.y << ' ' << at.p.z;
    }
  }
}

TEST(LightSampler, WithABundleIrradianceIsExactOnAverageTouchingAndGrazing) {
  // A glowing wall of 200 triangles with a strip of lamps on the floor before it; a sample of each kind, weighted by
  // the balance heuristic, has no spikes where receiver and light touch.
  PatchBuilder b(0.5);
  b.rectangle({-50, -50, -1}, {100, 0, 0}, {0, 100, 0});
  b.material(0.5, 10).rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 10, 10);
  b.material(0.5, 300).rectangle({0.5, 0.2, 0}, {0.05, 0, 0}, {0, 0.6, 0}, 1, 20);
  const Lit lit(b.build());
  const double lift = lit.rays.lift();
  const std::vector<Place> wanted{{{lift, 0.5, lift}, {0, 0, 1}},
                                  {{0.01, 0.51, 0.001}, {0, 0, 1}},
                                  {{0.3, 0.5, lift}, {0, 0, 1}},
                                  {{lift, 0.5, 0.3}, {1, 0, 0}},
                                  {{0.52, 0.5, 0.001}, {0, 0, -1}},
                                  {{0.52, 0.5, 0.01}, {0, 1, 0}},
                                  {{2, 0.4, 0.01}, normalized({-1, 0, 30})},
                                  {{40, 0.4, 0.01}, {0, 0, 1}},
                                  {{0.001, 1.01, 0.5}, {0, -1, 0}},
                                  {{5, 0.5, 3}, {0, 0, -1}}};
  for (const Place& at : wanted) {
    const double exact = exact_irradiance(lit.patches, at);
    RandomStream random(4, 4);
    const Frame frame(at.n);
    const Mean m = mean(100'000, [&](int) {
      double E = 0;
      if (const LightSample s = draw(lit.sampler, at, random, true); s.density > 0) {
        const double bundle = dot(at.n, normalized(s.end - lit.patches.normal[s.patch] * lift - at.p)) / kPi;
        if (bundle > 0) E += s.irradiance[0] * s.density / (s.density + bundle);
      }
      const double u = random.uniform(), v = random.uniform();
      const Vec3 d = cosine_direction(frame, u, v);
      const Hit hit = lit.rays.first_hit(lit.patches, {at.p, d});
      if (hit.patch.valid() && lit.sampler.is_bright(hit.patch)) {
        const double bundle = dot(at.n, d) / kPi, cos_q = -dot(lit.patches.normal[hit.patch], d);
        const double lamp = lit.sampler.density(hit.patch, lit.sampler.receiver(at.p, at.n), hit.distance, cos_q, true);
        E += lit.patches.M[hit.patch][0] * bundle / (bundle + lamp);
      }
      return E;
    });
    // Rays start in float: the bundle errs by 1e-4 where the light begins a lift away.
    EXPECT_NEAR(m.value, exact, 4 * m.std_error + 2e-4 * exact) << at.p.x << ' ' << at.p.y << ' ' << at.p.z;
    EXPECT_LT(m.std_error, 0.02 * exact + 1e-9);
  }
}

TEST(LightSampler, NothingThatCanLightTheReceiverHasNoChance) {
  const Lit lit(swarm(300));
  RandomStream random(2, 2);
  int pairs = 0;
  for (const Place& at : places(200))
    for (std::size_t i = 2; i < lit.patches.patch_count(); ++i) {
      const Vec3 x = point_on_triangle(lit.patches.corner_positions(PatchId{i}), random.uniform(), random.uniform());
      if (point_kernel(at.p, at.n, x, lit.patches.normal[i]) == 0) continue;
      ++pairs;
      const double r = length(x - at.p), cos_q = dot(lit.patches.normal[i], at.p - x) / r;
      ASSERT_GT(lit.sampler.density(PatchId{i}, lit.sampler.receiver(at.p, at.n), r, cos_q, true), 0);
    }
  EXPECT_GT(pairs, 10'000);
}

TEST(LightSampler, LampsOfTheNextRoomTakeFewRaysFromTheOneOverhead) {
  // A street of 100 lamps of one power, 10 m apart: the one 1 m above has 98 % of the light. By flux it had 1 % of the
  // rays, and a spread a hundred times larger.
  PatchBuilder b(0.5);
  b.rectangle({-5, -5, 0}, {1000, 0, 0}, {0, 10, 0}).material(0.5, 10);
  for (int i = 0; i < 100; ++i) b.rectangle({10.0 * i, 0, 1}, {0, 0.1, 0}, {0.1, 0, 0});
  const Lit lit(b.build());
  RandomStream random(6, 6);
  const Place at{{500, 0, 0}, {0, 0, 1}};
  int overhead = 0;
  for (int k = 0; k < 1000; ++k) {
    const LightSample s = draw(lit.sampler, at, random, true);
    overhead += s.patch.valid() && std::abs(s.end.x - 500) < 1;
  }
  EXPECT_GT(overhead, 900);
}

TEST(LightSampler, PatchesLampsSpotsAndSunsTogetherAreExactOnAverage) {
  Lights lights;
  RandomStream random(8, 8);
  for (int i = 0; i < 30; ++i) {
    const Vec3 here = anywhere(random) * 3;
    lights.luminaires.push_back(test::point_lamp(here, 1 + 10 * random.uniform()));
    const Vec3 axis = sphere_direction(random.uniform(), random.uniform());
    const Vec3 there = anywhere(random) * 3;
    lights.luminaires.push_back(test::spot_lamp(there, axis, 5, 0.2, 0.2 + random.uniform()));
  }
  lights.suns.push_back({{normalized({0.3, -0.5, 0.8}), Spectrum(2)}});
  lights.suns.push_back({{normalized({-0.3, -0.5, -0.8}), Spectrum(3)}});
  const Lit lit(swarm(20), lights);
  for (const Place& at : places(15)) {
    double exact = exact_irradiance(lit.patches, at), sharp = 0;
    for (const Luminaire& lamp : lights.luminaires) sharp += open_irradiance(lamp, at.p, at.n)[0];
    for (const Sun& sun : lights.suns) sharp += sun.normal_irradiance[0] * std::max(0.0, dot(at.n, sun.direction));
    exact += sharp;
    const Mean m = mean(40'000, [&](int) { return draw(lit.sampler, at, random, false).irradiance[0]; });
    EXPECT_NEAR(m.value, exact, 5 * m.std_error + 2e-5 * exact);  // the sun's rim stands 0.27 degrees off
  }
}

TEST(LightSampler, SmallLightsAreTheSumOfWhatIsNotInShadow) {
  // Forty-one lamps and a spot, every third one behind a wall: packets must count each once.
  PatchBuilder b(0.5);
  b.rectangle({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}).rectangle({-50, 20, 1}, {100, 0, 0}, {0, 0, 50});
  Lights lights;
  for (int i = 0; i < 41; ++i)
    lights.luminaires.push_back(test::point_lamp({i - 20.0, i % 3 == 0 ? 30.0 : 10.0, 3.0}, 50 + i));
  lights.luminaires.push_back(test::spot_lamp({0, 0, 4}, {0, 0, -1}, 100, 0.4, 0.6));
  lights.suns.push_back({{normalized({0, -0.5, 0.8}), Spectrum(20)}});
  const Lit lit(b.build(), lights);
  const Place at{{0.5, 0.2, lit.rays.lift()}, {0, 0, 1}};
  double exact = 20 * lights.suns[0].direction.z;
  for (const Luminaire& lamp : lights.luminaires)
    if (lamp.position.y < 20) exact += open_irradiance(lamp, at.p, at.n)[0];
  EXPECT_NEAR(lit.sampler.delta_light(at.p, at.n, {.sun_rays = 64}, 1)[0], exact, 1e-5 * exact);  // the sun is a disc
}

TEST(LightSampler, BrightPatchesAreThoseOverFourTimesTheMedianOfTheArea) {
  PatchBuilder b(0.5);
  b.material(0.5, 10).rectangle({0, 0, 0}, {6, 0, 0}, {0, 1, 0});
  b.material(0.5, 1).rectangle({0, 2, 0}, {4, 0, 0}, {0, 1, 0}, 10, 10);  // many and small: 40 % of the area
  b.material(0.5, 39.9).rectangle({0, 4, 0}, {0.1, 0, 0}, {0, 1, 0});
  b.material(0.5, 40.1).rectangle({0, 6, 0}, {0.1, 0, 0}, {0, 1, 0});
  const Lit lit(b.build());
  for (std::size_t i = 0; i < lit.patches.patch_count(); ++i)
    EXPECT_EQ(lit.sampler.is_bright(PatchId{i}), lit.patches.M[i][0] > 40) << i;
}

}  // namespace
}  // namespace clerestory
