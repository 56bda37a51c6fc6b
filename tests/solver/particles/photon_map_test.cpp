#include "solver/particles/photon_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "meshing/make_lightmap.h"
#include "solver/model/parallel.h"
#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "tests/support/joined_vertices.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/send_photons.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
using Neighbours = std::vector<PhotonMap::Neighbour>;
constexpr std::array kAll{ParticleWay::straight, ParticleWay::turned, ParticleWay::scattered};

/// Thick in one corner, thin elsewhere, many in one plane, some in one place.
std::vector<Landing> cloud(std::size_t count) {
  RandomStream random(3, count);
  std::vector<Landing> landings(count);
  for (std::size_t k = 0; k < count; ++k) {
    Landing& l = landings[k];
    for (float& x : l.position) x = static_cast<float>(std::pow(random.uniform(), 3));
    if (k % 3 == 0) l.position[2] = 0;
    if (k % 7 == 0) l.position = {0.5f, 0.25f, 0};
    l.flux = {1, 1, 1}, l.patch = static_cast<std::uint32_t>(k % 2),
    l.direction_and_way = static_cast<std::uint32_t>(k);
  }
  return landings;
}

float distance2(const Landing& l, const Vec3& p) {
  const float dx = l.position[0] - static_cast<float>(p.x), dy = l.position[1] - static_cast<float>(p.y),
              dz = l.position[2] - static_cast<float>(p.z);
  return dx * dx + dy * dy + dz * dz;
}

TEST(PhotonMap, FindsTheNearestThatASearchOfAllFinds) {
  RandomStream random(4, 4);
  Neighbours found;
  for (const std::size_t size : {0u, 1u, 7u, 15u, 16u, 17u, 100u, 1000u, 30'000u}) {
    const std::vector<Landing> landings = cloud(size);
    const PhotonMap map(landings);
    ASSERT_EQ(map.size(), size);
    for (const std::size_t count : {1u, 5u, 100u, 2000u})
      for (const double radius : {0.03, 0.3, 1e9})
        for (int k = 0; k < 10; ++k) {
          const Vec3 p{random.uniform(), random.uniform(), k % 2 == 0 ? 0 : random.uniform()};
          const bool some = k % 3 == 0;
          const auto counts = [&](const Landing& l) { return !some || l.patch == 0; };
          const double within = map.nearest(p, radius, count, found, counts);
          std::vector<float> all, d2;
          for (const Landing& l : landings)
            if (counts(l) && distance2(l, p) < static_cast<float>(std::min(radius * radius, 1e38)))
              all.push_back(distance2(l, p));
          std::ranges::sort(all);
          if (all.size() > count) all.resize(count);
          std::set<std::uint32_t> different;
          for (const auto& at : found) {
            d2.push_back(at.distance2), different.insert(at.photon);
            EXPECT_EQ(at.distance2, distance2(map[at.photon], p));
          }
          std::ranges::sort(d2);
          ASSERT_EQ(d2, all) << size << ' ' << count << ' ' << radius;
          EXPECT_EQ(different.size(), found.size());
          EXPECT_EQ(within, all.size() < count ? radius * radius : double{all.back()});
        }
  }
}

TEST(PhotonMap, HoldsEveryLandingOnceAndTheSameForAnyNumberOfThreads) {
  const std::vector<Landing> landings = cloud(20'000);
  const auto order = [&](int threads) {
    set_thread_count(threads);
    const PhotonMap map(landings);
    std::vector<std::uint32_t> names;
    for (std::size_t k = 0; k < map.size(); ++k) names.push_back(map[k].direction_and_way);
    return names;
  };
  std::vector<std::uint32_t> one = order(1);
  const std::vector<std::uint32_t> two = order(2);
  set_thread_count(0);
  EXPECT_EQ(one, two);
  std::ranges::sort(one);
  for (std::uint32_t k = 0; k < one.size(); ++k) ASSERT_EQ(one[k], k);
}

/// A lamp over a floor, beside a mirror that stands on it; a pane over a part of it; a wall opposite the mirror.
struct Corner {
  static PatchSet patches() {
    PatchBuilder b(0.5);
    b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 2, 2).rectangle({2, 0, 0}, {0, 0, 2}, {0, 2, 0});
    b.mirror(0.9).rectangle({0, 0, 0}, {0, 2, 0}, {0, 0, 2});
    return b.build();
  }
  static Lights lights() {
    Lights l;
    l.luminaires.push_back(test::point_lamp({0.5, 1, 1}, 100));
    return l;
  }
  test::LitPatches scene{patches(), lights()};
  Illumination light{scene.problem};
};

TEST(Photons, AreOfTheWaysThatWereAskedForAndTogetherAllLight) {
  const Corner corner;
  constexpr std::size_t kParticles = 200'000;
  const std::vector<Landing> all = test::send_photons(corner.light, kParticles, kAll, 1);
  double flux[3] = {0, 0, 0};
  for (const Landing& l : all) flux[static_cast<int>(l.way())] += double{l.flux[0]};
  for (const ParticleWay way : kAll) {
    double alone = 0;
    for (const Landing& l : test::send_photons(corner.light, kParticles, std::array{way}, 1)) {
      EXPECT_EQ(l.way(), way);
      alone += double{l.flux[0]};
    }
    EXPECT_NEAR(alone, flux[static_cast<int>(way)], 1e-9 * alone);
  }
  // Straight from the lamp, and by the mirror from its image 0.5 m behind it: to what is seen of floor and wall from
  // there, by a rule of points. No more than 200,000 sqrt(0.1) particles know each to 0.5 %.
  const auto to = [&](const Vec3& lamp, double share) {
    constexpr int kGrid = 400;
    double sum = 0;
    for (int i = 0; i < kGrid; ++i)
      for (int j = 0; j < kGrid; ++j) {
        const double u = 2 * (i + 0.5) / kGrid, v = 2 * (j + 0.5) / kGrid;
        for (const auto& [x, n] : {std::pair{Vec3{u, v, 0}, Vec3{0, 0, 1}}, {Vec3{2, v, u}, Vec3{-1, 0, 0}}}) {
          const Vec3 d = lamp - x;
          if (share < 1) {  // over the mirror, which ends at z = 2 and y = 0, 2
            const double t = x.x / (x.x - lamp.x);
            const Vec3 on = x + d * t;
            if (on.y < 0 || on.y > 2 || on.z < 0 || on.z > 2) continue;
          }
          sum += share * 100 / (4 * std::numbers::pi) * dot(d, n) / std::pow(dot(d, d), 1.5) * 4 / (kGrid * kGrid);
        }
      }
    return sum;
  };
  EXPECT_NEAR(flux[0], to({0.5, 1, 1}, 1), 0.01 * flux[0]);
  EXPECT_NEAR(flux[1], to({-0.5, 1, 1}, 0.9), 0.01 * flux[1]);
  EXPECT_GT(flux[2], 0.1 * flux[0]);
}

TEST(Photons, ComeFromWhereTheirDirectionSays) {
  const Corner corner;
  for (const Landing& l :
       test::send_photons(corner.light, 2000, std::array{ParticleWay::straight, ParticleWay::turned}, 1)) {
    const Vec3 x{double{l.position[0]}, double{l.position[1]}, double{l.position[2]}};
    const Vec3 lamp{l.way() == ParticleWay::straight ? 0.5 : -0.5, 1, 1};
    EXPECT_LT(length(normalized(lamp - x) - l.direction()), 3e-4);  // packed to 1e-4
  }
}

TEST(Photons, TellTheIrradianceAroundAPoint) {
  PatchBuilder b(0);
  b.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 4, 4).rectangle({-1, -1, 0.01}, {0, 2, 0}, {0, 0, 1});
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({0, 0, 1}, 4 * std::numbers::pi * 10));
  const test::LitPatches scene(test::joined(b.build()), std::move(lights));
  const Illumination light(scene.problem);
  const PhotonMap map(test::send_photons(light, 1'000'000, kAll, 1));
  const VertexLightmap points = make_lightmap(scene.patches);
  const SmoothSurface surface(scene.patches, points);
  PhotonsAround room;
  const auto at = [&](const Vec3& p, double radius) {
    const Hit below = scene.rays.first_hit(scene.patches, {p + Vec3{0, 0, 0.005}, {0, 0, -1}});
    return irradiance(map, surface, p, below.patch, 1000, radius, room)[0];
  };
  // E = 10 (1 + r^2)^(-3/2). A disc of 1000 landings has a radius of 0.06 m; weighted they are worth 750. At an edge
  // and in a corner they lie farther away, and a slope counts.
  for (const Vec3& p : {Vec3{0, 0, 0}, Vec3{0.3, 0, 0}, Vec3{0.7, 0, 0}, Vec3{0.2, 0.999, 0}, Vec3{0.999, -0.999, 0}}) {
    const double E = 10 * std::pow(1 + p.x * p.x + p.y * p.y, -1.5);
    const bool at_edge = std::abs(p.y) > 0.9;
    EXPECT_NEAR(at(p, 1), E, (at_edge ? 12 : 4) * E / std::sqrt(750.0)) << p.x << " " << p.y;
  }
  EXPECT_EQ(at({0, 0, 0}, 1e-6), 0);
  EXPECT_EQ(irradiance(PhotonMap(), surface, {0, 0, 0}, PatchId{0}, 1000, 1, room)[0], 0);
}

TEST(Photons, OfTheOtherSideOfAPartitionTellNothing) {
  // A wall without thickness stands across the floor, the lamp on one side of it.
  PatchBuilder b(0);
  b.rectangle({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}, 4, 8).rectangle({0, -1, 0}, {1, 0, 0}, {0, 2, 0}, 4, 8);
  b.rectangle({0, -1, 0}, {0, 2, 0}, {0, 0, 2}, 8, 8);
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({0.5, 0, 1}, 4 * std::numbers::pi * 10));
  const test::LitPatches scene(test::two_sided(test::joined(b.build())), std::move(lights));
  const Illumination light(scene.problem);
  const PhotonMap map(test::send_photons(light, 300'000, std::array{ParticleWay::straight}, 1));
  const VertexLightmap points = make_lightmap(scene.patches);
  const SmoothSurface surface(scene.patches, points);
  PhotonsAround room;
  for (const double x : {-0.01, 0.01}) {
    const Hit below = scene.rays.first_hit(scene.patches, {{x, 0.05, 0.005}, {0, 0, -1}});
    const double E = x < 0 ? 0 : 10 * std::pow(1 + std::pow(0.5 - x, 2) + 0.05 * 0.05, -1.5);
    EXPECT_NEAR(irradiance(map, surface, {x, 0.05, 0}, below.patch, 1000, 0.2, room)[0], E, 0.4 + 0.1 * E) << x;
  }
}

}  // namespace
}  // namespace clerestory
