#include "solver/paths/bidirectional.h"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "meshing/build_patches.h"
#include "solver/illumination/place_lights.h"
#include "solver/sampling/unit_square.h"
#include "solver/spaces/lit_sides.h"
#include "tests/meshing/mesh_checks.h"
#include "tests/support/many_lights.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

/// Patches and their light, ready for paths of both kinds.
struct Ready {
  PatchSet patches;
  RayScene rays{patches};
  Lights lights;
  Problem problem{patches, rays, lights};
  Illumination light;
  Bidirectional bidirectional{light};

  Ready(PatchSet set, const LightSpec& spec = {})
      : patches(std::move(set)), lights(place_lights(spec, patches, rays)), light(problem) {}

  PathEstimate by_path(const Vec3& p, const Vec3& n, std::uint64_t key, int paths) const {
    unsigned long long traced = 0;
    return trace_paths_at_point(light, p, n, key, paths, traced);
  }
  PathEstimate from_both_ends(const Vec3& p, const Vec3& n, std::uint64_t key, int paths) const {
    unsigned long long traced = 0;
    return trace_paths_at_point(bidirectional.estimator(), p, n, key, paths, traced);
  }
  /// Even over the area of all patches.
  std::vector<ReceivingPoint> points(std::size_t count) const {
    std::vector<ReceivingPoint> found;
    RandomStream random(5, count);
    while (found.size() < count) {
      double left = random.uniform() * patches.total_area();
      std::size_t i = 0;
      for (; i + 1 < patches.patch_count() && left >= patches.area[i]; ++i) left -= patches.area[i];
      const double u = random.uniform(), v = random.uniform();
      const Vec3 n = patches.normal[i];
      found.push_back({rays.off_surface(point_on_triangle(patches.corner_positions(PatchId{i}), u, v), n), n});
    }
    return found;
  }
};

/// At points all over a scene both kinds of paths mean the same light: their mean, and each point, within what they say
/// of themselves.
void expect_the_light_of_paths(const Ready& scene, std::size_t count, int paths) {
  double difference = 0, variance = 0, chi2 = 0, n = 0;
  const std::vector<ReceivingPoint> points = scene.points(count);
  for (std::size_t i = 0; i < count; ++i) {
    const PathEstimate one = scene.by_path(points[i].p, points[i].n, stream_key(1, i), paths);
    const PathEstimate both = scene.from_both_ends(points[i].p, points[i].n, stream_key(2, i), paths);
    for (int c = 0; c < scene.patches.channels; ++c) {
      const double d = both.E[c] - one.E[c], v = std::pow(both.std_error[c], 2) + std::pow(one.std_error[c], 2);
      EXPECT_GE(both.E[c], 0);
      if (v == 0) {
        EXPECT_NEAR(d, 0, 1e-9 * one.E[c]);
        continue;
      }
      difference += d, variance += v, chi2 += d * d / v, n += 1;
    }
  }
  // Channels of a point vary together: as if they were one.
  const double independent = n / scene.patches.channels;
  EXPECT_NEAR(difference, 0, 4 * std::sqrt(variance * scene.patches.channels));
  // Of two times eight replicates: Student's t of 14 degrees of freedom, whose square is 1.17 +- 1.96.
  EXPECT_LT(chi2 / n, 1.17 + 5 * 1.96 / std::sqrt(independent));
}

TEST(Bidirectional, KnowsTheLightOfAClosedRoomThatGlowsAllOver) {
  for (const double rho : {0.0, 0.5, 0.9}) {
    PatchBuilder b;
    b.material(rho, 10).box({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 1, 1}, true);
    const Ready room(b.build());
    const PathEstimate e = room.from_both_ends({0.2, 0.3, room.rays.lift()}, {0, 0, 1}, 1, 4096);
    EXPECT_NEAR(e.E[0], 10 / (1 - rho), 4 * e.std_error[0] + 1e-9) << rho;
    EXPECT_LT(e.std_error[0], 0.02 * 10 / (1 - rho));
  }
}

TEST(Bidirectional, OfALampInAClosedBoxTheMeanIsItsFluxOverWhatIsAbsorbed) {
  PatchBuilder b(0.6);
  b.box({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}, true);
  LightSpec spec;
  spec.luminaires = {test::point_lamp({0.3, 0.4, 0.95}, 10)};
  const Ready room(b.build(), spec);
  double sum = 0, variance = 0;
  const auto points = room.points(400);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathEstimate e = room.from_both_ends(points[i].p, points[i].n, i, 64);
    sum += e.E[0], variance += e.E[0] * e.E[0];
  }
  const double n = 400, mean = sum / n;
  EXPECT_NEAR(mean, 10 / (6 * 0.4), 4 * std::sqrt((variance / n - mean * mean) / n));
}

class BidirectionalByChannels : public ::testing::TestWithParam<int> {};
TEST_P(BidirectionalByChannels, MeansTheLightOfPathsInARoomOfAllKindsOfLight) {
  expect_the_light_of_paths({test::room_of_many_lights(GetParam()), test::ManyLights::spec(GetParam())}, 40, 1024);
}
INSTANTIATE_TEST_SUITE_P(, BidirectionalByChannels, ::testing::Values(1, 3));

TEST(Bidirectional, MeansTheLightOfAnOpeningThatIsNearToSomeAndFarFromOthers) {
  // Light comes from all over the opening up to 1.5 m, from its middle beyond.
  PhotometricWeb web;
  web.vertical = {0, 30, 60, 90, 120, 180}, web.horizontal = {0, 90, 180, 270, 360};
  for (int h = 0; h < 5; ++h)
    for (const float I : {100.0f, 80.0f, 60.0f, 50.0f, 40.0f, 10.0f}) web.candela.push_back(I * (h % 2 ? 1.0f : 0.5f));
  web.opening.size = {0.15, 0.1, 0};
  web.flux = luminous_flux(web);
  LightSpec spec;
  spec.luminaires = {
      {"lamp", {0.5, 0.6, 2}, {}, WebLuminaire{std::make_shared<const PhotometricWeb>(web), {}, Spectrum(0.01)}}};
  PatchBuilder b(0.6);
  b.box({0, 0, 0}, {3, 0, 0}, {0, 2, 0}, {0, 0, 2.2}, {2, 2, 2}, true);
  expect_the_light_of_paths({b.build(), spec}, 60, 1024);
}

/// A room of sheets with an open hole of 0.3 m in its ceiling.
PatchSet room_with_hole() {
  testing::SceneMaker m;
  m.polygon({{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}), m.polygon({{0, 0, 0}, {0, 0, 2.5}, {4, 0, 2.5}, {4, 0, 0}});
  m.polygon({{0, 3, 0}, {4, 3, 0}, {4, 3, 2.5}, {0, 3, 2.5}});
  m.polygon({{0, 0, 0}, {0, 3, 0}, {0, 3, 2.5}, {0, 0, 2.5}});
  m.polygon({{4, 0, 0}, {4, 0, 2.5}, {4, 3, 2.5}, {4, 3, 0}});
  const auto ceiling = [&](double x0, double y0, double x1, double y1) {
    m.polygon({{x0, y0, 2.5}, {x0, y1, 2.5}, {x1, y1, 2.5}, {x1, y0, 2.5}});
  };
  ceiling(0, 0, 1, 3), ceiling(1.3, 0, 4, 3), ceiling(1, 0, 1.3, 1), ceiling(1, 1.3, 1.3, 3);
  PatchSet patches = std::move(build_patches(m.scene(), {.max_element = 1}).patches);
  make_patches(patches, std::vector<bool>(2 * patches.triangle_count(), true));
  return patches;
}

TEST(Bidirectional, FindsTheSunThroughAHoleWherePathsSeldomDo) {
  LightSpec spec;
  spec.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(1.0)};
  spec.suns = {{normalized(Vec3{0.3, 0.2, 1}), Spectrum(300)}};
  const Ready room(room_with_hole(), spec);
  ASSERT_EQ(room.lights.openings.size(), 1u);
  expect_the_light_of_paths(room, 24, 4096);
  const Vec3 p = Vec3{3, 2, 1} - room.patches.origin, n{0, 0, -1};
  // A path finds the sun's patch, 0.1 m2 of 59, once in some hundred bounces.
  EXPECT_LT(room.from_both_ends(p, n, 1, 4096).std_error[0], 0.3 * room.by_path(p, n, 1, 4096).std_error[0]);
}

TEST(Bidirectional, FindsALampThatShinesOnTheCeilingAlone) {
  PatchBuilder b(0.6);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {1, 1, 1}, true);
  b.box({1, 1, 2.2}, {0.2, 0, 0}, {0, 0.2, 0}, {0, 0, 0.01}, {1, 1, 1}, false);  // a shade below
  LightSpec spec;
  spec.luminaires = {test::point_lamp({1.1, 1.1, 2.25}, 100)};
  const Ready room(b.build(), spec);
  expect_the_light_of_paths(room, 24, 2048);
  const Vec3 p{3, 2, 0.8}, n{0, 0, 1};
  EXPECT_LT(room.from_both_ends(p, n, 1, 4096).std_error[0], 0.35 * room.by_path(p, n, 1, 4096).std_error[0]);
}

TEST(Bidirectional, MeansTheLightOfPathsBetweenMirrorsAndPanes) {
  // A lamp and the sun over two mirrors and a pane, in all ways that have images.
  PatchBuilder b(0.6);
  b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0}), b.rectangle({0, 0, 0}, {0, 0, 2.5}, {4, 0, 0});
  b.rectangle({0, 3, 0}, {4, 0, 0}, {0, 0, 2.5}), b.rectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 2.5});
  b.rectangle({4, 0, 0}, {0, 0, 2.5}, {0, 3, 0}), b.rectangle({0, 0, 2.5}, {0, 3, 0}, {3, 0, 0});
  b.mirror(0.9).rectangle({0.01, 0.5, 0.5}, {0, 2, 0}, {0, 0, 1.5}),
      b.rectangle({3.99, 0.5, 0.5}, {0, 2, 0}, {0, 0, 1.5});
  b.rectangle({2.6, 1, 0.05}, {1, 0, 0}, {0, 1, 0});
  b.glass(0.6).rectangle({1, 0, 0}, {0, 3, 0}, {0, 0, 2.5});
  LightSpec spec;
  spec.luminaires = {test::point_lamp({2, 1.2, 1}, 30)};
  spec.suns = {{normalized(Vec3{0.1, 0.1, 1}), Spectrum(100)}};
  const Ready room(b.build(), spec);
  ASSERT_GT(room.lights.luminaires.size(), 5u);
  ASSERT_GT(room.lights.suns.size(), 1u);
  expect_the_light_of_paths(room, 32, 2048);
}

TEST(Bidirectional, FindsALampThatAMirrorThrowsOnTheWall) {
  // A spot that shines down on a mirror at its foot, which turns it to the wall at x = 4.
  PatchBuilder b(0.6);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {0, 0, 2.5}, {1, 1, 1}, true);
  b.mirror(0.9).rectangle({1, 1, 0.6}, {0.2, 0, -0.2}, {0, 0.2, 0});
  LightSpec spec;
  spec.luminaires = {test::spot_lamp({1.1, 1.1, 0.9}, {0, 0, -1}, 100, 0.1, 0.15)};
  const Ready room(b.build(), spec);
  expect_the_light_of_paths(room, 24, 2048);
  const Vec3 p{3, 2, 0.8}, n{0, 0, 1};
  EXPECT_LT(room.from_both_ends(p, n, 1, 4096).std_error[0], 0.25 * room.by_path(p, n, 1, 4096).std_error[0]);
}

TEST(Bidirectional, KnowsTheLightOfAClosedRoomOfGlossThatGlowsAllOver) {
  for (const Gloss& gloss : {Gloss{Spectrum(0.4), {}, 0.3}, Gloss{Spectrum(0.4), 5.0}}) {
    PatchBuilder b;
    b.glossy(0.3, gloss, 100).box({0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, 1}, {1, 1, 1}, true);
    const Ready room(b.build());
    // Of a lobe of modified Phong less goes on than its number where it is cut by the surface.
    const PathEstimate e = room.from_both_ends({0.2, 0.3, room.rays.lift()}, {0, 0, 1}, 1, 8192);
    const PathEstimate exact = gloss.exponent ? room.by_path({0.2, 0.3, room.rays.lift()}, {0, 0, 1}, 2, 8192)
                                              : PathEstimate{Spectrum(100 / (1 - 0.3 - 0.4)), Spectrum(0.0)};
    EXPECT_NEAR(e.E[0], exact.E[0], 4 * std::hypot(e.std_error[0], exact.std_error[0]));
    EXPECT_LT(e.std_error[0], 0.02 * exact.E[0]);
  }
}

struct NamedGloss {
  const char* name;
  Gloss gloss;
};
void PrintTo(const NamedGloss& g, std::ostream* out) { *out << g.name; }

class BidirectionalByLobe : public ::testing::TestWithParam<NamedGloss> {};
TEST_P(BidirectionalByLobe, MeansTheLightOfPathsInAPolishedRoom) {
  // Lamps, a panel, sky and sun by a hole; floor and a wall are glossy, and so is a table below.
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 2.5}, {0, 3, 0}, {3, 0, 0}), b.rectangle({0, 0, 0}, {0, 0, 2.5}, {4, 0, 0});
  b.rectangle({0, 3, 0}, {4, 0, 0}, {0, 0, 2.5}), b.rectangle({4, 0, 0}, {0, 0, 2.5}, {0, 3, 0});
  b.glossy(0.2, GetParam().gloss).rectangle({0, 0, 0}, {4, 0, 0}, {0, 3, 0});
  b.glossy(0.3, GetParam().gloss).rectangle({0, 0, 0}, {0, 3, 0}, {0, 0, 2.5});
  b.glossy(0.1, GetParam().gloss).box({1.5, 1, 0.7}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.05}, {1, 1, 1}, false);
  b.material(0.3, 50).rectangle({1, 2.99, 1.2}, {0.5, 0, 0}, {0, 0, 0.4});
  b.glass(0.7).rectangle({3, 0.5, 0}, {0, 2, 0}, {0, 0, 2.5});
  b.mirror(0.8).rectangle({0.5, 0.02, 0.5}, {0, 0, 1}, {1, 0, 0});
  LightSpec spec;
  spec.luminaires = {test::point_lamp({1, 1, 2}, 30), test::point_lamp({2, 2, 0.4}, 10)};
  spec.sky = Sky{.model = SkyModel::cie_overcast, .horizontal_irradiance = Spectrum(60)};
  spec.suns = {{normalized(Vec3{0.3, 0.2, 1}), Spectrum(200)}};
  expect_the_light_of_paths({b.build(), spec}, 24, 1024);
}
INSTANTIATE_TEST_SUITE_P(, BidirectionalByLobe,
                         ::testing::Values(NamedGloss{"exponent 0", {Spectrum(0.5), 0.0}},
                                           NamedGloss{"exponent 20", {Spectrum(0.5), 20.0}},
                                           NamedGloss{"roughness 0.6", {Spectrum(0.4), {}, 0.6}},
                                           NamedGloss{"roughness 0.3", {Spectrum(0.5), {}, 0.3}}));

class ShippedScene : public ::testing::TestWithParam<const char*> {};
TEST_P(ShippedScene, HasTheSameLightFromBothEnds) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "data/scenes";
  const Scene scene = read_scene(folder / (std::string(GetParam()) + ".json"));
  PatchSet patches = std::move(build_patches(scene, {.max_element = 1e3}).patches);  // paths need no fine mesh
  patches.channels = scene.channels();
  {
    const RayScene rays(patches);
    const Lights lights = place_lights(scene.lights, patches, rays);
    make_patches(patches, find_lit_sides({patches, rays, lights}, 1).wanted);
  }
  expect_the_light_of_paths({std::move(patches), scene.lights}, 24, 256);
}
INSTANTIATE_TEST_SUITE_P(, ShippedScene,
                         ::testing::Values("classroom", "cornell_box", "furnace", "house", "light_shelf", "office",
                                           "office_march", "office_night", "parallel_plates"));

}  // namespace
}  // namespace clerestory
