#include "solver/lights/layers.h"

#include <gtest/gtest.h>

#include "tests/support/many_lights.h"

namespace clerestory {
namespace {

std::vector<std::string> names_of(const std::vector<Layer>& layers) {
  std::vector<std::string> names;
  for (const Layer& layer : layers) names.push_back(layer.name);
  return names;
}

TEST(LayersByGroup, SkyAndSunEachLightTheGroundBelowTheHorizonAndSumToAllDaylight) {
  const test::ManyLights room(3);
  const SkyRadiance all(room.lights);
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  ASSERT_EQ(names_of(layers), (std::vector<std::string>{"left", "right", "middle", "sky", "sun", "emission"}));
  const SkyRadiance &sky = *layers[3].sky, &sun = *layers[4].sky;
  for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{0.6, 0, 0.8}, Vec3{0.6, 0, -0.8}, Vec3{0, 0, -1}})
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sky(d)[c] + sun(d)[c], all(d)[c], 1e-12 * all(d)[c]) << d.z;
  EXPECT_TRUE(sun({0, 0, 1}).is_black());
  // Lambert's ground: 0.2 / pi of what the sun gives on the horizontal.
  const Sun& disc = room.lights.suns.front();
  EXPECT_NEAR(sun({0, 0, -1})[0], 0.2 / std::numbers::pi * disc.normal_irradiance[0] * disc.direction.z, 1e-12);
}

TEST(LayersByGroup, ALuminaireGroupAndAMaterialGroupOfOneNameAreOneLayer) {
  test::ManyLights room(1);
  for (Material& m : room.patches.materials)
    if (m.emits()) m.group = "right";
  room.lights.sky.reset(), room.lights.suns.clear();
  for (PlacedLuminaire& luminaire : room.lights.luminaires)
    if (luminaire.group == "middle") luminaire.group.clear();
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  EXPECT_EQ(names_of(layers), (std::vector<std::string>{"left", "right", "luminaires"}));
  const Field M = exitance(room.patches, layers);
  double left = 0, right = 0;
  for (std::size_t i = 0; i < M.size(); ++i) {
    left += M.at(i, 0);
    right += M.at(i, 1);
    EXPECT_EQ(M.at(i, 1), room.patches.M.at(i, 0));
  }
  EXPECT_EQ(left, 0);
  EXPECT_GT(right, 0);
}

TEST(LayersByGroup, NamesThatAnArrayOrTheCommandLineCannotHaveAreTold) {
  for (const char* good : {"", "desk", "row 1, left", "B\xc3\xbcro", "emission", "luminaires", "a:b"})
    EXPECT_EQ(problem_with_group(good), "") << good;
  for (const char* bad : {"sky", "sun", "a=b", "a\nb", "a\"b", "a<b", "a&b", "\x7f"})
    EXPECT_NE(problem_with_group(bad), "") << bad;
}

}  // namespace
}  // namespace clerestory
