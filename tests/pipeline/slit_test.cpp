// A partition that ends a little under the ceiling: what comes over it is in proportion to the slit.

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/solve_scene.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// Two rooms of 3 x 4 x 3 m under one ceiling, turned by 33 degrees. One has a floor and walls that glow with 1000
/// lm/m2 and reflect nothing; all else reflects a half. The partition is a sheet.
Scene two_rooms(double gap) {
  Scene scene;
  scene.file = "two rooms";
  scene.surfaces = {"room"};
  Material& grey = scene.materials.emplace_back();
  grey.name = "grey", grey.reflectance = Spectrum(0.5);
  Material& glowing = scene.materials.emplace_back();
  glowing.name = "glowing", glowing.reflectance = Spectrum(0.0);
  glowing.exitance = Spectrum(1000 / kWhiteEfficacy);
  const auto turned = [](const Vec3& p) {
    const double c = std::cos(0.576), s = std::sin(0.576);
    return Vec3{c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  };
  const auto quad = [&](std::size_t material, const std::array<Vec3, 4>& corners) {
    for (const Vec3& p : corners) {
      scene.polygons.add_corner(static_cast<std::uint32_t>(scene.polygons.vertices.size()));
      scene.polygons.add_vertex(turned(p));
    }
    scene.polygons.end_face(MaterialId{material}, SurfaceId{std::size_t{0}});
  };
  for (const std::size_t room : {0u, 1u}) {
    const double x = 3.0 * static_cast<double>(room), end = room == 0 ? 0 : 6;
    quad(room, {{{x, 0, 0}, {x + 3, 0, 0}, {x + 3, 4, 0}, {x, 4, 0}}});
    quad(room, {{{x, 0, 0}, {x, 0, 3}, {x + 3, 0, 3}, {x + 3, 0, 0}}});
    quad(room, {{{x, 4, 0}, {x + 3, 4, 0}, {x + 3, 4, 3}, {x, 4, 3}}});
    quad(room, {{{end, 0, 0}, {end, 4, 0}, {end, 4, 3}, {end, 0, 3}}});
  }
  quad(0, {{{0, 0, 3}, {0, 4, 3}, {6, 4, 3}, {6, 0, 3}}});
  quad(0, {{{3, 0, 0}, {3, 4, 0}, {3, 4, 3 - gap}, {3, 0, 3 - gap}}});
  std::vector<SensorPoint> points;
  for (const Vec3& p : {Vec3{1.5, 2, 0.85}, {0.5, 2, 0.02}, {2.5, 2, 0.02}, {1.5, 2, 2}, {1.5, 0.5, 1.5}})
    points.push_back({turned(p), {0, 0, 1}});
  scene.sensors = {{.name = "dark room", .points = points}};
  return scene;
}

/// Mean illuminance [lx] of the five points in the dark room.
double light_over_the_partition(double gap) {
  const Solved solved = solve_scene(two_rooms(gap), {.solve = {.accuracy = Accuracy::draft}, .max_element = 0.25});
  double sum = 0;
  for (std::size_t i = 0; i < 5; ++i) sum += photometric(solved.sensor_E[i]) / 5;
  return sum;
}

TEST(Slit, LightThatComesOverAPartitionIsInProportionToTheGapAndNoneWithoutIt) {
  EXPECT_EQ(light_over_the_partition(0), 0);
  // Reference: an independent tracer of lines through the slit, in double precision, 400,000 of them: 0.1 %. The slit
  // admits 650 lx of its area, so the room's mean is near 0.072 lx for a millimetre.
  const double tenth = light_over_the_partition(1e-4), one = light_over_the_partition(1e-3),
               ten = light_over_the_partition(1e-2);
  // Elements of a quarter metre spread what falls on millimetres of the ceiling: measured 7 to 21 % more, two seeds.
  std::printf("over the partition, of the tracer: %.3f %.3f %.3f\n", tenth / 0.00551, one / 0.0554, ten / 0.563);
  EXPECT_NEAR(tenth / 0.00551, 1, 0.25);
  EXPECT_NEAR(one / 0.0554, 1, 0.25);
  EXPECT_NEAR(ten / 0.563, 1, 0.25);
  EXPECT_NEAR(one / tenth, 10, 0.2 * 10);  // the bar of the issue: proportional to the slit within 20 %
  EXPECT_NEAR(ten / one, 10, 0.2 * 10);
}

}  // namespace
}  // namespace clerestory
