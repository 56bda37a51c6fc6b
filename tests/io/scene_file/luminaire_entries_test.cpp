#include <gtest/gtest.h>

#include "solver/model/units.h"
#include "tests/io/reading.h"
#include "tests/support/luminaires.h"

namespace clerestory {
namespace {

/// 100 cd all round below: 200 pi lm.
constexpr std::string_view kLamp =
    "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 .2 1.2 0\n1 1 9\n0 45 90\n0\n100 100 100\n";
constexpr double kLampFlux = 628.318530717958;

class Luminaires : public ::testing::Test {
 protected:
  std::string scene(const std::string& entries) {
    return folder_.write("s.json", R"({ "geometry": [ { "file": "room.obj" } ], "luminaires": [ )" + entries + "] }");
  }
  Scene read(const std::string& entries) { return read_scene(scene(entries), {}); }
  std::string refused(const std::string& entries) { return refusal(scene(entries)); }

  void SetUp() override {
    folder_.write("room.obj", kRoomObj);
    folder_.write("lamp.ies", kLamp);
  }
  TempFolder folder_;
};

TEST_F(Luminaires, AreReadFromTheirFileWhichManyShare) {
  const Scene s = read(R"({ "file": "lamp.ies", "position": [1, 2, 3], "group": "row", "dimming": 0.5 },
      { "file": "./lamp.ies", "position": [2, 2, 3], "aim": [0, 3, 0], "rotation": 0, "name": "up" })");
  ASSERT_EQ(s.lights.luminaires.size(), 2u);
  EXPECT_EQ(test::as_web(s.lights.luminaires[0]).web, test::as_web(s.lights.luminaires[1]).web);
  EXPECT_EQ(s.lights.luminaires[0].position, (Vec3{1, 2, 3}));
  EXPECT_EQ(s.lights.luminaires[0].group, "row");
  EXPECT_EQ(s.lights.luminaires[0].name, "luminaire 1");
  EXPECT_EQ(s.lights.luminaires[1].name, "up");
  EXPECT_NEAR(test::as_web(s.lights.luminaires[0]).scale[0] * kWhiteEfficacy, 0.5, 1e-12);
  EXPECT_LT(length(test::as_web(s.lights.luminaires[1]).axes.y - Vec3{0, 0, 1}), 1e-12);
  EXPECT_EQ(test::as_web(s.lights.luminaires[0]).web->opening.size, (Vec3{1.2, 0.2, 0}));
}

TEST_F(Luminaires, TakeTheFluxThatTheSceneGives) {
  const Scene s = read(R"({ "file": "lamp.ies", "position": [0, 0, 3], "luminous_flux": 1790, "maintenance_factor": 0.8,
      "dimming": 0.5 }, { "file": "lamp.ies", "position": [0, 0, 3], "power": [1, 2, 3] })");
  EXPECT_NEAR(test::as_web(s.lights.luminaires[0]).scale[0] * kLampFlux, 10 * 0.8 * 0.5, 1e-6);
  EXPECT_NEAR(test::as_web(s.lights.luminaires[1]).scale[2] * kLampFlux, 3, 1e-6);
  EXPECT_EQ(s.channels(), 3);
}

TEST_F(Luminaires, TiltChangesTheFluxOfTheFileAndNotThatOfTheScene) {
  folder_.write("tilted.ies", "TILT=INCLUDE\n1\n2\n0 90\n1 .8\n1 -1 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n100 100 100\n");
  const Scene s = read(R"({ "file": "tilted.ies", "position": [0, 0, 3], "aim": [1, 0, 0] },
      { "file": "tilted.ies", "position": [0, 0, 3], "aim": [1, 0, 0], "luminous_flux": 179 })");
  EXPECT_NEAR(test::as_web(s.lights.luminaires[0]).scale[0] * kWhiteEfficacy, 0.8, 1e-12);
  EXPECT_NEAR(test::as_web(s.lights.luminaires[1]).scale[0] * kLampFlux, 1, 1e-6);
}

TEST_F(Luminaires, AFileThatDoesNotAddUpIsReportedOnce) {
  folder_.write("odd.ies", "TILT=NONE\n1 500 1 3 1 1 2 0 0 0\n1 1 9\n0 45 90\n0\n100 100 100\n");
  const Scene s = read(R"({ "file": "odd.ies", "position": [0, 0, 3] }, { "file": "odd.ies", "position": [1, 0, 3] })");
  EXPECT_EQ(s.warnings.size(), 2u) << all_warnings(s);  // and materials without a reflectance
}

TEST_F(Luminaires, RefusalsNameTheEntryAndTheKey) {
  EXPECT_NE(refused(R"({ "file": "no.ies", "position": [0, 0, 3] })")
                .find("s.json: luminaires[0].file 'no.ies': there is no file"),
            std::string::npos);
  EXPECT_EQ(refused(R"({ "file": ".", "position": [0, 0, 3] })"),
            "s.json: luminaires[0].file '.' is a folder; name a file in it");
  EXPECT_EQ(refused(R"({ "position": [0, 0, 3] })"),
            "s.json: luminaires[0] says neither \"file\", the name of an .ies or .ldt file, nor \"type\": \"point\"; a "
            "luminaire needs one of them");
  EXPECT_EQ(
      refused(R"({ "file": "lamp.ies", "type": "point", "position": [0, 0, 3] })"),
      "s.json: luminaires[0]: has a file, which says where its light goes, and \"type\": \"point\"; keep one of them");
  EXPECT_EQ(refused(R"({ "file": "room.obj", "position": [0, 0, 3] })"),
            "room.obj: the extension '.obj' is no photometric file's; .ies (IESNA LM-63) and .ldt (EULUMDAT) are read");
  EXPECT_EQ(refused(R"({ "file": "lamp.ies", "position": [0, 0, 3], "aim": [0, 0, 0] })"),
            "s.json: luminaires[0].aim = [0, 0, 0] has no direction");
  EXPECT_EQ(refused(R"({ "file": "lamp.ies", "position": [0, 0, 3], "maintenance_factor": 1.2 })"),
            "s.json: luminaires[0].maintenance_factor = 1.2 is outside (0, 1]; it is what is left of the light of new "
            "lamps.");
  EXPECT_EQ(refused(R"({ "file": "lamp.ies" })"), "s.json: luminaires[0].position is missing");
  folder_.write("dark.ies", "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n0 0\n");
  EXPECT_EQ(refused(R"({ "file": "dark.ies", "position": [0, 0, 3], "luminous_flux": 100 })"),
            "s.json: luminaires[0].file 'dark.ies' gives no light; its flux cannot be scaled to the one the scene asks "
            "for; leave that out, or name another file");
}

}  // namespace
}  // namespace clerestory
