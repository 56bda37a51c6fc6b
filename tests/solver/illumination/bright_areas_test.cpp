#include "solver/illumination/bright_areas.h"

#include <numbers>

#include <gtest/gtest.h>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/gather/gather_point.h"
#include "tests/solver/hierarchy/field_scenes.h"
#include "tests/support/gather_quality.h"

namespace clerestory {
namespace {

using testing::SceneMaker;

struct LitRoom {
  PatchSet patches;
  RayScene rays;
  Lights lights;
  Problem problem{patches, rays, lights};

  explicit LitRoom(SceneMaker& m, double element = 0.25)
      : patches(build_patches(m.scene(), {.max_element = element}).patches), rays(patches) {}
};

/// A black room 4 x 4 x 3 and a lamp of 1 x 1 m in the middle of its ceiling.
SceneMaker room_with_ceiling_lamp() {
  SceneMaker m;
  m.box({0, 0, 0}, {4, 4, 3});
  for (Material& material : m.scene().materials) material.reflectance = Spectrum(0.0);
  const MaterialId lamp = m.material("lamp", 0);
  m.edit(lamp).exitance = Spectrum(100);
  m.edit(lamp).sides = 1;
  m.polygon({{1.5, 1.5, 2.9}, {1.5, 2.5, 2.9}, {2.5, 2.5, 2.9}, {2.5, 1.5, 2.9}}, lamp);
  return m;
}

TEST(FindPanels, ALampOfManyPatchesIsOneRectangle) {
  SceneMaker m = room_with_ceiling_lamp();
  const LitRoom room(m);
  const BrightAreas bright_areas = find_bright_areas(room.patches, LightSampler(room.problem, room.patches.M));
  ASSERT_EQ(bright_areas.shape.size(), 1u);
  EXPECT_EQ(bright_areas.shape[0].corners.size(), 4u);
  EXPECT_NEAR(bright_areas.shape[0].area, 1, 1e-9);
  EXPECT_NEAR(bright_areas.shape[0].normal.z, -1, 1e-9);
  EXPECT_NEAR(bright_areas.shape[0].brightness, 100 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(bright_areas.flux[0], bright_areas.all_flux, 1e-9);
}

TEST(FindPanels, TwoLampsInOnePlaneAreTwo) {
  SceneMaker m = room_with_ceiling_lamp();
  const MaterialId lamp = m.material("other", 0);
  m.edit(lamp).exitance = Spectrum(100);
  m.edit(lamp).sides = 1;
  m.polygon({{3, 3, 2.9}, {3, 3.5, 2.9}, {3.5, 3.5, 2.9}, {3.5, 3, 2.9}}, lamp);
  const LitRoom room(m);
  EXPECT_EQ(find_bright_areas(room.patches, LightSampler(room.problem, room.patches.M)).shape.size(), 2u);
}

TEST(GatherPoint, OfAnEvenPanelThatNothingHidesIsTheClosedForm) {
  SceneMaker m = room_with_ceiling_lamp();
  const LitRoom room(m);
  Illumination light(room.problem, room.patches.M);
  light.look_at_bright_areas();
  const GatherPattern pattern(test::gather_quality(), 3);
  const Vec3 origin = room.patches.origin;
  const std::vector<Vec3> lamp{Vec3{1.5, 1.5, 2.9} - origin, Vec3{1.5, 2.5, 2.9} - origin, Vec3{2.5, 2.5, 2.9} - origin,
                               Vec3{2.5, 1.5, 2.9} - origin};
  for (const auto& [p, n] : {std::pair<Vec3, Vec3>{{2, 0.001, 0.25}, {0, 1, 0}}, {{0.3, 3, 0.001}, {0, 0, 1}}}) {
    unsigned long long rays = 0;
    const double exact = 100 * point_to_polygon(p - origin, n, lamp);
    EXPECT_NEAR(gather_point(light, p - origin, n, pattern, rays).E[0] / exact, 1, 1e-6);
  }
}

TEST(GatherPoint, OfAPanelBehindABoardIsWhatTheBoardLeaves) {
  // Seen from the floor's middle a board at half the height hides the half of the lamp at x > 2.
  SceneMaker m = room_with_ceiling_lamp();
  const MaterialId black = m.material("board", 0);
  m.polygon({{2, 0.5, 1.45}, {3.5, 0.5, 1.45}, {3.5, 3.5, 1.45}, {2, 3.5, 1.45}}, black);
  const LitRoom room(m);
  const Vec3 origin = room.patches.origin, p = Vec3{2, 2, 1e-3} - origin;
  const std::vector<Vec3> seen{Vec3{1.5, 1.5, 2.9} - origin, Vec3{1.5, 2.5, 2.9} - origin, Vec3{2, 2.5, 2.9} - origin,
                               Vec3{2, 1.5, 2.9} - origin};
  const double exact = 100 * point_to_polygon(p, {0, 0, 1}, seen);
  double mean = 0;
  constexpr int kSeeds = 8;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Illumination light(room.problem, room.patches.M);
    light.look_at_bright_areas();
    unsigned long long rays = 0;
    const double E = gather_point(light, p, {0, 0, 1}, GatherPattern(test::gather_quality(), seed), rays).E[0];
    EXPECT_NEAR(E / exact, 1, 5e-3);  // 128 x 128 cells or more along the edge
    mean += E / kSeeds;
  }
  EXPECT_NEAR(mean / exact, 1, 2e-3);
}

}  // namespace
}  // namespace clerestory
