#include "solver/particles/surface_kernels.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "meshing/make_lightmap.h"
#include "solver/particles/emission.h"
#include "tests/support/joined_vertices.h"
#include "tests/support/lit_patches.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::joined;
using test::PatchBuilder;
constexpr KernelShape kShapes[] = {KernelShape::constant, KernelShape::cone, KernelShape::epanechnikov};

/// Landings on a fine even grid over every patch, as particles of irradiance E(x) would spread.
LandingsByPatch even_landings(const PatchSet& patches, const std::function<double(const Vec3&)>& E, int cells = 24) {
  std::vector<ParticleWays> ways(1);
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const auto [a, b, c] = patches.corner_positions(PatchId{i});
    for (int row = 0; row < cells; ++row)
      for (int k = 0; k <= 2 * row; ++k) {  // triangle k of the row: upwards, downwards, and so on
        const double third = k % 2 == 0 ? 2.0 / 3 : 1.0 / 3;
        const double u = (row + third) / cells, v = (k / 2 + (k % 2 == 0 ? 1.0 / 3 : 2.0 / 3)) / cells;
        const Vec3 x = a + (b - a) * (u - v) + (c - a) * v;
        const auto flux = static_cast<float>(E(x) * patches.area[i] / (cells * cells));
        ways[0].landings.push_back({{static_cast<float>(x.x), static_cast<float>(x.y), static_cast<float>(x.z)},
                                    {flux, flux, flux},
                                    static_cast<std::uint32_t>(i),
                                    0});
      }
  }
  LandingsByPatch landings;
  landings.sort(ways, patches.patch_count());
  return landings;
}

std::uint32_t point_at(const VertexLightmap& map, const Vec3& x, const PatchSet& patches, const Vec3& normal) {
  for (std::uint32_t p = 0; p < map.position.size(); ++p)
    if (length(map.position[p] - x) < 1e-9 && dot(patches.normal[map.patch_of_point[p]], normal) > 0.9) return p;
  throw std::logic_error("no point there");
}

TEST(SurfaceKernels, SecondMomentsAreThoseOfTheTextbooks) {
  EXPECT_NEAR(second_moment(KernelShape::constant), 1.0 / 4, 1e-15);
  EXPECT_NEAR(second_moment(KernelShape::cone), 3.0 / 20, 1e-15);
  EXPECT_NEAR(second_moment(KernelShape::epanechnikov), 1.0 / 6, 1e-15);
}

TEST(SurfaceKernels, WhatIsEvenComesOutEvenInTheMiddleAtEdgesAndInCorners) {
  PatchBuilder b;
  b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 1.5, 0}, 8, 6);
  const PatchSet patches = joined(b.build());
  const VertexLightmap map = make_lightmap(patches);
  for (const KernelShape shape : kShapes)
    for (const double h : {0.1, 0.4, 5.0}) {
      const SurfaceKernels kernels(patches, map, std::vector<double>(map.position.size(), h), shape);
      const LandingsByPatch landings = even_landings(
          patches, [](const Vec3&) { return 7.0; }, h < 0.2 ? 60 : 24);
      // A grid knows the rim of a disc to about a cell over its radius, the constant kernel worst.
      const double tolerance = shape == KernelShape::constant ? 0.02 : 0.004;
      for (std::size_t p = 0; p < kernels.size(); ++p)
        EXPECT_NEAR(kernels.irradiance(p, landings)[0], 7, 7 * tolerance) << static_cast<int>(shape) << h;
    }
}

TEST(SurfaceKernels, WhatIsLinearIsRightAtEdgesToo) {
  PatchBuilder b;
  b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 1.5, 0}, 8, 6);
  const PatchSet patches = joined(b.build());
  const VertexLightmap map = make_lightmap(patches);
  const auto E = [](const Vec3& x) { return 10 + 3 * x.x - 2 * x.y; };
  const LandingsByPatch landings = even_landings(patches, E);
  const std::vector<double> h(map.position.size(), 0.4);
  for (const KernelShape shape : kShapes) {
    const SurfaceKernels kernels(patches, map, h, shape);
    const double tolerance = shape == KernelShape::constant ? 0.03 : 0.006;  // of the grid, as above
    for (std::size_t p = 0; p < kernels.size(); ++p)
      EXPECT_NEAR(kernels.irradiance(p, landings)[0], E(map.position[p]), 10 * tolerance);
  }
}

TEST(SurfaceKernels, DoNotReachAroundCornersOrThroughPartitions) {
  // Floor and wall, and a partition in the middle of the floor: each side with an irradiance of its own.
  PatchBuilder b;
  b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 8, 4).rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 4, 4);
  b.rectangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 4, 4);
  const PatchSet patches = joined(b.build());
  const VertexLightmap map = make_lightmap(patches);
  const auto E = [](const Vec3& x) { return x.z > 1e-6 ? 100.0 : x.x < 1 ? 1.0 : 10.0; };
  const LandingsByPatch landings = even_landings(patches, E);
  const SurfaceKernels kernels(patches, map, std::vector<double>(map.position.size(), 0.5));
  for (std::size_t p = 0; p < kernels.size(); ++p) {
    const auto corners = patches.corner_positions(PatchId{std::size_t{map.patch_of_point[p]}});
    const double own = E((corners[0] + corners[1] + corners[2]) / 3);
    EXPECT_NEAR(kernels.irradiance(p, landings)[0], own, 0.01 * own);
  }
}

TEST(SurfaceKernels, FollowACurvedSurface) {
  // A quarter of a cylinder in facets of 7.5 degrees.
  PatchBuilder b;
  constexpr int kFacets = 12;
  for (int k = 0; k < kFacets; ++k) {
    const auto at = [](int i) {
      const double a = i * std::numbers::pi / (2 * kFacets);
      return Vec3{std::cos(a), 0, std::sin(a)};
    };
    b.rectangle(at(k), {0, 2, 0}, at(k + 1) - at(k), 12, 1);
  }
  const PatchSet patches = joined(b.build());
  const VertexLightmap map = make_lightmap(patches);
  const LandingsByPatch landings = even_landings(patches, [](const Vec3&) { return 3.0; });
  const SurfaceKernels kernels(patches, map, std::vector<double>(map.position.size(), 0.3));
  // A chord of 0.3 m is 0.4 % shorter than its arc.
  for (std::size_t p = 0; p < kernels.size(); ++p) EXPECT_NEAR(kernels.irradiance(p, landings)[0], 3, 0.03);
}

TEST(SurfaceKernels, AreOffByHalfTheirSecondMomentTimesTheLaplacian) {
  // A spot of even intensity I 1 m above a black floor: E = I (1 + r^2)^(-3/2), whose Laplacian below it is -6 I.
  PatchBuilder b(0);
  b.rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 4, 4);
  Lights lights;
  lights.luminaires.push_back(test::spot_lamp({0, 0, 1}, {0, 0, -1}, 10, 0.4, 0.4001));
  const test::LitPatches scene(joined(b.build()), std::move(lights));
  const Illumination light(scene.problem);
  const Emission emission(light);
  const VertexLightmap map = make_lightmap(scene.patches);
  const std::uint32_t below = point_at(map, {0, 0, 0}, scene.patches, {0, 0, 1});
  constexpr std::uint32_t kParticles = 1 << 20;
  std::vector<ParticleWays> ways{follow_particles(light, emission, 3, 0, kParticles)};
  LandingsByPatch landings;
  landings.sort(ways, scene.patches.patch_count());
  for (const KernelShape shape : kShapes) {
    std::vector<double> bias;
    for (const double h : {0.15, 0.3}) {
      const SurfaceKernels kernels(scene.patches, map, std::vector<double>(map.position.size(), h), shape);
      const double E = kernels.irradiance(below, landings)[0] / kParticles;
      // A quarter of the particles land in the smaller kernel's neighbourhood, stratified: 2e-3 of noise at most. The
      // next term is 15 / 8 of the mean of r^4, below h^4 / 3.
      EXPECT_NEAR(E / 10 - 1, -6 * second_moment(shape) * h * h / 2, 2e-3 + 15.0 / 8 * std::pow(h, 4) / 3)
          << static_cast<int>(shape) << ' ' << h;
      bias.push_back(1 - E / 10);
    }
    EXPECT_NEAR(bias[1] / bias[0], 4, 0.6);  // second order; noise of 2e-3 in 0.01
  }
}

}  // namespace
}  // namespace clerestory
