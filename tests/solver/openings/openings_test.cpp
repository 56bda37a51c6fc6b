#include "solver/openings/openings.h"

#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/gather/gather_point.h"
#include "solver/illumination/direct.h"
#include "solver/paths/path_tracer.h"
#include "tests/solver/hierarchy/field_scenes.h"
#include "tests/support/gather_quality.h"

namespace clerestory {
namespace {

using testing::SceneMaker;

/// Walls of a room 4 x 4 x 3, sheets; each may be left out.
void add_sheets(SceneMaker& m, bool facade, bool ceiling) {
  m.polygon({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  m.polygon({{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  m.polygon({{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  m.polygon({{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  if (facade) m.polygon({{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  if (ceiling) m.polygon({{0, 0, 3}, {0, 4, 3}, {4, 4, 3}, {4, 0, 3}});
}
/// The wall y = 0 around a hole from (x0, z0) to (x1, z1).
void add_holed_facade(SceneMaker& m, double x0, double z0, double x1, double z1) {
  const auto part = [&](double a, double b, double c, double d) {
    if (c > a && d > b) m.polygon({{a, 0, b}, {a, 0, d}, {c, 0, d}, {c, 0, b}});
  };
  part(0, 0, 4, z0), part(0, z1, 4, 3), part(0, z0, x0, z1), part(x1, z0, 4, z1);
}

struct Found {
  PatchSet patches;
  RayScene rays;
  Lights lights;

  explicit Found(SceneMaker& m, bool sky = true)
      : patches(build_patches(m.scene(), {.max_element = 1}).patches), rays(patches) {
    if (sky) lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(std::numbers::pi)};
    lights.openings = find_openings(patches, rays, lights);
  }
  const LightArea& only() const {
    EXPECT_EQ(lights.openings.size(), 1u);
    return lights.openings.at(0);
  }
};

TEST(FindOpenings, AWindowInASheetIsFoundAndLooksInwards) {
  SceneMaker m;
  add_sheets(m, false, true);
  add_holed_facade(m, 1, 1, 3, 2);
  const Found found(m);
  EXPECT_NEAR(found.only().area, 2, 1e-6);
  EXPECT_NEAR(found.only().normal.y, 1, 1e-9);
  EXPECT_NEAR(found.only().brightness, 0.6, 0.1);  // sky of radiance 1, and ground of 0.2
}

TEST(FindOpenings, ADoorThatReachesTheFloorIsOneToo) {
  SceneMaker m;
  add_sheets(m, false, true);
  add_holed_facade(m, 1, 0, 2, 2.1);
  EXPECT_NEAR(Found(m).only().area, 2.1, 2.1e-3);
}

TEST(FindOpenings, ASlitOfOneMillimetreBetweenWallAndCeilingIsFound) {
  SceneMaker m;
  add_sheets(m, false, true);
  m.polygon({{0, 0, 0}, {0, 0, 2.999}, {4, 0, 2.999}, {4, 0, 0}});
  EXPECT_NEAR(Found(m).only().area, 4 * 0.001, 1e-6);
}

TEST(FindOpenings, AMissingWallAndAMissingRoofAreFound) {
  SceneMaker wall, roof;
  add_sheets(wall, false, true);
  EXPECT_NEAR(Found(wall).only().area, 12, 1e-6);
  add_sheets(roof, true, false);
  EXPECT_NEAR(Found(roof).only().area, 16, 1e-6);
  EXPECT_NEAR(Found(roof).only().normal.z, -1, 1e-9);
}

TEST(FindOpenings, AWindowInAThickWallCountsOnce) {
  SceneMaker m;
  add_sheets(m, false, true);
  // Both faces of the wall y = 0, 0.3 m thick, its rims, and the four reveals of a window of 2 x 1 m.
  const auto ring = [&](double y) {
    for (const auto& [a, b, c, d] :
         {std::array{0.0, 0.0, 4.0, 1.0}, {0.0, 2.0, 4.0, 3.0}, {0.0, 1.0, 1.0, 2.0}, {3.0, 1.0, 4.0, 2.0}})
      m.polygon({{a, y, b}, {a, y, d}, {c, y, d}, {c, y, b}});
  };
  ring(0), ring(-0.3);
  m.polygon({{0, 0, 0}, {4, 0, 0}, {4, -0.3, 0}, {0, -0.3, 0}});
  m.polygon({{0, 0, 3}, {4, 0, 3}, {4, -0.3, 3}, {0, -0.3, 3}});
  m.polygon({{0, 0, 0}, {0, 0, 3}, {0, -0.3, 3}, {0, -0.3, 0}});
  m.polygon({{4, 0, 0}, {4, 0, 3}, {4, -0.3, 3}, {4, -0.3, 0}});
  m.polygon({{1, 0, 1}, {3, 0, 1}, {3, -0.3, 1}, {1, -0.3, 1}});
  m.polygon({{1, 0, 2}, {3, 0, 2}, {3, -0.3, 2}, {1, -0.3, 2}});
  m.polygon({{1, 0, 1}, {1, 0, 2}, {1, -0.3, 2}, {1, -0.3, 1}});
  m.polygon({{3, 0, 1}, {3, 0, 2}, {3, -0.3, 2}, {3, -0.3, 1}});
  EXPECT_NEAR(Found(m).only().area, 2, 1e-6);
}

TEST(FindOpenings, AClosedRoomHasNoneNorHasASceneWithoutSky) {
  SceneMaker closed, window;
  add_sheets(closed, true, true);
  EXPECT_TRUE(Found(closed).lights.openings.empty());
  add_sheets(window, false, true);
  add_holed_facade(window, 1, 1, 3, 2);
  EXPECT_TRUE(Found(window, false).lights.openings.empty());
}

TEST(FindOpenings, ThoseThatSeeTheSkyComeBeforeSlitsThatDoNot) {
  // A room with a window, and a dark one behind a wall that ends 2 mm below the common ceiling.
  SceneMaker m;
  m.polygon({{0, 0, 0}, {8, 0, 0}, {8, 4, 0}, {0, 4, 0}});
  m.polygon({{0, 0, 3}, {0, 4, 3}, {8, 4, 3}, {8, 0, 3}});
  m.polygon({{0, 4, 0}, {8, 4, 0}, {8, 4, 3}, {0, 4, 3}});
  m.polygon({{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  m.polygon({{8, 0, 0}, {8, 0, 3}, {8, 4, 3}, {8, 4, 0}});
  m.polygon({{4, 0, 0}, {4, 0, 2.998}, {4, 4, 2.998}, {4, 4, 0}});
  m.polygon({{4, 0, 0}, {4, 0, 3}, {8, 0, 3}, {8, 0, 0}});
  add_holed_facade(m, 1, 1, 3, 2);
  const Found found(m);
  ASSERT_EQ(found.lights.openings.size(), 2u);
  EXPECT_TRUE(found.lights.openings[0].sees_sky);
  EXPECT_FALSE(found.lights.openings[1].sees_sky);
  EXPECT_TRUE(is_slit(found.lights.openings[1]));
  EXPECT_EQ(found.lights.sky_openings().size(), 1u);
}

TEST(WayOut, IsTheDistanceToAnOpeningThatIsPassedOutwards) {
  SceneMaker m;
  add_sheets(m, false, true);
  add_holed_facade(m, 1, 1, 3, 2);
  const Found found(m);
  const Vec3 origin = found.patches.origin, inside = Vec3{2, 3, 1.5} - origin, outside = Vec3{2, -3, 1.5} - origin;
  EXPECT_NEAR(way_out(found.only(), inside, {0, -1, 0}), 3, 1e-9);
  EXPECT_LT(way_out(found.only(), inside, {0, 1, 0}), 0);
  EXPECT_LT(way_out(found.only(), outside, {0, 1, 0}), 0);
  EXPECT_LT(way_out(found.only(), inside + Vec3{1.5, 0, 0}, {0, -1, 0}), 0);
}

/// A black room with a slit of 1 mm x 1 m in its facade, seen from 3.5 m: E = pi L F by the closed form.
struct Slit {
  SceneMaker maker;
  std::unique_ptr<Found> found;
  Slit() {
    add_sheets(maker, false, true);
    add_holed_facade(maker, 1.5, 1.4, 2.5, 1.401);
    for (Material& m : maker.scene().materials) m.reflectance = Spectrum(0.0);
    found = std::make_unique<Found>(maker);
  }
};

TEST(GatherPoint, SeesASlitOfOneMillimetreFromDeepInARoomExactly) {
  Slit slit;
  const Problem problem{slit.found->patches, slit.found->rays, slit.found->lights};
  const Field dark(problem.patches.patch_count(), 1);
  const Vec3 p = Vec3{1, 3.5, 0.8} - problem.patches.origin, n{0, -1, 0};
  const LightArea& opening = slit.found->only();
  // The ray from here looks up, and sees sky of radiance 1 all over the slit.
  const double exact = std::numbers::pi * form_factor(opening, p, n);
  unsigned long long rays = 0;
  EXPECT_NEAR(
      gather_point(Illumination(problem, dark), p, n, GatherPattern(test::gather_quality(), 1), rays).E[0] / exact, 1,
      1e-3);
  const PathEstimate paths = trace_paths_at_point(Illumination(problem), p, n, 5, 4096, rays);
  EXPECT_NEAR(paths.E[0], exact, 4 * paths.std_error[0] + 1e-3 * exact);
}

TEST(TracePaths, FindTheLightOfABrightRoomThroughASlit) {
  // A room that glows all over, and a dark one behind a wall that ends 1 mm below the common ceiling; nothing reflects.
  SceneMaker m;
  const MaterialId bright = m.material("bright", 0), black = m.material("black", 0);
  m.edit(bright).exitance = Spectrum(2.0);
  for (const MaterialId material : {bright, black}) {
    m.edit(material).sides = 1;
    const bool is_left = material == bright;
    const double a = is_left ? -4 : 0, b = is_left ? 0 : 4, top = 2.999, from = is_left ? top : 3,
                 to = is_left ? 3 : top;
    m.polygon({{a, 0, 0}, {b, 0, 0}, {b, 4, 0}, {a, 4, 0}}, material);
    m.polygon({{a, 0, 3}, {a, 4, 3}, {b, 4, 3}, {b, 0, 3}}, material);
    m.polygon({{a, 0, 0}, {a, 0, 3}, {b, 0, 3}, {b, 0, 0}}, material);
    m.polygon({{a, 4, 0}, {b, 4, 0}, {b, 4, 3}, {a, 4, 3}}, material);
    m.polygon({{a, 0, 0}, {a, 4, 0}, {a, 4, to}, {a, 0, to}}, material);
    m.polygon({{b, 0, 0}, {b, 0, from}, {b, 4, from}, {b, 4, 0}}, material);
  }
  const Found found(m, false);
  const Problem problem{found.patches, found.rays, found.lights};
  EXPECT_TRUE(found.lights.sky_openings().empty());
  const Vec3 p = Vec3{3, 2, 1} - problem.patches.origin, n{-1, 0, 0};
  const double exact = 2 * form_factor(found.only(), p, n);  // [W/m2]
  unsigned long long rays = 0;
  const PathEstimate paths = trace_paths_at_point(Illumination(problem), p, n, 5, 4096, rays);
  EXPECT_NEAR(paths.E[0], exact, 4 * paths.std_error[0]);
  EXPECT_LT(paths.std_error[0],
            0.05 * exact);  // one ray in 3,000 meets the slit by chance: 90 % without looking for it
}

TEST(GatherPoint, APlanFromIndoorsServesAPointOutdoors) {
  // As along a floor that runs out through a door: halves of an element take the plan of a corner.
  SceneMaker m;
  add_sheets(m, false, true);
  Found found(m);
  const Problem problem{found.patches, found.rays, found.lights};
  const Field dark(problem.patches.patch_count(), 1);
  const Illumination light(problem, dark);
  const GatherPattern pattern(test::gather_quality(), 1);
  const Vec3 inside = Vec3{2, 1, 0.5} - problem.patches.origin, outside = Vec3{2, -1, 0.5} - problem.patches.origin;
  unsigned long long rays = 0;
  const GatherPlan plan = plan_gather(light, inside, {0, 0, 1}, pattern, rays);
  ASSERT_EQ(plan.openings.size(), 1u);
  const double E = gather_point(light, outside, {0, 0, 1}, pattern, plan, rays).E[0];
  EXPECT_NEAR(E / gather_point(light, outside, {0, 0, 1}, pattern, rays).E[0], 1, 0.02);  // 1,024 rays and more
}

/// A corridor 1 m wide behind a hall with sixteen windows, and one window of its own at its far end: all of the hall's
/// are nearer, and behind a wall.
struct CorridorBehindAHall {
  SceneMaker m;
  std::unique_ptr<Found> found;

  CorridorBehindAHall() {
    const MaterialId black = m.material("black", 0);
    const auto wall = [&](const std::vector<Vec3>& corners) { m.polygon(corners, black); };
    wall({{0, 0, 0}, {8, 0, 0}, {8, 5, 0}, {0, 5, 0}});
    wall({{0, 0, 3}, {0, 5, 3}, {8, 5, 3}, {8, 0, 3}});
    wall({{0, 4, 0}, {8, 4, 0}, {8, 4, 3}, {0, 4, 3}});  // between them
    wall({{0, 5, 0}, {8, 5, 0}, {8, 5, 3}, {0, 5, 3}});
    wall({{8, 0, 0}, {8, 0, 3}, {8, 5, 3}, {8, 5, 0}});
    wall({{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
    const auto at_end = [&](double y0, double z0, double y1, double z1) {
      wall({{0, y0, z0}, {0, y1, z0}, {0, y1, z1}, {0, y0, z1}});
    };
    at_end(4, 0, 5, 1), at_end(4, 2, 5, 3), at_end(4, 1, 4.3, 2), at_end(4.7, 1, 5, 2);
    const auto front = [&](double x0, double z0, double x1, double z1) {
      wall({{x0, 0, z0}, {x0, 0, z1}, {x1, 0, z1}, {x1, 0, z0}});
    };
    front(0, 0, 8, 1), front(0, 2, 8, 3), front(0, 1, 0.1, 2);
    for (int k = 0; k < 16; ++k) front(0.5 * k + 0.4, 1, 0.5 * k + 0.6, 2);
    found = std::make_unique<Found>(m);
  }
};

TEST(AreasInView, AreNotThoseBehindAWallHoweverNear) {
  const CorridorBehindAHall scene;
  const Found& found = *scene.found;
  ASSERT_GE(found.lights.openings.size(), 17u);
  const Vec3 p = Vec3{7.5, 4.5, 1.5} - found.patches.origin, n{-0.8, -0.6, 0};
  const std::vector<AreaOver> over = areas_over(found.lights.openings, p, n, 8);
  const auto looks_along = [&](std::uint32_t k) { return found.lights.openings[k].normal.x > 0.5; };
  unsigned long long rays = 0;
  const std::vector<std::uint32_t> in_view = areas_in_view(
      found.rays, found.lights.openings, p, n, [&](std::uint32_t) { return p; }, {8, 0}, rays);
  ASSERT_EQ(in_view.size(), 1u);
  EXPECT_TRUE(looks_along(in_view[0]));
  EXPECT_GT(rays, 0u);
  for (std::size_t k = 1; k < over.size(); ++k) EXPECT_GE(over[k - 1].gives, over[k].gives);
  // What an opening cannot reach is not asked: its own is the first, though the hall's would give more.
  ASSERT_FALSE(over.empty());
  EXPECT_EQ(over[0].number, in_view[0]);
  std::vector<LightArea> of_unknown_reach = found.lights.openings;
  for (LightArea& o : of_unknown_reach) o.reach.reset();
  for (const AreaOver& area : areas_over(of_unknown_reach, p, n, 8)) EXPECT_FALSE(looks_along(area.number));
  EXPECT_EQ(areas_in_view(
                found.rays, of_unknown_reach, p, n, [&](std::uint32_t) { return p; }, {8, 0}, rays),
            in_view);
}

TEST(GatherPoint, FindsAWindowThatManyBehindAWallAreNearerThan) {
  const CorridorBehindAHall scene;
  const Problem problem{scene.found->patches, scene.found->rays, scene.found->lights};
  const Field dark(problem.patches.patch_count(), 1);
  const Vec3 p = Vec3{7.5, 4.5, 0.5} - problem.patches.origin, n{-0.8, -0.6, 0};
  const Illumination light(problem, dark);
  unsigned long long rays = 0;
  // Looking up through the window: sky of radiance 1 in all of it.
  double exact = 0;
  for (const LightArea& o : problem.lights.openings)
    if (o.normal.x > 0.5) exact += std::numbers::pi * form_factor(o, p, n);
  const double E = gather_point(light, p, n, GatherPattern(test::gather_quality({16, 256, 256}), 1), rays).E[0];
  EXPECT_NEAR(E / exact, 1, 2e-3);  // 0.4 % of the directions: by chance, one of the 256 rays, and 100 % off
}

TEST(DirectLight, ThroughOpeningsAndBundlesTogetherIsTheSkysLight) {
  // A window of 2 x 1 m; the bundle alone, with many rays, is the judge.
  SceneMaker m;
  add_sheets(m, false, true);
  add_holed_facade(m, 1, 1, 3, 2);
  Found found(m);
  const Lights with = found.lights;
  Lights without = with;
  without.openings.clear();
  const Problem some{found.patches, found.rays, with}, none{found.patches, found.rays, without};
  const DirectLight by_openings = direct_light(Illumination(some), {.sky_rays = 256});
  const DirectLight by_bundles = direct_light(Illumination(none), {.sky_rays = 16384});
  double sum = 0, judge = 0;
  for (std::size_t i = 0; i < found.patches.patch_count(); ++i) {
    sum += found.patches.area[i] * by_openings.E[i][0];
    judge += found.patches.area[i] * by_bundles.E[i][0];
  }
  EXPECT_NEAR(sum / judge, 1, 5e-3);  // 16,384 rays on each of some hundred patches
}

}  // namespace
}  // namespace clerestory
