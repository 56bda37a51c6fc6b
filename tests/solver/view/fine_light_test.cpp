// Light at the very place that is seen: closed forms of lamps, the sun and furnaces.

#include "solver/view/fine_light.h"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "solver/model/parallel.h"
#include "solver/view/rest_of_light.h"
#include "solver/view/trace_view.h"
#include "tests/support/flat_result.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
constexpr double kPi = std::numbers::pi;
constexpr double kRest = 5;  // [W/m2]

/// A floor of 4 x 4 m around the origin, rho = 0.5, in n x n squares, and a plate that may hang above it.
struct LitFloor {
  LitFloor(std::uint32_t n, Lights with, bool has_plate, const std::optional<Gloss>& gloss = {})
      : patches(build(has_plate)), rays(patches), lights(std::move(with)) {
    if (gloss) result.materials[0].kind = MaterialKind::glossy, result.materials[0].gloss = gloss;
    add_rectangle(result, {-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, n, [](const Vec3&) { return kRest; });
    triangles.resize(result.triangles.size());
    std::iota(triangles.begin(), triangles.end(), 0u);
  }
  static PatchSet build(bool has_plate) {
    PatchBuilder floor;
    floor.rectangle({-2, -2, 0}, {4, 0, 0}, {0, 4, 0});
    if (has_plate) floor.rectangle({-0.5, -0.5, 1}, {1, 0, 0}, {0, 1, 0});
    return floor.build();
  }
  /// The solve has that at the vertices.
  void add_field(const auto& E) {
    for (std::size_t p = 0; p < result.points.size(); ++p) {
      const auto more = static_cast<float>(E(result.points[p]));
      result.of_points["irradiance"].value[p] += more;
      result.of_points["radiosity"].value[p] += more / 2;
    }
  }
  ViewImage seen(ShownField rest, const Camera& camera, int samples = 1) const {
    const FineLight light(problem);
    return ViewScene(result, std::move(rest), triangles).trace(camera, {.samples = samples, .fine = &light});
  }

  PatchSet patches;
  RayScene rays;
  Lights lights;
  Problem problem{patches, rays, lights};
  WrittenResult result = empty_result();
  std::vector<std::uint32_t> triangles;
};

/// Straight down on the floor, 20 x 20 pixels of 0.2 m; pixel (x, y) from the upper left.
Camera from_above() {
  Camera camera;
  camera.kind = CameraKind::orthographic, camera.width = camera.height = 20, camera.half_width = 2;
  camera.eye = {0, 0, 0.5}, camera.turn({0, 0, -1}, {0, 1, 0});
  return camera;
}
Vec3 middle_of_pixel(int x, int y) { return {(x + 0.5) / 5 - 2, 2 - (y + 0.5) / 5, 0}; }
double at(const ViewImage& image, int x, int y) { return double{image.value[static_cast<std::size_t>(20 * y + x)]}; }

/// 1 W/sr at a height of 2 m.
Lights lamp() {
  Lights lights;
  lights.luminaires = {test::point_lamp({0, 0, 2}, 4 * kPi)};
  return lights;
}
double of_lamp(const Vec3& p) { return 2 / std::pow(4 + p.x * p.x + p.y * p.y, 1.5); }
/// Half of the plate's shadow is 1 m, twice as large as it: the plate hangs half way.
bool in_shadow(const Vec3& p) { return std::abs(p.x) < 1 && std::abs(p.y) < 1; }

TEST(FineLight, HasShadowsSharperThanTheMesh) {
  LitFloor floor(4, lamp(), true);  // squares of 1 m, the edge of the shadow along them
  floor.add_field([](const Vec3& p) { return in_shadow(p) ? 0 : of_lamp(p); });  // so its edge counts as lit
  const ViewImage image =
      floor.seen(illuminance_of(rest_of_light(floor.result, FineLight(floor.problem))), from_above());
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      const Vec3 p = middle_of_pixel(x, y);                      // 0.1 m off the edge and more
      const double E = kRest + (in_shadow(p) ? 0 : of_lamp(p));  // points of a result look from a little beside
      EXPECT_NEAR(at(image, x, y), 179 * E, 1e-4 * 179 * E) << p.x << ' ' << p.y;
    }
}

TEST(FineLight, LeavesTheSameRestWhicheverSideOfAShadowsEdgeThePointsOfAResultCountTo) {
  for (const bool edge_is_lit : {false, true}) {
    LitFloor floor(8, lamp(), true);
    floor.add_field([&](const Vec3& p) {
      const double outside = std::max(std::abs(p.x), std::abs(p.y)) - 1;
      return (edge_is_lit ? outside >= 0 : outside > 0) ? of_lamp(p) : 0;
    });
    const Field rest = rest_of_light(floor.result, FineLight(floor.problem));
    for (std::size_t p = 0; p < rest.size(); ++p) EXPECT_NEAR(rest.at(p, 0), kRest, 2e-3 * kRest) << edge_is_lit;
  }
}

TEST(FineLight, IsTheFieldWhereNothingCastsAShadow) {
  LitFloor floor(40, lamp(), false);
  floor.add_field(of_lamp);
  const ViewImage as_solved =
      ViewScene(floor.result, radiance_of(floor.result), floor.triangles).trace(from_above(), {});
  const ViewImage by_rays =
      floor.seen(radiance_of(floor.result, rest_of_light(floor.result, FineLight(floor.problem))), from_above());
  for (std::size_t i = 0; i < as_solved.pixels(); ++i)
    EXPECT_NEAR(double{by_rays.value[i]}, double{as_solved.value[i]}, 2e-3 * double{as_solved.value[i]});
}

TEST(FineLight, ShowsALampsHighlightAsTheLobeHasIt) {
  const double specular = 0.4, exponent = 50;
  LitFloor floor(1, lamp(), false, Gloss{Spectrum(specular), exponent, 1});
  const ViewImage image = floor.seen(radiance_of(floor.result, Field(floor.result.points.size(), 1)), from_above());
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) {
      // Seen from straight above: the mirror's direction of the eye is up, at the lamp's own cosine 2 / r.
      const Vec3 p = middle_of_pixel(x, y);
      const double cosine = 2 / std::sqrt(4 + dot(p, p));
      const double lobe = specular * (exponent + 2) / (2 * kPi) * std::pow(cosine, exponent);
      const double L = (0.5 / kPi + lobe) * of_lamp(p);
      EXPECT_NEAR(at(image, x, y), L, 1e-4 * L);
    }
}

TEST(FineLight, FallsOnFacetsAsOnTheSurfaceThatTheyStandFor) {
  // A cylinder of 2 m around the y axis in facets of 10 degrees that share their points; the sun right above.
  WrittenResult r = empty_result();
  for (int i = 0; i <= 18; ++i)
    for (const double y : {-2.0, 2.0}) {
      const double angle = i * kPi / 18;
      r.points.push_back({std::cos(angle), y, std::sin(angle) - 2});
    }
  for (std::uint32_t a = 0; a < 36; a += 2)
    r.triangles.push_back({a, a + 3, a + 2}), r.triangles.push_back({a, a + 1, a + 3});
  r.material.assign(36, 0), r.surface.assign(36, 0);
  PatchBuilder facets;
  for (const auto& [a, b, c] : r.triangles) facets.triangle(r.points[a], r.points[b], r.points[c]);
  const PatchSet patches = facets.build();
  const RayScene rays(patches);
  Lights lights;
  lights.suns = {{Sun{{0, 0, 1}, Spectrum(100.0)}}};
  const Problem problem{patches, rays, lights};
  const FineLight light(problem);
  std::vector<std::uint32_t> all(36);
  std::iota(all.begin(), all.end(), 0u);
  const ViewScene scene(r, illuminance_of(Field(r.points.size(), 1)), all);
  const ViewImage image = scene.trace(from_above(), {.samples = 1, .fine = &light});
  for (int x = 6; x < 14; ++x) {
    const double across = middle_of_pixel(x, 10).x, exact = 179 * 100 * std::sqrt(1 - across * across);
    // Chords lie inside, by 1 - cos 5 degrees; a ray to the rim of the disc is off by 0.27 degrees.
    EXPECT_NEAR(at(image, x, 10), exact, 0.009 * exact) << across;
  }
}

TEST(FineLight, LeavesTheBacksOfOneSidedMaterialsBlack) {
  LitFloor floor(1, lamp(), false);
  for (float& B : floor.result.of_points["radiosity"].value) B = 0;
  const ViewImage image = floor.seen(radiance_of(floor.result, Field(floor.result.points.size(), 1)), from_above());
  for (const float value : image.value) EXPECT_EQ(value, 0);
}

TEST(FineLight, ShowsTheSunsPenumbraAsWideAsItsDisc) {
  // Right under the edge of the plate, 1 m above: half of the disc is seen; 4.65 mm to either side all or nothing.
  Lights lights;
  lights.suns = {{Sun{{0, 0, 1}, Spectrum(100.0)}}};
  const LitFloor floor(1, lights, true);
  Camera camera = from_above();
  const auto mean = [&](double off) {
    camera.eye = {0.5 + off, 0, 0.5}, camera.half_width = 1e-5, camera.width = camera.height = 4;
    const ViewImage image = floor.seen(illuminance_of(Field(floor.result.points.size(), 1)), camera, 64);
    return std::accumulate(image.value.begin(), image.value.end(), 0.0) / 16 / (179 * 100);
  };
  EXPECT_EQ(mean(-0.0048), 0);
  EXPECT_NEAR(mean(0), 0.5, 0.02);  // of 1024 places, spread: the standard error is 0.016 at most
  EXPECT_NEAR(mean(0.0048), 1, 1e-4);
}

TEST(FineLight, GivesManyLampsTheirSumByFewRays) {
  for (const int count : {30, 200}) {
    Lights lights;
    for (int i = 0; i < count; ++i)
      lights.luminaires.push_back(test::point_lamp({2 * std::cos(i), 2 * std::sin(2.0 * i), 1.2 + i % 3}, 1 + i % 7));
    const LitFloor floor(1, lights, true);
    const ViewImage image = floor.seen(illuminance_of(Field(floor.result.points.size(), 1)), from_above(), 64);
    double sum = 0, exact = 0;
    for (int y = 0; y < 20; y += 3)
      for (int x = 0; x < 20; x += 3) {
        const Vec3 p = middle_of_pixel(x, y);
        sum += at(image, x, y) / 179;
        for (const PlacedLuminaire& lamp : lights.luminaires) {
          const Vec3 to = lamp.position - p;
          const double share = 1 / to.z;  // of the way to the plane of the plate
          const Vec3 crossing = p + to * share;
          if (std::abs(crossing.x) < 0.5 && std::abs(crossing.y) < 0.5 && to.z > 1) continue;
          exact += test::as_point(lamp).power[0] / (4 * kPi) * to.z / std::pow(dot(to, to), 1.5);
        }
      }
    EXPECT_NEAR(sum, exact, 0.01 * exact) << count;  // edges of shadows go through some of the 49 pixels
  }
}

/// A room of 4 m that glows: every surface sends radiance L.
TEST(FineLight, AFinalGatherInAFurnaceIsTheFurnace) {
  constexpr double kL = 7;
  WrittenResult r = empty_result();
  const std::array<std::array<Vec3, 3>, 6> walls = {{{Vec3{0, 0, 0}, {4, 0, 0}, {0, 4, 0}},
                                                     {Vec3{0, 0, 4}, {0, 4, 0}, {4, 0, 0}},
                                                     {Vec3{0, 0, 0}, {0, 4, 0}, {0, 0, 4}},
                                                     {Vec3{4, 0, 0}, {0, 0, 4}, {0, 4, 0}},
                                                     {Vec3{0, 0, 0}, {0, 0, 4}, {4, 0, 0}},
                                                     {Vec3{0, 4, 0}, {4, 0, 0}, {0, 0, 4}}}};
  for (const auto& [corner, u, v] : walls) add_rectangle(r, corner, u, v, 1, [](const Vec3&) { return kPi * kL; });
  for (float& B : r.of_points["radiosity"].value) B = static_cast<float>(kPi * kL);
  std::vector<std::uint32_t> all(r.triangles.size());
  std::iota(all.begin(), all.end(), 0u);
  const PatchSet patches = PatchBuilder().box({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}, {1, 1, 1}, true).build();
  const RayScene rays(patches);
  const Lights dark;
  const Problem problem{patches, rays, dark};
  const FineLight light(problem);
  const ViewScene around(r, radiance_of(r), all), own(r, radiance_of(r, Field(r.points.size(), 1)), all);
  Camera camera;
  camera.width = camera.height = 16, camera.eye = {1, 1, 1}, camera.turn({1, 1, 0.3}, {0, 0, 1});
  const auto picture = [&] {
    return own.trace(camera, {.samples = 4, .fine = &light, .gather = 16, .around = &around});
  };
  const ViewImage image = picture();
  for (const float value : image.value) EXPECT_NEAR(double{value}, kL, 1e-5 * kL);
  set_thread_count(1);
  EXPECT_EQ(picture().value, image.value);
  set_thread_count(0);
}

TEST(FineLight, BitsDoNotDependOnThreads) {
  Lights lights = lamp();
  lights.suns = {{Sun{normalized({0.2, 0.1, 1}), Spectrum(3.0)}}};
  LitFloor floor(8, lights, true, Gloss{Spectrum(0.4), {}, 0.3});
  floor.add_field(of_lamp);
  const auto picture = [&] {
    return floor.seen(radiance_of(floor.result, rest_of_light(floor.result, FineLight(floor.problem))), from_above(),
                      4);
  };
  const ViewImage by_all = picture();
  set_thread_count(1);
  EXPECT_EQ(picture().value, by_all.value);
  set_thread_count(0);
}

}  // namespace
}  // namespace clerestory
