// Plane mirrors: rays that turn, images of lamps, and the energy of it all.

#include <cmath>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/gather/gather_point.h"
#include "solver/illumination/light_sampler.h"
#include "solver/illumination/place_lights.h"
#include "solver/methods/hierarchical.h"
#include "solver/model/error.h"
#include "solver/paths/path_tracer.h"
#include "solver/run/solve.h"
#include "solver/visibility/glass_sheet.h"
#include "tests/support/gather_quality.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

constexpr double kRho = 0.8;

TEST(Mirror, TurnsARayAndTakesItsShareAtEachReflection) {
  // Two mirrors face each other over 1 m; a black plate stands beside them.
  PatchBuilder b(0.0);
  b.rectangle({5, -1, 0.2}, {0, 2, 0}, {0, 0, 0.6});
  b.mirror(kRho).rectangle({-1, -1, 0}, {5, 0, 0}, {0, 2, 0}).rectangle({-1, -1, 1}, {5, 0, 0}, {0, 2, 0});
  b.glass(0.65).rectangle({-0.5, -1, 0.5}, {4, 0, 0}, {0, 2, 0});
  const PatchSet patches = b.build();
  EXPECT_EQ(patches.patch_count(), 2u) << "mirrors and glass are no receivers";
  const RayScene rays(patches);
  ASSERT_TRUE(rays.has_mirrors());
  ASSERT_EQ(rays.mirrors().size(), 3u);
  EXPECT_TRUE(!rays.mirrors()[0].is_glass && !rays.mirrors()[1].is_glass && rays.mirrors()[2].is_glass);
  // From z = 0.75 upwards by 45 degrees: mirrors at x = 0.25, 1.25, 2.25, 3.25, glass between them, out at x = 4.25.
  const Ray ray{{0, 0.1, 0.75}, normalized(Vec3{1, 0, 1})};
  const std::array<Ray, 2> both{ray, ray};
  std::array<Hit, 2> hits;
  rays.first_hits(patches, both, hits);
  const double glass = GlassTable(Spectrum(0.65)).transmittance(std::sqrt(0.5))[0];
  for (const Hit& hit : {rays.first_hit(patches, ray), hits[0], hits[1]}) {
    EXPECT_TRUE(hit.escaped());
    EXPECT_TRUE(hit.reflected);
    EXPECT_NEAR(hit.transmittance[0], std::pow(kRho, 4) * std::pow(glass, 3), 1e-4);
    EXPECT_NEAR(hit.direction(ray).x, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(hit.direction(ray).z, std::sqrt(0.5), 1e-6);
  }
}

TEST(Mirror, ShowsTheImageOfALampWhereTheWayMeetsItAndIsFree) {
  // A mirror of 2 x 2 m in the floor, a lamp 1 m above it, and a ceiling at 3 m with the points.
  PatchBuilder b(0.0);
  b.rectangle({-4, -4, 3}, {0, 8, 0}, {8, 0, 0});
  b.mirror(kRho).rectangle({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  LightSpec lamps;
  lamps.luminaires = {test::point_lamp({0.3, 0.2, 1}, 100)};
  const auto at = [&](const PatchSet& patches, const Vec3& p) {
    const RayScene rays(patches);
    const Lights lights = place_lights(lamps, patches, rays);
    EXPECT_EQ(lights.luminaires.size(), 2u);
    const Problem problem{patches, rays, lights};
    return LightSampler(problem, patches.M).delta_light(p, {0, 0, -1}, {}, 1)[0];
  };
  const auto from = [](const Vec3& lamp, const Vec3& p) {
    const Vec3 d = lamp - p;
    return 100 / (4 * std::numbers::pi) * -d.z / std::pow(length(d), 3);
  };
  const PatchSet open = b.build();
  for (const Vec3& p : {Vec3{0.5, 0.5, 2.999}, Vec3{-1.5, 0.4, 2.999}, Vec3{3.5, 0, 2.999}}) {
    // The way from the image at z = -1 crosses the floor a quarter of the way up.
    const Vec3 crossing = Vec3{0.3, 0.2, -1} + (p - Vec3{0.3, 0.2, -1}) * (1 / (1 + p.z));
    const bool shown = std::abs(crossing.x) < 1 && std::abs(crossing.y) < 1;
    EXPECT_EQ(shown, p.x < 3);
    const double exact = from({0.3, 0.2, 1}, p) + (shown ? kRho * from({0.3, 0.2, -1}, p) : 0);
    EXPECT_NEAR(at(open, p) / exact, 1, 1e-6);
  }
  // A plate between lamp and mirror leaves the lamp's own light alone.
  b.material(0.0).rectangle({-2, -2, 0.5}, {4, 0, 0}, {0, 4, 0});
  const Vec3 p{0.5, 0.5, 2.999};
  EXPECT_NEAR(at(b.build(), p) / from({0.3, 0.2, 1}, p), 1, 1e-6);
}

TEST(Mirror, ShowsAGlowingPatchAsItsImage) {
  // In a black space: a lamp of 1 m2 that shines down, a mirror far wider than both 1 m below, and a point beside the
  // lamp that looks down: it gets rho M F of the image 2 m below.
  PatchBuilder b(0.0);
  b.material(0.0, 100).rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  b.mirror(kRho).rectangle({-30, -30, 0}, {60, 0, 0}, {0, 60, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Vec3 p{1.5, 0.5, 1}, n{0, 0, -1};
  const std::array<Vec3, 4> image{Vec3{0, 0, -1}, Vec3{1, 0, -1}, Vec3{1, 1, -1}, Vec3{0, 1, -1}};
  const double exact = kRho * 100 * point_to_polygon(p, n, image);
  ASSERT_GT(exact, 1);
  const Illumination light(problem, patches.M);
  unsigned long long traced = 0;
  // 16,384 rays in strata of which a twentieth meets the image's edge.
  EXPECT_NEAR(
      gather_point(light, p, n, GatherPattern(test::gather_quality({16, 16384, 16384}), 1), traced).E[0] / exact, 1,
      0.01);
  const PathEstimate paths = trace_paths_at_point(Illumination(problem), p, n, 1, 65'536, traced);
  EXPECT_NEAR(paths.E[0], exact, 4 * paths.std_error[0]);
}

TEST(Mirror, ShowsASmallGlowingPatchToShadowRays) {
  // In the same way a lamp of 0.1 m2, which 256 rays in a mirror would meet or not.
  PatchBuilder b(0.0);
  b.material(0.0, 100).rectangle({0, 0, 1}, {0, 0.3, 0}, {0.3, 0, 0});
  b.material(0.0).rectangle({-30, -30, 3}, {0, 60, 0}, {60, 0, 0});
  b.mirror(kRho).rectangle({-30, -30, 0}, {60, 0, 0}, {0, 60, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  const Lights none;
  const Problem problem{patches, rays, none};
  const Illumination light = gather_illumination(problem, patches.M);
  const Vec3 n{0, 0, -1};
  unsigned long long traced = 0;
  for (const double x : {0.8, 1.5, 3.0}) {
    const Vec3 p{x, 0.2, 1};
    const std::array<Vec3, 4> image{Vec3{0, 0, -1}, Vec3{0.3, 0, -1}, Vec3{0.3, 0.3, -1}, Vec3{0, 0.3, -1}};
    const double exact = kRho * 100 * point_to_polygon(p, n, image);
    for (const std::uint64_t seed : {1u, 2u, 3u})
      EXPECT_NEAR(
          gather_point(light, p, n, GatherPattern(test::gather_quality({16, 256, 256}), seed), traced).E[0] / exact, 1,
          0.02);
  }
}

/// A room with a glowing wall, a point lamp, and a mirror for a wall.
PatchSet mirrored_room() {
  PatchBuilder b(0.6);
  b.rectangle({0, 0, 0}, {3, 0, 0}, {0, 2, 0}, 12, 8).rectangle({0, 0, 2}, {0, 2, 0}, {3, 0, 0}, 8, 12);
  b.rectangle({0, 0, 0}, {0, 0, 2}, {3, 0, 0}, 8, 12).rectangle({3, 0, 0}, {0, 0, 2}, {0, 2, 0}, 8, 8);
  b.material(0.6, 50).rectangle({0, 0, 0}, {0, 2, 0}, {0, 0, 2}, 8, 8);
  b.mirror(kRho).rectangle({0, 2, 0}, {3, 0, 0}, {0, 0, 2});
  return b.build();
}

Solution solve_by(Method method, const PatchSet& patches, PatchSet& solved_on) {
  const RayScene rays(patches);
  LightSpec lamps;
  lamps.luminaires = {test::point_lamp({0.8, 0.7, 1.2}, 100)};
  const Lights lights = place_lights(lamps, patches, rays);
  const Problem problem{patches, rays, lights};
  solved_on = patches;
  if (method != Method::hierarchical) return solve_on_patches(problem, {.method = method});
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  HierarchicalSolution solved = hierarchical(problem, mesh, {.shortest_edge = 0.05});
  solved_on = std::move(solved.elements);
  return std::move(solved.solution);
}

TEST(Mirror, LightOfARoomIsTheSameByAllMethodsAndItsEnergyIsBalanced) {
  const PatchSet patches = mirrored_room();
  PatchSet on;
  const auto flux_on_floor = [&](Method method, double imbalance) {
    const Solution s = solve_by(method, patches, on);
    EXPECT_NEAR(s.energy.emitted, 300, 1e-3);
    EXPECT_NEAR(s.energy.imbalance(), 0, imbalance);
    EXPECT_EQ(s.energy.escaped, 0);
    double flux = 0, absorbed = 0;
    for (std::size_t i = 0; i < on.patch_count(); ++i) {
      absorbed += on.area[i] * (1 - on.rho[i][0]) * s.E[i][0];
      if (on.normal[i].z > 0.5) flux += on.area[i] * s.E[i][0];
    }
    EXPECT_GT(s.energy.absorbed, absorbed + 20) << "mirrors take their share";
    return flux;
  };
  const double paths = flux_on_floor(Method::path, 1e-2);
  EXPECT_NEAR(flux_on_floor(Method::bidirectional, 1e-2) / paths, 1, 0.01);
  EXPECT_NEAR(flux_on_floor(Method::progressive, 5e-3) / paths, 1, 0.01);
  EXPECT_NEAR(flux_on_floor(Method::particles, 1e-2) / paths, 1, 0.01);
  EXPECT_NEAR(flux_on_floor(Method::hierarchical, 5e-3) / paths, 1, 0.01);
  EXPECT_THROW(solve_by(Method::gauss_seidel, patches, on), InputError);
}

}  // namespace
}  // namespace clerestory
