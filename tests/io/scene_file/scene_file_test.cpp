// The scene file: every key, and every way to get one wrong.

#include <numbers>

#include <gtest/gtest.h>

#include "io/text.h"
#include "tests/io/reading.h"
#include "tests/support/luminaires.h"

namespace clerestory {
namespace {

using ::testing::Test;

constexpr double kPi = std::numbers::pi;

class SceneFile : public Test {
 protected:
  SceneFile() { folder_.write("room.obj", kRoomObj); }

  Scene read(const std::string& json) { return read_scene(folder_.write("s.json", json)); }
  /// A scene of the room with further members of the root object.
  Scene read_with(const std::string& members) { return read(with(members)); }
  std::string refusal_with(const std::string& members) { return refusal(folder_.write("s.json", with(members))); }
  static std::string with(const std::string& members) {
    return R"({ "geometry": [{ "file": "room.obj" }], )" + members + " }";
  }
  /// What a material rule says of 'wood'.
  Material wood(const std::string& says) {
    return material(read_with(R"("materials": { "wood": )" + says + " }"), "wood");
  }
  std::string wood_refusal(const std::string& says) { return refusal_with(R"("materials": { "wood": )" + says + " }"); }

  TempFolder folder_;
};

TEST_F(SceneFile, CommentsAreAllowedAndPathsAreRelativeToTheFile) {
  const Scene scene = read("// a room\n{ \"geometry\": [ /* one */ { \"file\": \"room.obj\" } ] } // end\n");
  EXPECT_EQ(scene.polygons.face_count(), 2u);
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"floor", "north wall"}));
  EXPECT_EQ(scene.file, folder_ / "s.json");
}

TEST_F(SceneFile, FirstMatchingMaterialRuleWinsAndRulesWithoutAMatchAreListed) {
  const Scene scene = read_with(R"("materials": { "w?ll*": { "reflectance": 0.7 }, "w*": { "reflectance": 0.2 },
                                                  "wood": { "reflectance": 0.9 }, "tile": {} })");
  EXPECT_EQ(material(scene, "wall paint").reflectance, Spectrum(0.7));
  EXPECT_EQ(material(scene, "wood").reflectance, Spectrum(0.2));
  EXPECT_EQ(scene.unused_materials, (std::vector<std::string>{"wood", "tile"}));
}

TEST_F(SceneFile, MaterialsTakeANumberOrOneValuePerChannelAndDefaultToHalfOnBothSides) {
  EXPECT_EQ(wood("{}").reflectance, Spectrum(0.5));
  EXPECT_EQ(wood("{}").sides, 2);
  EXPECT_EQ(wood(R"({ "reflectance": [0.1, 0.2, 0.3], "sides": 1 })").reflectance, Spectrum(0.1, 0.2, 0.3));
  EXPECT_EQ(wood(R"({ "reflectance": [0.1] })").reflectance, Spectrum(0.1));
  EXPECT_EQ(wood(R"({ "sides": 1 })").sides, 1);
  EXPECT_EQ(wood(R"({ "reflectance": 0 })").reflectance, Spectrum(0.0));
  EXPECT_EQ(wood(R"({ "reflectance": 0.9999 })").reflectance, Spectrum(0.9999));
}

TEST_F(SceneFile, EmissionIsReadInEachOfItsUnits) {
  EXPECT_DOUBLE_EQ(wood(R"({ "exitance": 40 })").exitance[0], 40);
  EXPECT_EQ(wood(R"({ "exitance": [40, 30, 20] })").exitance, Spectrum(40, 30, 20));
  EXPECT_DOUBLE_EQ(wood(R"({ "luminous_exitance": 1790 })").exitance[0], 10);
  EXPECT_DOUBLE_EQ(wood(R"({ "radiance": 2 })").exitance[0], 2 * kPi);
  EXPECT_DOUBLE_EQ(wood(R"({ "luminance": 179 })").exitance[0], kPi);
  EXPECT_DOUBLE_EQ((*wood(R"({ "power": 12 })").total_power)[0], 12);
  EXPECT_DOUBLE_EQ((*wood(R"({ "luminous_flux": 358 })").total_power)[0], 2);
  EXPECT_TRUE(wood(R"({ "luminous_flux": 358 })").emits());
}

TEST_F(SceneFile, GlassPassesItsTransmittance) {
  const Material glass = wood(R"({ "type": "glass", "transmittance": 0.65 })");
  EXPECT_EQ(glass.kind, MaterialKind::glass);
  EXPECT_EQ(glass.transmittance, Spectrum(0.65));
  EXPECT_EQ(wood_refusal(R"({ "type": "glass" })"),
            "s.json: materials 'wood': transmittance is missing; glass needs it, 0.65 for common double glazing");
  EXPECT_EQ(
      wood_refusal(R"({ "type": "glass", "transmittance": 1.5 })"),
      "s.json: materials 'wood': transmittance = 1.5 is outside [0, 1]; a sheet cannot pass more than it receives.");
  EXPECT_EQ(wood_refusal(R"({ "transmittance": 0.5 })"),
            "s.json: materials 'wood': transmittance needs \"type\": \"glass\" or \"diffuser\"");
}

TEST_F(SceneFile, GlassThatPassesMoreThanClearGlassIsTakenAsCoated) {
  const auto warnings = [&](const std::string& transmittance) {
    return read_with(R"("materials": { "*": { "type": "glass", "transmittance": )" + transmittance + " } }").warnings;
  };
  EXPECT_TRUE(warnings("0.92").empty());
  ASSERT_EQ(warnings("0.98").size(), 1u);
  EXPECT_EQ(
      warnings("0.98").front(),
      "s.json: materials '*': transmittance = 0.98 is more than the 0.918 of clear glass; taken as glass coated to "
      "reflect less");
}

TEST_F(SceneFile, ADiffuserReflectsAndPassesLessThanItReceives) {
  const Material blind = wood(R"({ "type": "diffuser", "transmittance": 0.3, "reflectance": 0.5 })");
  EXPECT_EQ(blind.kind, MaterialKind::diffuser);
  EXPECT_EQ(blind.transmittance, Spectrum(0.3));
  EXPECT_EQ(blind.reflectance, Spectrum(0.5));
  EXPECT_EQ(
      wood_refusal(R"({ "type": "diffuser", "transmittance": [0.3, 0.6, 0.1], "reflectance": 0.5 })"),
      "s.json: materials 'wood': reflectance + transmittance = 1.1 is outside [0, 1); a sheet cannot give back and "
      "pass more than it receives");
  EXPECT_NE(wood_refusal(R"({ "type": "diffuser", "reflectance": 0.5 })").find("transmittance is missing"),
            std::string::npos);
  EXPECT_EQ(wood_refusal(R"({ "type": "diffuser", "transmittance": 0.3, "sides": 1 })"),
            "s.json: materials 'wood': sides = 1: a diffuser acts on both of its sides");
}

TEST_F(SceneFile, AMirrorSaysHowMuchItReflects) {
  const Material mirror = wood(R"({ "type": "mirror", "reflectance": 0.9 })");
  EXPECT_EQ(mirror.kind, MaterialKind::mirror);
  EXPECT_EQ(mirror.reflectance, Spectrum(0.9));
  EXPECT_EQ(wood_refusal(R"({ "type": "mirror" })"),
            "s.json: materials 'wood': reflectance is missing; a mirror needs it, 0.9 for a common one");
  EXPECT_NE(wood_refusal(R"({ "type": "mirror", "reflectance": 0.9, "luminance": 5 })").find("does not emit"),
            std::string::npos);
}

TEST_F(SceneFile, AGlossySurfaceHasALobeBesideItsDiffusePart) {
  const Material floor =
      wood(R"({ "type": "glossy", "reflectance": 0.3, "specular": [0.1, 0.2, 0.3], "exponent": 50 })");
  EXPECT_EQ(floor.kind, MaterialKind::glossy);
  EXPECT_EQ(floor.reflectance, Spectrum(0.3));
  ASSERT_TRUE(floor.gloss);
  EXPECT_EQ(floor.gloss->specular, Spectrum(0.1, 0.2, 0.3));
  EXPECT_EQ(floor.gloss->exponent, 50);
  const Material metal = wood(R"({ "type": "glossy", "specular": 0.85, "roughness": 0.2, "luminance": 3 })");
  EXPECT_EQ(metal.reflectance, Spectrum(0.0));
  EXPECT_FALSE(metal.gloss->exponent);
  EXPECT_EQ(metal.gloss->roughness, 0.2);
  EXPECT_TRUE(metal.emits());

  EXPECT_EQ(wood_refusal(R"({ "type": "glossy", "reflectance": 0.6, "specular": 0.5, "exponent": 5 })"),
            "s.json: materials 'wood': reflectance + specular = 0.6 + 0.5 = 1.1 is outside [0, 1); a surface cannot "
            "reflect more than it receives");
  const auto refused = [&](const std::string& material, const std::string& why) {
    EXPECT_NE(wood_refusal(material).find(why), std::string::npos) << wood_refusal(material);
  };
  refused(R"({ "type": "glossy", "exponent": 5 })", "specular is missing; it is what the lobe reflects");
  refused(R"({ "type": "glossy", "specular": 1.2, "exponent": 5 })", "specular = 1.2 is outside [0, 1)");
  refused(R"({ "type": "glossy", "specular": 0.2, "exponent": -1 })", "exponent = -1 is outside [0, 1000000]");
  refused(R"({ "type": "glossy", "specular": 0.2, "roughness": 0 })", "roughness = 0 is outside [0.01, 1]");
  refused(R"({ "type": "glossy", "specular": 0.2, "roughness": "nan" })", "roughness must be a number");
  refused(R"({ "type": "glossy", "specular": 0.2 })", "give one of exponent (modified Phong, 0 or more) and roughness");
  refused(R"({ "type": "glossy", "specular": 0.2, "exponent": 1, "roughness": 1 })", "to 1), not both");
  refused(R"({ "type": "glossy", "specular": 0.2, "exponent": 1, "sides": 1 })", "reflects on both of its sides");
  refused(R"({ "type": "glass", "transmittance": 0.6, "specular": 0.2 })",
          "specular needs \"type\": \"glossy\"; glass");
  refused(R"({ "exponent": 10 })", "exponent needs \"type\": \"glossy\"");
}

TEST_F(SceneFile, LuminairesArePointsWithTheirFluxDimmedAndGrouped) {
  const Scene scene = read_with(R"("luminaires": [
      { "type": "point", "position": [1, 2, 3], "luminous_flux": 358, "dimming": 0.5, "group": "desk", "name": "bulb" },
      { "type": "point", "position": [0, 0, 1], "power": [3, 2, 1] } ])");
  ASSERT_EQ(scene.lights.luminaires.size(), 2u);
  EXPECT_EQ(scene.lights.luminaires[0].position, (Vec3{1, 2, 3}));
  EXPECT_DOUBLE_EQ(test::as_point(scene.lights.luminaires[0]).power[0], 1);
  EXPECT_EQ(scene.lights.luminaires[0].group, "desk");
  EXPECT_EQ(scene.lights.luminaires[0].name, "bulb");
  EXPECT_EQ(test::as_point(scene.lights.luminaires[1]).power, Spectrum(3, 2, 1));
  EXPECT_EQ(scene.lights.luminaires[1].name, "luminaire 2");
}

TEST_F(SceneFile, SkyAndSunBecomeIrradiance) {
  const Scene scene =
      read_with(R"("sky": { "model": "uniform", "horizontal_illuminance": 17900, "ground_reflectance": 0.3 },
      "sun": { "direction": [0, 3, 4], "normal_illuminance": 89500 },
      "location": { "latitude": 48.8, "longitude": 2.3, "timezone": 1, "north": 30 }, "time": "2026-06-21T12:00")");
  ASSERT_TRUE(scene.lights.sky);
  EXPECT_EQ(scene.lights.sky->model, SkyModel::uniform);
  EXPECT_DOUBLE_EQ(scene.lights.sky->horizontal_irradiance[0], 100);
  EXPECT_DOUBLE_EQ(scene.lights.sky->ground_reflectance, 0.3);
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].direction.y, 0.6);
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].direction.z, 0.8);
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].normal_irradiance[0], 500);
  EXPECT_EQ(read_with(R"("sky": { "model": "cie-overcast", "horizontal_illuminance": 1 })").lights.sky->model,
            SkyModel::cie_overcast);
}

TEST_F(SceneFile, SensorsAreGridsWithBothEndsAndFiles) {
  folder_.write("points.csv", "0,0,1,0,0,2\n");
  const Scene scene =
      read_with(R"("sensors": [ { "name": "desk", "origin": [0.5, 0.5, 0.8], "u": [5, 0, 0], "v": [0, 4, 0],
      "spacing": 0.25, "normal": [0, 0, 3] }, { "file": "points.csv" }, { "origin": [0, 0, 0], "u": [1, 0, 0], "v": [0, 1, 0],
      "spacing": 2 } ])");
  ASSERT_EQ(scene.sensors.size(), 3u);
  EXPECT_EQ(scene.sensors[0].name, "desk");
  ASSERT_EQ(scene.sensors[0].points.size(), 21u * 17u);
  EXPECT_EQ(scene.sensors[0].points.front().position, (Vec3{0.5, 0.5, 0.8}));
  EXPECT_EQ(scene.sensors[0].points.back().position, (Vec3{5.5, 4.5, 0.8}));
  EXPECT_EQ(scene.sensors[0].points[1].position, (Vec3{0.75, 0.5, 0.8}));
  EXPECT_EQ(scene.sensors[0].points[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.sensors[1].name, "points");
  EXPECT_EQ(scene.sensors[1].points[0].normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.sensors[2].points.size(), 1u);
  EXPECT_EQ(scene.sensors[2].points[0].normal, (Vec3{0, 0, 1}));  // u x v
  EXPECT_EQ(read_with(R"("sensors": [{"name": "desk", "origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 2},
                                     {"name": "desk", "origin": [0,0,1], "u": [1,0,0], "v": [0,1,0], "spacing": 2}])")
                .sensors[1]
                .name,
            "desk 2")
      << "each set can be told from all others";
}

TEST_F(SceneFile, SensorsHaveTheNormalsOfTheirKind) {
  folder_.write("points.csv", "0,0,1,0,-1,0\n3,4,1,-1,0,0\n");
  const std::string grid = R"("origin": [0, 0, 1], "u": [1, 0, 0], "v": [0, 0, 1], "spacing": 1)";
  const Scene scene = read_with(R"("sensors": [ { )" + grid + R"( }, { "kind": "planar", )" + grid +
                                R"(, "normal": [1, 0, 0] }, { "kind": "horizontal", )" + grid +
                                R"( }, { "kind": "vertical", )" + grid + R"( }, { "kind": "cylindrical", )" + grid +
                                R"( }, { "kind": "cylindrical", "normal": [0, 2, 0], )" + grid +
                                R"( }, { "kind": "vertical", "file": "points.csv" }, { "kind": "horizontal", "file":
      "points.csv", "threshold": 300 }, { "kind": "camera", "camera": [3, 4, 6], "file": "points.csv" } ])");
  const auto normal = [&](std::size_t set, std::size_t i = 0) { return scene.sensors.at(set).points.at(i).normal; };
  EXPECT_EQ(scene.sensors[0].kind, SensorKind::planar);
  EXPECT_EQ(normal(0), (Vec3{0, -1, 0}));  // u x v
  EXPECT_EQ(normal(1), (Vec3{1, 0, 0}));
  EXPECT_EQ(scene.sensors[2].kind, SensorKind::horizontal);
  EXPECT_EQ(normal(2), (Vec3{0, 0, 1}));
  EXPECT_EQ(normal(3), (Vec3{0, -1, 0}));
  EXPECT_EQ(scene.sensors[4].kind, SensorKind::cylindrical);
  EXPECT_EQ(normal(4), (Vec3{0, 0, 1}));  // the axis
  EXPECT_EQ(normal(5), (Vec3{0, 1, 0}));
  EXPECT_EQ(normal(6, 1), (Vec3{-1, 0, 0}));
  EXPECT_EQ(normal(7, 1), (Vec3{0, 0, 1}));
  EXPECT_EQ(scene.sensors[7].threshold, 300);
  EXPECT_FALSE(scene.sensors[6].threshold);
  EXPECT_EQ(scene.sensors[8].kind, SensorKind::camera);
  EXPECT_NEAR(length(normal(8, 0) - Vec3{3, 4, 5} / std::sqrt(50.0)), 0, 1e-15);
  EXPECT_EQ(normal(8, 1), (Vec3{0, 0, 1}));
}

TEST_F(SceneFile, KeysThatDoNotGoWithAKindOfSensorAreRefused) {
  folder_.write("points.csv", "0,0,1,0,-1,0\n0,0,1,0,0.6,0.8\n");
  const auto of = [&](const std::string& says) { return refusal_with(R"("sensors": [ { )" + says + " } ]"); };
  const std::string grid = R"(, "origin": [0, 0, 1], "u": [1, 0, 0], "v": [0, 1, 0], "spacing": 0.1)";
  EXPECT_EQ(of(R"("kind": "horizontal", "normal": [0, 0, 1])" + grid),
            "s.json: sensors[0].normal does not go with \"kind\": \"horizontal\", which faces up; leave it out");
  EXPECT_EQ(of(R"("kind": "camera", "camera": [9, 9, 9], "normal": [0, 0, 1])" + grid),
            "s.json: sensors[0].normal does not go with \"kind\": \"camera\", which faces the camera; leave it out");
  EXPECT_EQ(of(R"("camera": [9, 9, 9])" + grid),
            "s.json: sensors[0].camera does not go with \"kind\": \"planar\"; write \"kind\": \"camera\"");
  EXPECT_EQ(of(R"("kind": "vertical")" + grid),
            "s.json: sensors[0]: point 1 at (0, 0, 1) has the normal (0, 0, 1); \"kind\": \"vertical\" needs a "
            "horizontal one, [0, -1, 0] for who looks to -y");
  EXPECT_NE(of(R"("kind": "vertical", "file": "points.csv")").find("point 2 at (0, 0, 1) has the normal (0, 0.6, 0.8)"),
            std::string::npos);
  // 0.3 as 3 x 0.1 is not quite 0.3.
  EXPECT_EQ(of(R"("kind": "camera", "camera": [0.3, 0, 1])" + grid),
            "s.json: sensors[0].camera is where point 4 at (0.3, 0, 1) is, and a point cannot face itself; move one of "
            "them");
}

TEST_F(SceneFile, SolverSettingsAreKept) {
  const SolverSettings s =
      read_with(R"("solver": { "method": "gauss-seidel", "accuracy": "fine", "oracle": "bf", "max_element": 0.25,
                                     "detail": 0, "target_error": 0.01, "time_limit": 30, "seed": 7 })")
          .settings;
  EXPECT_EQ(s.method, "gauss-seidel");
  EXPECT_EQ(s.accuracy, "fine");
  EXPECT_EQ(s.oracle, "bf");
  EXPECT_EQ(s.max_element, 0.25);
  EXPECT_EQ(s.detail, 0.0);
  EXPECT_EQ(s.target_error, 0.01);
  EXPECT_EQ(s.time_limit, 30);
  EXPECT_EQ(s.seed, 7u);
}

TEST_F(SceneFile, GeometryIsScaledThenTurnedThenTransformed) {
  const Scene scene = read(R"({ "geometry": [ { "file": "room.obj", "unit": "cm", "up": "y",
      "transform": [0, -1, 0, 10,  1, 0, 0, 20,  0, 0, 1, 30,  0, 0, 0, 1] } ] })");
  // (1, 0, 0) cm stays on x, turns to +y, and moves; the file's y = 1 is up.
  EXPECT_EQ(scene.polygons.vertices[1], (Vec3{10, 20.01, 30}));
  EXPECT_DOUBLE_EQ(extent(scene).upper.z, 30.01);
}

TEST_F(SceneFile, AMirroringTransformKeepsFrontsInFront) {
  const Scene scene =
      read(R"({ "geometry": [ { "file": "room.obj", "transform": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1] } ] })");
  EXPECT_GT(area_vector(scene, 0).z, 0);  // the floor still faces up
}

TEST_F(SceneFile, TheSameFileTwiceGetsNamesOfItsOwnAndSharesMaterials) {
  const Scene scene = read(R"({ "geometry": [ { "file": "room.obj" },
      { "file": "room.obj", "transform": [1,0,0,5, 0,1,0,0, 0,0,1,0, 0,0,0,1] } ] })");
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"floor", "north wall", "floor (room)", "north wall (room)"}));
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.polygons.face_count(), 4u);
}

TEST_F(SceneFile, MaterialsOfOneNameAndTwoMeaningsGetDifferentNames) {
  folder_.write("a.mtl", "newmtl paint\nKd 0.2 0.2 0.2\n");
  folder_.write("a.obj", "mtllib a.mtl\nusemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder_.write("b.obj", "usemtl paint\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Scene scene = read(R"({ "geometry": [ { "file": "a.obj" }, { "file": "b.obj" } ] })");
  EXPECT_EQ(material(scene, "paint").reflectance, Spectrum(0.2));
  EXPECT_EQ(material(scene, "paint (b)").reflectance, Spectrum(0.5));
}

// What is refused, and in which words.

TEST_F(SceneFile, SyntaxErrorsNameLineAndColumn) {
  const std::string message = refusal(folder_.write("s.json", "{\n  \"geometry\": [ {, } ]\n}\n"));
  EXPECT_TRUE(message.starts_with("s.json:2:18: is not valid JSON: ")) << message;
  EXPECT_TRUE(refusal(folder_.write("s.json", "{ \"geometry\": [")).starts_with("s.json:1:1")) << message;
}

TEST_F(SceneFile, TypeErrorsNameThePath) {
  EXPECT_EQ(refusal_with(R"("sky": { "model": "uniform", "horizontal_illuminance": "10000" })"),
            "s.json: sky.horizontal_illuminance must be a number or an array of one number per channel, not a text "
            "(\"10000\")");
  EXPECT_EQ(refusal_with(R"("sky": 3)"), "s.json: sky must be an object, not a number (3)");
  EXPECT_EQ(refusal_with(R"("luminaires": {})"), "s.json: luminaires must be an array of luminaires, not an object");
  EXPECT_EQ(refusal_with(R"("sun": { "direction": [0, "north", 1], "normal_illuminance": 1 })"),
            "s.json: sun.direction[1] must be a number, not a text (\"north\")");
  EXPECT_EQ(refusal_with(R"("solver": { "seed": true })"),
            "s.json: solver.seed must be a number, not true or false (true)");
  EXPECT_EQ(refusal(folder_.write("s.json", R"({ "geometry": [ { "file": 7 } ] })")),
            "s.json: geometry[0].file must be a text, not a number (7)");
  EXPECT_EQ(refusal(folder_.write("s.json", "[]")), "s.json must be an object, not an array");
}

TEST_F(SceneFile, UnknownKeysAndNamesGetTheNearestSuggestion) {
  EXPECT_EQ(refusal_with(R"("skye": {})"), "s.json: skye is not a known key; did you mean 'sky'?");
  EXPECT_EQ(refusal_with(R"("sky": { "model": "cie-overcsat" })"),
            "s.json: sky.model 'cie-overcsat' is not known; did you mean 'cie-overcast'?");
  EXPECT_EQ(wood_refusal(R"({ "reflectence": 0.5 })"),
            "s.json: materials 'wood': reflectence is not a known key; did you mean 'reflectance'?");
  EXPECT_EQ(refusal_with(R"("solver": { "method": "radiosity" })"),
            "s.json: solver.method 'radiosity' is not known; known are hierarchical, progressive, gauss-seidel, "
            "jacobi, path, bidirectional, particles");
  EXPECT_EQ(refusal_with(R"("solver": { "time-limit": 3 })"),
            "s.json: solver.time-limit is not a known key; did you mean 'time_limit'?");
  EXPECT_EQ(refusal(folder_.write("s.json", R"({ "geometry": [ { "file": "room.obj", "unit": "metre" } ] })")),
            "s.json: geometry[0].unit 'metre' is not known; known are m, cm, mm, ft, in");
}

TEST_F(SceneFile, ReflectancesOutsideTheirRangeAreRefused) {
  EXPECT_EQ(
      wood_refusal(R"({ "reflectance": 1.2 })"),
      "s.json: materials 'wood': reflectance = 1.2 is outside [0, 1); a wall cannot reflect more than it receives.");
  EXPECT_EQ(
      wood_refusal(R"({ "reflectance": 1 })"),
      "s.json: materials 'wood': reflectance = 1 is outside [0, 1); a wall cannot reflect more than it receives.");
  EXPECT_EQ(wood_refusal(R"({ "reflectance": [0.5, -0.1, 0.5] })"),
            "s.json: materials 'wood': reflectance[1] = -0.1 is outside [0, 1); a wall cannot reflect more than it "
            "receives.");
}

TEST_F(SceneFile, OneAndThreeChannelsDoNotMix) {
  EXPECT_EQ(
      refusal_with(R"("materials": { "wood": { "reflectance": [0.5] }, "*": { "exitance": [1, 2, 3] } })"),
      "s.json: materials '*': exitance has 3 values, but materials 'wood': reflectance has 1; one channel and three "
      "channels mixed. A plain number goes with both");
  EXPECT_EQ(wood_refusal(R"({ "reflectance": [0.5, 0.5] })"),
            "s.json: materials 'wood': reflectance has 2 values; it takes a number, or one per channel: 1 or 3");
  EXPECT_EQ(wood_refusal(R"({ "reflectance": [0.5, 0.5, 0.5, 0.5] })"),
            "s.json: materials 'wood': reflectance has 4 values; it takes a number, or one per channel: 1 or 3");
}

TEST_F(SceneFile, TwoWordsForOneEmissionAreRefused) {
  EXPECT_EQ(wood_refusal(R"({ "exitance": 1, "luminous_flux": 800 })"),
            "s.json: materials 'wood': exitance and luminous_flux both say what it emits; keep one of them");
}

TEST_F(SceneFile, NegativeAndEndlessQuantitiesAreRefused) {
  EXPECT_EQ(wood_refusal(R"({ "power": -1 })"),
            "s.json: materials 'wood': power = -1 is outside [0, 1e15]; a surface emits no less than nothing and no "
            "more than a result can hold.");
  EXPECT_NE(wood_refusal(R"({ "power": 1e999 })").find("not valid JSON"), std::string::npos);
  EXPECT_NE(wood_refusal(R"({ "power": NaN })").find("not valid JSON"), std::string::npos);
  EXPECT_EQ(refusal_with(R"("solver": { "time_limit": 0 })"),
            "s.json: solver.time_limit = 0 is outside (0, inf); it is in seconds.");
  EXPECT_EQ(wood_refusal(R"({ "sides": 3 })"),
            "s.json: materials 'wood': sides = 3 is outside [1, 2]; a surface has one lit side or two.");
  EXPECT_EQ(refusal_with(R"("sky": { "model": "uniform", "ground_reflectance": 2 })"),
            "s.json: sky.ground_reflectance = 2 is outside [0, 1]; the ground cannot reflect more than it receives.");
}

TEST_F(SceneFile, LightBeyondWhatAResultCanHoldIsRefusedInEveryUnit) {
  for (const char* key : {"exitance", "luminous_exitance", "radiance", "luminance", "power", "luminous_flux"}) {
    const std::string name = key;
    EXPECT_NE(wood_refusal("{ \"" + name + "\": 1e300 }").find(name + " = 1e+300 is outside [0, 1e15]"),
              std::string::npos);
    EXPECT_TRUE(wood("{ \"" + name + "\": 1e15 }").emits());
  }
  EXPECT_NE(refusal_with(R"("luminaires": [ { "type": "point", "position": [0,0,0], "luminous_flux": 1e300 } ])")
                .find("luminaires[0].luminous_flux = 1e+300 is outside [0, 1e15]"),
            std::string::npos);
  EXPECT_NE(refusal_with(R"("sky": { "model": "uniform", "horizontal_illuminance": 1e300 })")
                .find("sky.horizontal_illuminance = 1e+300 is outside [0, 1e15]"),
            std::string::npos);
  EXPECT_NE(refusal_with(R"("sun": { "direction": [0, 0, 1], "normal_illuminance": 1e300 })")
                .find("sun.normal_illuminance = 1e+300 is outside [0, 1e15]"),
            std::string::npos);
}

TEST_F(SceneFile, PlacesFartherThanModelsMayReachAreRefused) {
  EXPECT_EQ(refusal_with(R"("luminaires": [ { "type": "point", "position": [1e19, 0, 0], "luminous_flux": 1 } ])"),
            "s.json: luminaires[0].position[0] = 1e+19 is outside [-1e12, 1e12]; positions are in metres.");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "origin": [0,-1e20,0], "u": [1,0,0], "v": [0,1,0], "spacing": 1 } ])"),
            "s.json: sensors[0].origin[1] = -1e+20 is outside [-1e12, 1e12]; positions are in metres.");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "origin": [0,0,0], "u": [1e30,0,0], "v": [0,1,0], "spacing": 1e29 } ])"),
            "s.json: sensors[0].u[0] = 1e+30 is outside [-1e12, 1e12]; positions are in metres.");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "origin": [1e12,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 1 } ])"),
            "s.json: sensors[0]: origin, u and v lead to a point at (1e+12, 0, 0), outside [-1e12, 1e12] m");
}

TEST_F(SceneFile, ASunBelowTheHorizonGivesNoLight) {
  for (const char* direction : {"[1, 0, -0.1]", "[1, 0, 0]"}) {
    const Scene scene = read_with(text(R"("sun": { "direction": )", direction, R"(, "normal_illuminance": 1000 })"));
    EXPECT_TRUE(scene.lights.suns.empty());
    EXPECT_NE(all_warnings(scene).find("s.json: sun.direction has z <= 0"), std::string::npos) << all_warnings(scene);
  }
}

TEST_F(SceneFile, TimesThatDoNotExistAreRefused) {
  for (const char* time : {"2026-13-45T99:99", "2026-02-29T12:00", "2026-06-21T24:00", "2026-06-21T12:60",
                           "2026-00-01T00:00", "2026-06-21T12:00:60"})
    EXPECT_NE(refusal_with(text(R"("time": ")", time, '"')).find(text("time '", time, "' does not exist")),
              std::string::npos)
        << time;
  EXPECT_NO_THROW(read_with(R"("time": "2028-02-29T23:59:59")"));
}

TEST_F(SceneFile, DirectionsNeedALength) {
  EXPECT_EQ(refusal_with(R"("sun": { "direction": [0, 0, 0], "normal_illuminance": 1 })"),
            "s.json: sun.direction = [0, 0, 0] has no direction");
  EXPECT_DOUBLE_EQ(
      read_with(R"("sun": { "direction": [0, 0, 1e-200], "normal_illuminance": 1 })").lights.suns[0].direction.z, 1);
}

TEST_F(SceneFile, TransformsAreSixteenNumbersWithAnInverse) {
  const auto refused = [&](const std::string& numbers) {
    return refusal(
        folder_.write("s.json", R"({ "geometry": [ { "file": "room.obj", "transform": )" + numbers + " } ] }"));
  };
  EXPECT_EQ(refused("[1, 0, 0]"), "s.json: geometry[0].transform has 3 values; it needs 16");
  EXPECT_EQ(refused("[1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]"),
            "s.json: geometry[0].transform: flattens the model; its 3 x 3 part has no inverse");
  EXPECT_EQ(
      refused("[1,0,0,0, 0,1,0,0, 0,0,1,0, 5,6,7,1]"),
      "s.json: geometry[0].transform: the last row is not 0, 0, 0, 1; the numbers go row by row, not column by column");
  EXPECT_NE(refused("[1e300,0,0,0, 0,1e300,0,0, 0,0,1e300,0, 0,0,0,1]").find("outside [-1e12, 1e12]"),
            std::string::npos);
}

TEST_F(SceneFile, MissingMembersAreNamed) {
  EXPECT_EQ(refusal(folder_.write("s.json", "{}")), "s.json: geometry is missing");
  EXPECT_EQ(refusal(folder_.write("s.json", R"({ "geometry": [] })")),
            "s.json: geometry is empty; name a model: [{ \"file\": \"room.obj\" }]");
  EXPECT_EQ(refusal(folder_.write("s.json", R"({ "geometry": [ {} ] })")), "s.json: geometry[0].file is missing");
  EXPECT_EQ(refusal_with(R"("luminaires": [ { "type": "point", "luminous_flux": 1 } ])"),
            "s.json: luminaires[0].position is missing");
  EXPECT_EQ(refusal_with(R"("luminaires": [ { "type": "point", "position": [0, 0, 0] } ])"),
            "s.json: luminaires[0].luminous_flux is missing; a luminaire needs its flux in lumens");
  EXPECT_EQ(refusal(folder_.write("s.json", R"({ "geometry": [ { "file": "hall.obj" } ] })")),
            "s.json: geometry[0].file 'hall.obj': there is no file " + folder_ / "hall.obj" +
                "; paths are relative to the scene file");
  EXPECT_NE(refusal_with(R"("sensors": [ { "file": "desk.csv" } ])").find("s.json: sensors[0].file 'desk.csv': there"),
            std::string::npos);
}

TEST_F(SceneFile, KeysGivenTwiceAreRefused) {
  EXPECT_EQ(refusal_with(R"("materials": { "wood": {}, "wood": {} })"),
            "s.json: the key 'wood' is given twice in one object; which one counts?");
}

TEST_F(SceneFile, NestingBombsAndSensorBombsAreRefusedAtOnce) {
  EXPECT_EQ(refusal(folder_.write("s.json", std::string(1'000'000, '['))),
            "s.json: is nested deeper than 32 levels; is it damaged, or another file?");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 1e-9 } ])"),
            "s.json: sensors[0].spacing = 1e-09 makes 1e+09 x 1e+09 points; at most 10000000 in one scene");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "kind": "cylindrical", "origin": [0,0,0], "u": [1,0,0], "v": [0,1,0],
                           "spacing": 0.001 } ])"),
            "s.json: sensors[0].spacing = 0.001 makes 1001 x 1001 points; at most 10000000 in one scene, and each "
            "cylindrical one counts as 21");
  EXPECT_EQ(refusal_with(R"("sensors": [ { "origin": [0,0,0], "u": [1,0,0], "v": [0,1,0], "spacing": 0 } ])"),
            "s.json: sensors[0].spacing = 0 is outside (0, 1e12]; it is in metres.");
}

}  // namespace
}  // namespace clerestory
