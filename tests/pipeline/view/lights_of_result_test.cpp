// Whether a result's light can be found again in its scene.

#include "pipeline/view/lights_of_result.h"

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/box_scene.h"
#include "tests/support/small_result.h"

namespace clerestory {
namespace {

/// The walls of BoxScene{.size = {4, 4, 4}, .offset = {-2, -2, -2}}, solved for that file.
WrittenResult solved_room(const std::string& input) {
  WrittenResult r = empty_result();
  add_room(r, 7, 100);
  r.materials[0].name = "wall", r.materials[0].reflectance = Spectrum(0.5);
  r.texts["input"] = {input};
  return r;
}

std::string refused(const WrittenResult& result) {
  try {
    (void)lights_of_result(result, result.file, "", {});
  } catch (const InputError& e) {
    return e.what();
  }
  return "not refused";
}

class LightsOfResult : public testing::Test {
 protected:
  TempFolder folder_;
  WrittenResult result_ =
      solved_room(BoxScene{.size = {4, 4, 4}, .offset = {-2, -2, -2}, .rho = 0.5, .M = 100}.write(folder_));

  /// The same room with a lamp, or several.
  void hang(const std::string& luminaires, const std::string& more = "") {
    folder_.write("room.json", R"({ "geometry": [{ "file": "room.obj" }],
      "materials": { "wall": { "reflectance": 0.5, "sides": 1 } }, "luminaires": [)" +
                                   luminaires + "]" + more + " }");
  }
};

TEST_F(LightsOfResult, AreThoseOfTheScene) {
  hang(R"({ "type": "point", "position": [0, 0, 1], "luminous_flux": 500, "name": "pendant" })");
  result_.around.luminaires = {{{0, 0, 1}, "pendant", "", 500}};
  const auto found = lights_of_result(result_, result_.file, "", {});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->lights.luminaires.size(), 1u);
  EXPECT_LT(length(found->lights.luminaires[0].position + found->patches.origin - Vec3{0, 0, 1}), 1e-9);
}

TEST_F(LightsOfResult, AreNotOfAYearOfOneTimeOfSeveralOrOfAMixture) {
  WrittenResult year = result_, time = result_, mixed = result_;
  year.texts["settings.weather"] = {"city.epw"};
  time.texts["time"] = {"2026-03-21T12:00"};
  mixed.around.layers = {{"lamps", {}, {}, 0.25}};
  const std::string advice = "; rays find the light that its scene has. Leave --raytrace and --final-gather out.";
  EXPECT_EQ(refused(year), "small.vtp: holds the light of a year" + advice);
  EXPECT_EQ(refused(time), "small.vtp: holds one of several times" + advice);
  EXPECT_EQ(refused(mixed), "small.vtp: was mixed: 'lamps' is at 0.250" + advice);
}

TEST_F(LightsOfResult, AreRefusedWhereTheSceneHasChanged) {
  EXPECT_EQ(refused(result_), "not refused");
  const auto expect_change = [&](const WrittenResult& result, const std::string& why) {
    EXPECT_EQ(refused(result), "room.json: is not as it was when small.vtp was solved: " + why +
                                   ". Solve it again, or name the right one by --scene FILE.");
  };
  WrittenResult other = result_;
  other.materials[0].reflectance = Spectrum(0.6);
  expect_change(other, "its material 'wall' is another");
  other = result_;
  other.figures["repairs.input_faces"] = 7;
  expect_change(other, "it has 6 faces instead of 7");
  other = result_;
  for (Vec3& p : other.points) p.z *= 0.9;  // floor and ceiling, a sixth of the area each, are elsewhere
  EXPECT_NE(refused(other).find("it has no face where 3"), std::string::npos) << refused(other);
  other = result_;
  other.around.luminaires = {{{0, 0, 1}, "pendant", "", 500}};
  expect_change(other, "it has 0 luminaires instead of 1");
  hang(R"({ "type": "point", "position": [0, 0, 1], "luminous_flux": 400, "name": "pendant" })");
  expect_change(other, "its luminaire 'pendant', number 1, is another");
  hang("", R"(, "sky": { "model": "uniform", "horizontal_illuminance": 10000 })");
  expect_change(result_, "its sky is another");
}

}  // namespace
}  // namespace clerestory
