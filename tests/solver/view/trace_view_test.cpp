// Pictures of light that is known.

#include "solver/view/trace_view.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "solver/model/parallel.h"
#include "solver/view/visible_line.h"
#include "tests/support/small_result.h"

namespace clerestory {
namespace {

ShownField illuminance_of(const WrittenResult& r) { return {1, r.of_points.at("illuminance").value, false}; }

ViewScene scene_of(const WrittenResult& r, ShownField field) {
  std::vector<std::uint32_t> all(r.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  return {r, std::move(field), all};
}

/// From the origin along +y.
Camera looks_north(CameraKind kind, double half_width, int size = 32) {
  Camera camera;
  camera.kind = kind, camera.width = camera.height = size, camera.half_width = half_width;
  camera.turn({0, 1, 0}, {0, 0, 1});
  return camera;
}
/// Parallel rays over [-0.5, 0.5]^2.
const Camera kStraight = looks_north(CameraKind::orthographic, 0.5, 8);

void expect_all(const ViewImage& image, double value, double seen) {
  ASSERT_FALSE(image.empty());
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    ASSERT_NEAR(double{image.value[i]}, value, 1e-5 * value) << i;
    ASSERT_NEAR(double{image.seen[i]}, seen, 1e-5) << i;
  }
}

TEST(TraceView, ShowsOneRadianceEverywhereInAFurnace) {
  WrittenResult r = empty_result();
  add_room(r, 7, 100);
  const ViewScene scene = scene_of(r, radiance_of(r));
  expect_all(scene.trace(looks_north(CameraKind::perspective, 1), {}), 7, 1);
  expect_all(scene_of(r, illuminance_of(r)).trace(looks_north(CameraKind::perspective, 1), {}), 100, 1);
  const ViewImage round = scene.trace(looks_north(CameraKind::fisheye, 1), {});
  EXPECT_NEAR(double{round.value[16 * 32 + 16]}, 7, 1e-5);
  EXPECT_EQ(round.seen[0], 0) << "beyond the circle";
  const double disc = std::accumulate(round.seen.begin(), round.seen.end(), 0.0) / 1024;
  EXPECT_NEAR(disc, std::numbers::pi / 4, 0.005);
}

TEST(TraceView, IsTheFieldOfTheResultItself) {
  // Linear on the only quad: 100 + 10 x + 3 z; a pixel's mean is the value at its middle.
  WrittenResult r = empty_result();
  add_quad(r, square_at(3), 1, {87, 107, 113, 93});
  for (const int samples : {1, 16}) {
    const ViewImage image = scene_of(r, illuminance_of(r)).trace(kStraight, {.samples = samples});
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const double exact = 100 + 10 * ((x + 0.5) / 8 - 0.5) + 3 * (0.5 - (y + 0.5) / 8);
        EXPECT_NEAR(double{image.value[static_cast<std::size_t>(8 * y + x)]}, exact, 1e-5 * exact);
      }
  }
}

TEST(TraceView, SeesSurfacesFromTheirLitSideOnly) {
  WrittenResult r = empty_result();
  add_quad(r, turned(square_at(1)), 5, 5);  // lit from behind
  add_quad(r, square_at(2), 3, 3);          // a sheet: both sides in one place
  add_quad(r, turned(square_at(2)), 9, 9);
  const ViewScene scene = scene_of(r, radiance_of(r));
  expect_all(scene.trace(kStraight, {}), 3, 1);
  Camera from_behind = kStraight;
  from_behind.eye = {0, 4, 0}, from_behind.turn({0, -1, 0}, {0, 0, 1});
  expect_all(scene.trace(from_behind, {}), 9, 1);
}

TEST(TraceView, ShowsInAMirrorWhatItMirrorsTimesItsReflectance) {
  WrittenResult r = empty_result();
  add_quad(r, turned(square_at(-5, 4)), 10, 10);  // behind the eye, seen from larger y
  Material mirror;
  mirror.kind = MaterialKind::mirror, mirror.reflectance = Spectrum(0.8);
  add_pane(r, square_at(3), mirror);
  add_quad(r, square_at(4), 77, 77);  // behind the mirror
  expect_all(scene_of(r, radiance_of(r)).trace(kStraight, {}), 8, 1);
  expect_all(scene_of(r, illuminance_of(r)).trace(kStraight, {}), 10, 1);
}

TEST(TraceView, ShowsOnAGlossySurfaceItsOwnLightAndWhatItsLobeMirrors) {
  WrittenResult r = empty_result();
  add_quad(r, turned(square_at(-50, 400)), 10, 10);  // behind the eye: all that a lobe sees
  add_quad(r, square_at(3), 4, 4);
  Material polished;
  polished.kind = MaterialKind::glossy, polished.gloss = Gloss{Spectrum(0.5), {}, 0.05};
  r.materials.push_back(polished);
  for (std::size_t t = r.material.size() - 2; t < r.material.size(); ++t)
    r.material[t] = static_cast<std::uint32_t>(r.materials.size() - 1);
  expect_all(scene_of(r, radiance_of(r)).trace(kStraight, {}), 4 + 0.5 * 10, 1);
  expect_all(scene_of(r, illuminance_of(r)).trace(kStraight, {}), 4, 1);
}

TEST(TraceView, CountsAllTurnsBetweenTwoMirrors) {
  // From between two mirrors straight into one: nothing but mirrors, ever darker, and in the end nothing.
  WrittenResult r = empty_result();
  add_room(r, 1, 1);
  Material mirror;
  mirror.kind = MaterialKind::mirror, mirror.reflectance = Spectrum(0.9);
  add_pane(r, square_at(1), mirror), add_pane(r, square_at(-1), mirror);
  expect_all(scene_of(r, radiance_of(r)).trace(kStraight, {}), 0, 1);
}

TEST(TraceView, ShowsThroughGlassWhatItPassesAndReflects) {
  WrittenResult r = empty_result();
  Material glass;
  glass.kind = MaterialKind::glass, glass.transmittance = Spectrum(0.65);
  add_pane(r, square_at(1), glass);
  add_quad(r, square_at(3), 10, 10);
  expect_all(scene_of(r, radiance_of(r)).trace(kStraight, {}), 0.65 * 10,
             1 - sheet_shares(fit_glass_sheet(0.65), 1).reflectance);
  add_quad(r, turned(square_at(-5, 4)), 30, 30);  // behind the eye
  const double turned_back = sheet_shares(fit_glass_sheet(0.65), 1).reflectance;
  EXPECT_GT(turned_back, 0.05);
  expect_all(scene_of(r, radiance_of(r)).trace(kStraight, {}), 0.65 * 10 + turned_back * 30, 1);
  expect_all(scene_of(r, illuminance_of(r)).trace(kStraight, {}), 10, 1);
}

TEST(TraceView, ClipsABrightReflectionAsMuchByOneRayOfFourAsByAll) {
  // Of 10,000 behind the eye a pane turns back a few per cent, far above the 5 that are white.
  WrittenResult r = empty_result();
  add_quad(r, square_at(3), 0, 0);
  add_quad(r, turned(square_at(-5, 4)), 10'000, 10'000);
  Material glass;
  glass.kind = MaterialKind::glass, glass.transmittance = Spectrum(0.65);
  add_pane(r, square_at(2), glass);
  const ViewScene scene = scene_of(r, radiance_of(r));
  for (const int samples : {15, 16}) {
    SCOPED_TRACE(samples);
    expect_all(scene.trace(kStraight, {.samples = samples, .most = 5}), 5, 1);
  }
}

TEST(TraceView, SeesTheSkyByRadianceOnly) {
  WrittenResult r = empty_result();
  add_quad(r, turned(square_at(-5)), 1, 1);
  r.around.sky.radiance = Field(SkyTable::kRows * SkyTable::kColumns, 1);
  std::ranges::fill(r.around.sky.radiance.value, 4.0);
  const ViewScene scene = scene_of(r, radiance_of(r));
  expect_all(scene.trace(kStraight, {}), 4, 1);
  expect_all(scene.trace(kStraight, {.sees_sky = false}), 0, 0);
  expect_all(scene_of(r, illuminance_of(r)).trace(kStraight, {}), 0, 0);
}

TEST(TraceView, IsTheSameFarFromTheOrigin) {
  WrittenResult near = empty_result();
  add_room(near, 2, 50);
  add_quad(near, square_at(1, 0.3), 9, 9);
  WrittenResult far = near;
  const Vec3 away{2.5e6, -5e6, 300};
  for (Vec3& p : far.points) p += away;
  Camera camera = looks_north(CameraKind::perspective, 1), far_camera = camera;
  far_camera.eye += away;
  const ViewImage a = scene_of(near, radiance_of(near)).trace(camera, {}),
                  b = scene_of(far, radiance_of(far)).trace(far_camera, {});
  for (std::size_t i = 0; i < a.pixels(); ++i) EXPECT_NEAR(double{a.value[i]}, double{b.value[i]}, 1e-3);
}

TEST(TraceView, HasTheSameBitsForAnyNumberOfThreads) {
  WrittenResult r = empty_result();
  add_room(r, 2, 50);
  Material glass;
  glass.kind = MaterialKind::glass, glass.transmittance = Spectrum(0.8, 0.7, 0.6);
  add_pane(r, square_at(1), glass), add_pane(r, square_at(1.1, 0.5), glass);
  const ViewScene scene = scene_of(r, radiance_of(r));
  const Camera camera = looks_north(CameraKind::perspective, 1.5, 100);
  set_thread_count(1);
  const ViewImage one = scene.trace(camera, {.samples = 5});
  set_thread_count(4);
  const ViewImage four = scene.trace(camera, {.samples = 5});
  set_thread_count(0);
  EXPECT_EQ(one.value, four.value);
  EXPECT_EQ(one.seen, four.seen);
}

TEST(TraceView, KnowsAnEyeInsideOfAWall) {
  WrittenResult r = empty_result();
  add_room(r, 1, 1);
  WrittenResult wall = empty_result();  // the same box seen from outside
  for (std::size_t i = 0; i < r.triangles.size(); ++i) std::swap(r.triangles[i][1], r.triangles[i][2]);
  EXPECT_GT(scene_of(r, radiance_of(r)).backs_around({0.3, 0.2, 0.1}), 0.99);
  for (std::size_t i = 0; i < r.triangles.size(); ++i) std::swap(r.triangles[i][1], r.triangles[i][2]);
  EXPECT_LT(scene_of(r, radiance_of(r)).backs_around({0.3, 0.2, 0.1}), 0.01);
  EXPECT_LT(scene_of(r, radiance_of(r)).backs_around({0, -6, 0}), 0.5) << "looking in from outside is no mistake";
}

TEST(VisibleParts, EndWhereSomethingStandsBefore) {
  // A line of 1.6 m on a wall, its middle third behind a smaller square.
  WrittenResult r = empty_result();
  add_quad(r, square_at(3), 1, 1);
  add_quad(r, square_at(2, 0.25), 1, 1);
  const ViewScene scene = scene_of(r, radiance_of(r));
  const Camera camera = looks_north(CameraKind::orthographic, 1, 400);
  const std::vector<Vec3> line{{-0.8, 3, 0}, {0.8, 3, 0}};
  const auto parts = visible_parts(camera, scene.surfaces(), line);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_NEAR(parts[0].front().x, 40, 1e-6);
  EXPECT_NEAR(parts[0].back().x, 150, 2.1);
  EXPECT_NEAR(parts[1].front().x, 250, 2.1);
  EXPECT_NEAR(parts[1].back().x, 360, 1e-6);
  EXPECT_EQ(facing_triangles(camera, r.points, scene.triangles()).size(), 4u);
  Camera away = camera;
  away.turn({0, -1, 0}, {0, 0, 1});
  EXPECT_TRUE(facing_triangles(away, r.points, scene.triangles()).empty());
}

}  // namespace
}  // namespace clerestory
