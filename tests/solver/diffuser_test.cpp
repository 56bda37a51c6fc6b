// Diffusers: what falls on one side leaves both, whatever the method.

#include <utility>

#include <gtest/gtest.h>

#include "solver/hierarchy/leaves_behind.h"
#include "solver/methods/hierarchical.h"
#include "solver/run/solve.h"
#include "solver/spaces/lit_sides.h"
#include "tests/support/room_with_blocks.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

struct Result {
  PatchSet patches;
  Solution solution;
};

Result solve_by(Method method, const PatchSet& patches, const Lights& lights) {
  const RayScene rays(patches);
  const Problem problem{patches, rays, lights};
  if (method != Method::hierarchical) return {patches, solve_on_patches(problem, {.method = method})};
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  HierarchicalSolution solved = hierarchical(problem, mesh, {.shortest_edge = 0.02});
  return {std::move(solved.elements), std::move(solved.solution)};
}

/// Mean over the patches of a material on one side of the sheet, or both.
double mean(const Result& r, std::size_t material, const Field& x, const Vec3& normal = {}) {
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < r.patches.patch_count(); ++i) {
    if (r.patches.material(PatchId{i}) != MaterialId{material} || dot(r.patches.normal[i], normal) < 0) continue;
    sum += r.patches.area[i] * x[i][0], area += r.patches.area[i];
  }
  return sum / area;
}

/// Flux that all patches absorb, and that arrives on those beyond x = 1 [W].
std::pair<double, double> absorbed_and_behind(const Result& r) {
  double absorbed = 0, behind = 0;
  for (std::size_t i = 0; i < r.patches.patch_count(); ++i) {
    const double flux = r.solution.E[i][0] * r.patches.area[i];
    absorbed += flux * (1 - r.patches.albedo(i)[0]);
    const auto c = r.patches.corner_positions(PatchId{i});
    if ((c[0].x + c[1].x + c[2].x) / 3 > 1 + 1e-9) behind += flux;
  }
  return {absorbed, behind};
}

class Diffuser : public testing::TestWithParam<Method> {};

/// Unit cube around z = 0 .. 1 with a lid of its own material; cells of 1 / n.
PatchBuilder& open_cube(PatchBuilder& b, std::size_t n) {
  b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, n, n);
  b.rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, n, n).rectangle({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, n, n);
  b.rectangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, n, n).rectangle({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, n, n);
  return b;
}

TEST_P(Diffuser, AsTheOnlyOpeningOfADarkBoxLightsItsFloorByTheFormFactor) {
  // The sky gives the lid E from above; below it glows with tau E, and the black floor gets F of that: Howell C-11,
  // X = Y = 1. Walls are seen from one side only, so rays see the sky through their backs: they are black.
  constexpr double kTau = 0.4, kE = 100, kF = 0.199824896;
  PatchBuilder b(0.0);
  open_cube(b, 6).diffuser(0.3, kTau).rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, 6, 6);
  Lights lights;
  lights.sky = Sky{SkyModel::uniform, Spectrum(kE), 0.0};
  const Result r = solve_by(GetParam(), b.build(), lights);
  EXPECT_NEAR(mean(r, 1, r.solution.E, {0, 0, 1}), kE, 1e-3 * kE);
  EXPECT_NEAR(mean(r, 1, r.solution.E, {0, 0, -1}), 0, 1e-9);
  EXPECT_NEAR(mean(r, 1, r.solution.B, {0, 0, 1}), 0.3 * kE, 1e-3 * kE);
  EXPECT_NEAR(mean(r, 1, r.solution.B, {0, 0, -1}), kTau * kE, 1e-3 * kE);
  // 72 patches of 256 rays or paths: a standard error of sqrt(0.2 * 0.8 / 18,432) / 0.2 = 1.5 %.
  double floor = 0;
  for (std::size_t i = 0; i < r.patches.patch_count(); ++i)
    if (r.patches.normal[i].z > 0.5 && r.patches.material(PatchId{i}) == MaterialId{0})
      floor += r.patches.area[i] * r.solution.E[i][0];
  EXPECT_NEAR(floor, kTau * kE * kF, 0.045 * kTau * kE * kF);
  EXPECT_NEAR(r.solution.energy.imbalance(), 0, 5e-3);
}

TEST_P(Diffuser, BetweenTwoRoomsKeepsTheEnergy) {
  PatchBuilder b(0.6);
  b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 8, 4).rectangle({0, 0, 1}, {0, 1, 0}, {2, 0, 0}, 4, 8);
  b.rectangle({0, 0, 0}, {0, 0, 1}, {2, 0, 0}, 4, 8).rectangle({0, 1, 0}, {2, 0, 0}, {0, 0, 1}, 8, 4);
  b.rectangle({2, 0, 0}, {0, 0, 1}, {0, 1, 0}, 4, 4);
  b.material(0.6, 100).rectangle({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 4, 4);
  b.diffuser(0.35, 0.5).rectangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 4, 4);
  const PatchSet patches = b.build();
  const Result r = solve_by(GetParam(), patches, {});
  EXPECT_NEAR(r.solution.energy.emitted, 100, 1e-6);
  const bool estimate = is_by_paths(GetParam()) || GetParam() == Method::particles;
  EXPECT_NEAR(r.solution.energy.imbalance(), 0, estimate ? 1e-2 : 1e-3);
  EXPECT_NEAR(r.solution.energy.escaped, 0, 1e-6);
  const auto [absorbed, behind] = absorbed_and_behind(r);
  EXPECT_NEAR(absorbed, r.solution.energy.absorbed, 1e-6 * absorbed);
  // Constant elements of 1/4 m: halving them, and the noise of rays and paths, changes this by less than 1 %.
  const Result matrix = solve_by(Method::gauss_seidel, patches, {});
  // Particles: 200,000, of which one in ten gets behind the sheet, and lands there three times.
  const double tolerance = GetParam() == Method::particles ? 0.03 : 0.01;
  EXPECT_NEAR(behind / absorbed_and_behind(matrix).second, 1, tolerance);
  EXPECT_NEAR(mean(r, 2, r.solution.E) / mean(matrix, 2, matrix.solution.E), 1, tolerance);
}

TEST_P(Diffuser, InsideAFurnaceIsAsBrightAsTheWalls) {
  // Walls of rho = 0.5 that emit M hold B = 2 M; a sheet with rho + tau = 0.5 that emits M on both sides as well.
  PatchBuilder b(0.5);
  b.material(0.5, 10).box({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {6, 4, 4}, true);
  b.diffuser(0.1, 0.4).rectangle({0.8, 0.2, 0.2}, {0.1, 0.6, 0}, {0, 0, 0.6}, 3, 3);
  PatchSet patches = b.build();
  patches.materials.back().exitance = Spectrum(10);
  make_patches(patches, [&] {
    std::vector<bool> fronts(2 * patches.triangle_count(), false);
    for (std::size_t t = 0; t < patches.triangle_count(); ++t) fronts[2 * t] = true;
    return fronts;
  }());
  const Result r = solve_by(GetParam(), patches, {});
  for (std::size_t i = 0; i < r.patches.patch_count(); ++i) {
    const bool estimate = is_by_paths(GetParam()) || GetParam() == Method::particles;
    const double tolerance = estimate ? 6 * r.solution.std_error[i][0] + 1e-9 : 1e-2;
    ASSERT_NEAR(r.solution.E[i][0], 20, tolerance) << i;
    ASSERT_NEAR(r.solution.B[i][0], 20, tolerance) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Diffuser,
                         testing::Values(Method::hierarchical, Method::progressive, Method::gauss_seidel,
                                         Method::jacobi, Method::path, Method::bidirectional, Method::particles));

TEST(DiffuserSides, TakePartTogetherWhenLightReachesOne) {
  // A box without openings, one of whose walls is a diffuser in the sky's light.
  PatchBuilder b(0.5);
  open_cube(b, 1).diffuser(0.3, 0.4).rectangle({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  PatchSet patches = b.build();
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  const RayScene rays(patches);
  Lights lights;
  lights.sky = Sky{SkyModel::uniform, Spectrum(100), 0.0};
  const LitSides lit = find_lit_sides({patches, rays, lights});
  EXPECT_EQ(lit.dark_sides, 0u);
  patches.materials.back().kind = MaterialKind::diffuse;
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  EXPECT_EQ(find_lit_sides({patches, rays, lights}).dark_sides, 12u);  // the inside
}

TEST(DiffuserSides, HalvedApartStillLieBackToBack) {
  PatchBuilder b;
  b.diffuser(0.3, 0.4).triangle({0, 0, 0}, {3, 0, 0}, {1, 2, 0}).triangle({3, 0, 0}, {4, 3, 0}, {1, 2, 0});
  const PatchSet patches = b.build();
  const VertexLightmap map = test::unjoined_lightmap(patches);
  ElementMesh mesh(patches, map);
  for (int round = 0; round < 6; ++round) {
    std::vector<std::uint32_t> marked;
    for (const std::uint32_t e : mesh.leaves())
      if (patches.side[mesh[e].patch] == (round % 3 ? kFront : kBack) && e % 3 != 0) marked.push_back(e);
    mesh.split(marked);
  }
  const PatchSet leaves = mesh.leaf_patches();
  ASSERT_GT(leaves.patch_count(), 20u);
  // Shares of a leaf sum to 1, and what passes from i to j is as much area as from j to i.
  for (std::size_t i = 0; i < leaves.patch_count(); ++i) {
    double sum = 0;
    for (const auto& [j, share] : leaves.patches_behind(i)) {
      sum += share;
      double back = 0;
      for (const auto& [k, other] : leaves.patches_behind(j))
        if (k == PatchId{i}) back = other;
      EXPECT_NEAR(share * leaves.area[i], back * leaves.area[j], 1e-9);
      EXPECT_LT(dot(leaves.normal[i], leaves.normal[j]), -0.999);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

}  // namespace
}  // namespace clerestory
