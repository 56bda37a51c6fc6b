// Hours as sums of coefficients: closed forms on open ground, and a room against its joint balance.

#include <algorithm>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/annual/year_light.h"
#include "solver/illumination/illumination.h"
#include "solver/methods/hierarchical.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "tests/support/many_lights.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

/// Fifty hours of days with the sun up and of dusk without it.
std::vector<DaylightHour> some_hours() {
  std::vector<DaylightHour> hours;
  for (int h = 0; h < 50; ++h) {
    DaylightHour& hour = hours.emplace_back();
    hour.hour = h;
    hour.sun = scene_direction({h % 7 == 0 ? -1.0 : 3.0 + h, 90.0 + 4 * h});
    hour.sun_up = hour.sun.z > 0;
    hour.sun_normal_irradiance = hour.sun_up ? 10.0 * (h % 11) : 0;
    hour.diffuse_horizontal_lux = 500.0 + 300 * h;
    hour.sky = {.model = SkyModel::perez,
                .horizontal_irradiance = Spectrum(hour.diffuse_horizontal_lux / kWhiteEfficacy),
                .ground_reflectance = 0.2,
                .shape = {.a = -0.5, .b = -0.4, .k = 1, .c = 0.2 * h, .d = -3, .e = 0.3},
                .sun = hour.sun};
  }
  return hours;
}

SunNodes nodes_of(const std::vector<DaylightHour>& hours) {
  std::vector<Vec3> suns;
  for (const DaylightHour& h : hours) suns.push_back(h.sun_up ? h.sun : Vec3{0, 0, 1});
  return place_sun_nodes(suns, 40, 0, 12);
}

TEST(SeriesOf, OpenGroundIsSkyAndSunOfEachHour) {
  const std::vector<DaylightHour> hours = some_hours();
  const SkyParts fine(577), coarse(145);
  const SunNodes nodes = nodes_of(hours);
  const YearLight year = light_of_year(hours, fine, coarse, nodes);
  const std::size_t H = hours.size();
  for (const Vec3& n : {Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
    std::vector<PointCoefficients> point(1);
    point[0].straight = fine.on_plane(n);
    point[0].reflected.assign(coarse.count() + 1 + nodes.direction.size(), 0.0f);
    std::vector<float> sun(H), total(H), direct(H);
    for (std::size_t h = 0; h < H; ++h) sun[h] = static_cast<float>(std::max(0.0, dot(n, hours[h].sun)));
    series_of(year, point, sun, total, direct);
    for (std::size_t h = 0; h < H; ++h) {
      const double of_sun = hours[h].direct_normal_lux() * std::max(0.0, hours[h].sun.z);
      const double level = hours[h].diffuse_horizontal_lux + of_sun;
      // From below, the virtual ground, which both light. Sums of floats.
      EXPECT_NEAR(total[h], n.z > 0 ? level : 0.2 * level, 1e-5 * level) << h;
      EXPECT_NEAR(direct[h], n.z > 0 ? of_sun : 0, 1e-5 * level) << h;
    }
  }
}

TEST(SeriesOf, APointHasTheSameBitsInAnyCompany) {
  const std::vector<DaylightHour> hours = some_hours();
  const SkyParts fine(145), coarse(145);
  const SunNodes nodes = nodes_of(hours);
  const YearLight year = light_of_year(hours, fine, coarse, nodes);
  const std::size_t H = hours.size(), lanes = coarse.count() + 1 + nodes.direction.size();
  std::vector<PointCoefficients> points(7);
  std::vector<float> sun(7 * H);
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p].straight.assign(fine.count() + 1, 0.0f), points[p].reflected.assign(lanes, 0.0f);
    for (std::size_t k = p; k < fine.count(); k += p + 2) points[p].straight[k] = 0.01f * static_cast<float>(k % 13);
    for (std::size_t l = 0; l < lanes; ++l) points[p].reflected[l] = 0.001f * static_cast<float>((l + p) % 17);
    for (std::size_t h = 0; h < H; ++h) sun[p * H + h] = static_cast<float>((h + p) % 5) / 7;
  }
  std::vector<float> total(7 * H), direct(7 * H), alone(H), alone_direct(H);
  series_of(year, points, sun, total, direct);
  for (std::size_t p = 0; p < points.size(); ++p) {
    series_of(year, std::span(points).subspan(p, 1), std::span(sun).subspan(p * H, H), alone, alone_direct);
    EXPECT_TRUE(std::equal(alone.begin(), alone.end(), &total[p * H])) << p;
    EXPECT_TRUE(std::equal(alone_direct.begin(), alone_direct.end(), &direct[p * H])) << p;
  }
}

TEST(LightOfYear, HasTheSameBitsForAnyNumberOfThreads) {
  const std::vector<DaylightHour> hours = some_hours();
  const SkyParts fine(145), coarse(145);
  const SunNodes nodes = nodes_of(hours);
  std::vector<std::vector<float>> found;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const YearLight year = light_of_year(hours, fine, coarse, nodes);
    std::vector<float>& of = found.emplace_back(year.sun);
    for (std::size_t h = 0; h < hours.size(); ++h)
      for (std::size_t k = 0; k < year.fine.parts(); ++k) of.push_back(year.fine.at(k, h));
  }
  set_thread_count(0);
  EXPECT_EQ(found[0], found[1]);
}

class ReflectDaylight : public testing::TestWithParam<int> {};

TEST_P(ReflectDaylight, PartsOfAnEvenSkySumToItsJointBalance) {
  const test::ManyLights room(GetParam());
  Lights lights = room.lights;
  lights.luminaires.clear(), lights.suns.clear();
  lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(kPi), .ground_reflectance = 1};
  PatchSet patches = room.patches;
  std::fill(patches.M.value.begin(), patches.M.value.end(), 0.0);
  const Problem problem{patches, room.rays, lights};
  KeptTransport kept;
  ElementMesh mesh(patches, room.map);
  HierarchyOptions options;
  options.shortest_edge = 0.3, options.keep = &kept;
  hierarchical(problem, mesh, options);
  ASSERT_TRUE(kept.complete);
  Layer sky;
  sky.sky = std::make_shared<const SkyRadiance>(lights);
  const Field joint = solve_for(kept, {&sky, 1}, 1e-6).B;

  const std::vector<Vec3> nodes{normalized(Vec3{0.3, -1, 0.7}), normalized(Vec3{0.2, 1, 0.7})};
  const SkyParts parts(145);
  std::vector<std::vector<float>> bits;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    bits.push_back(reflect_daylight(kept, patches, room.rays, parts, nodes, 1).B);
  }
  set_thread_count(0);
  EXPECT_EQ(bits[0], bits[1]);
  const ReflectedDaylight reflected = reflect_daylight(kept, patches, room.rays, parts, nodes, 1);
  ASSERT_EQ(reflected.lanes, parts.count() + 1 + nodes.size());
  ASSERT_EQ(reflected.channels, GetParam());
  // Radiance 1 from everywhere: every part of the sky, and the ground, which sends back all that it gets.
  double level = 0, off = 0, by_sun[2] = {};
  for (std::size_t i = 0; i < kept.elements.patch_count(); ++i)
    for (int c = 0; c < GetParam(); ++c) {
      const std::span<const float> lanes = reflected.of(i, c);
      double sum = 0;
      for (std::size_t l = 0; l <= parts.count(); ++l) sum += double{lanes[l]};
      const double area = kept.elements.area[i];
      level += area * joint.at(i, c), off += area * std::abs(sum - joint.at(i, c));
      for (std::size_t k = 0; k < 2; ++k) by_sun[k] += area * double{lanes[parts.count() + 1 + k]};
    }
  EXPECT_LT(off, 2e-4 * level);  // each lane's balance stops at 1e-4
  ASSERT_EQ(reflected.sun_ways.size(), 2u);
  EXPECT_FALSE(reflected.sun_ways[0].empty()) << "the pane turns some of its light";
  EXPECT_GT(by_sun[0], 0) << "the sun shines through the windows";
  EXPECT_EQ(by_sun[1], 0) << "from behind the room it does not";
}

INSTANTIATE_TEST_SUITE_P(Channels, ReflectDaylight, testing::Values(1, 3));

}  // namespace
}  // namespace clerestory
