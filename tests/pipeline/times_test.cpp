// Several times in one solve: each is what a solve of that time alone gives.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/at_time.h"
#include "pipeline/solve_scene.h"
#include "solver/model/light_of_times.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;

/// A clear sky and a sun; below the horizon no light at all.
LightSpec day(double elevation_deg, double azimuth_deg) {
  LightSpec light;
  const Vec3 sun = scene_direction({elevation_deg, azimuth_deg});
  const bool up = elevation_deg > 0;
  light.sky = Sky{.model = SkyModel::cie_clear,
                  .horizontal_irradiance = Spectrum(up ? 80 : 0),
                  .ground_reflectance = 0.2,
                  .shape = cie_clear_shape(),
                  .sun = sun};
  if (up) light.suns.push_back({sun, Spectrum(300)});
  return light;
}

void add_face(Scene& scene, const std::array<Vec3, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(scene.polygons.vertices.size());
  for (const Vec3& corner : corners) scene.polygons.add_vertex(corner);
  for (std::uint32_t k = 0; k < 4; ++k) scene.polygons.add_corner(first + k);
  scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
}

Scene scene_at_three_times() {
  Scene scene;
  scene.file = "court";
  scene.surfaces = {"court"};
  scene.materials.resize(1);
  scene.materials[0].name = "plaster";
  scene.materials[0].reflectance = Spectrum(0.5);
  scene.materials[0].sides = 1;
  scene.lights = mean_over_times({}, std::vector<LightSpec>{day(-10, 80), day(35, 120), day(50, 180)});
  scene.times.resize(3);
  return scene;
}

/// Floor and four walls of 4 x 3 x 2 m, open above.
Scene court() {
  Scene scene = scene_at_three_times();
  add_face(scene, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
  add_face(scene, {Vec3{0, 0, 2}, {4, 0, 2}, {4, 0, 0}, {0, 0, 0}});
  add_face(scene, {Vec3{0, 3, 0}, {4, 3, 0}, {4, 3, 2}, {0, 3, 2}});
  add_face(scene, {Vec3{0, 0, 0}, {0, 3, 0}, {0, 3, 2}, {0, 0, 2}});
  add_face(scene, {Vec3{4, 0, 2}, {4, 3, 2}, {4, 3, 0}, {4, 0, 0}});
  scene.sensors = {{.name = "floor", .points = {}}};
  for (const double x : {0.6, 1.5, 2.4, 3.3})
    for (const double y : {0.5, 1.4, 2.3}) scene.sensors[0].points.push_back({{x, y, 0.1}, {0, 0, 1}});
  return scene;
}

Scene open_plane() {
  Scene scene = scene_at_three_times();
  add_face(scene, {Vec3{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}});
  scene.sensors = {{.name = "ground", .points = {{{2, 1.5, 0.5}, {0, 0, 1}}}}};
  return scene;
}

/// Square root of the mean square of a - b, and of the mean of b; over all values.
struct Difference {
  double rms = 0, bias = 0;
};
Difference compare(const Field& a, const Field& b) {
  double squares = 0, sum = 0, mean = 0;
  for (std::size_t k = 0; k < b.value.size(); ++k) {
    const double d = a.value[k] - b.value[k];
    squares += d * d, sum += d, mean += b.value[k];
  }
  return {std::sqrt(squares * static_cast<double>(b.value.size())) / mean, sum / mean};
}

const Settings kDraft{.solve = {.accuracy = Accuracy::draft}};

TEST(Times, EachAgreesWithItsOwnSolveWithinTheErrorOfBoth) {
  const Scene scene = court();
  const Solved series = solve_scene(scene, kDraft);
  for (std::size_t t = 1; t < 3; ++t) {
    const Solved at_time = solved_at(series, t);
    Settings other = kDraft;
    other.solve.seed = 7;
    Scene own = court();
    own.lights = light_at(scene.lights, t), own.times.clear();
    const Solved alone = solve_scene(own, other);
    ASSERT_TRUE(at_time.error && at_time.error_sensors && alone.error && alone.error_sensors);
    const double expected = std::hypot(at_time.error_sensors->upper(), alone.error_sensors->upper());
    const Difference found = compare(at_time.sensor_E, alone.sensor_E);
    EXPECT_LE(found.rms, expected) << t;
    EXPECT_LE(std::abs(found.bias), expected) << t;
    EXPECT_NEAR(at_time.solution.energy.emitted, alone.solution.energy.emitted,
                0.01 * alone.solution.energy.emitted);  // both by rays, mostly within 0.3 %
    EXPECT_NEAR(at_time.solution.energy.imbalance(), 0, 0.01);
    EXPECT_LT(at_time.error->rms_relative, 0.1);  // edges of the sun on elements of a draft
  }
}

TEST(Times, TheirMeanIsTheJointSolve) {
  const Solved series = solve_scene(court(), kDraft);
  Field sum(series.lightmap.E.size(), 1);
  for (std::size_t t = 0; t < 3; ++t) {
    const Solved at_time = solved_at(series, t);
    for (std::size_t p = 0; p < sum.size(); ++p) sum.at(p, 0) += at_time.lightmap.E.at(p, 0) / 3;
  }
  EXPECT_LT(compare(sum, series.lightmap.E).rms, 1e-7);  // weights of rays are floats
}

TEST(Times, ANightIsDarkAndHasNoErrorToTell) {
  const Solved series = solve_scene(court(), kDraft), night = solved_at(series, 0);
  for (const Field* field : {&night.lightmap.E, &night.solution.E, &night.solution.B, &night.sensor_E})
    for (const double value : field->value) ASSERT_EQ(value, 0);
  EXPECT_EQ(night.solution.energy.emitted, 0);
  EXPECT_FALSE(night.error || night.error_sensors);
}

TEST(Times, AnOpenPlaneHasTheSkyTheSunAndTheGroundOfEach) {
  const Solved series = solve_scene(open_plane(), kDraft);
  for (const auto& [t, elevation] : {std::pair{1, 35.0}, std::pair{2, 50.0}}) {
    const Solved at_time = solved_at(series, static_cast<std::size_t>(t));
    const double sun = 300 * std::sin(elevation * kDegree);
    EXPECT_NEAR(at_time.sensor_E[0][0], 80 + sun, 0.002 * (80 + sun));  // rays of a draft's gather
    for (std::size_t p = 0; p < at_time.lightmap.E.size(); ++p) {
      const bool is_above = at_time.patches.normal[at_time.lightmap.patch_of_point[p]].z > 0;
      const double expected = (is_above ? 1 : 0.2) * (80 + sun);  // from below the virtual ground, as it is then
      EXPECT_NEAR(at_time.lightmap.E.at(p, 0), expected, 0.01 * expected);
    }
  }
}

TEST(Times, GiveTheSameBitsForAnyNumberOfThreads) {
  std::vector<Solved> found;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    found.push_back(solved_at(solve_scene(court(), kDraft), 2));
  }
  set_thread_count(0);
  EXPECT_EQ(found[0].lightmap.E.value, found[1].lightmap.E.value);
  EXPECT_EQ(found[0].solution.B.value, found[1].solution.B.value);
  EXPECT_EQ(found[0].sensor_E.value, found[1].sensor_E.value);
  ASSERT_TRUE(found[0].error && found[1].error);
  EXPECT_EQ(found[0].error->rms_relative, found[1].error->rms_relative);
}

}  // namespace
}  // namespace clerestory
