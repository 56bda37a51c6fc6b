// Collada and FBX: through Assimp, in a child process.

#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

/// A sheet of 100 x 100 units at height 75, in Collada with the given asset element; `up` is the third coordinate or
/// not.
std::string collada(const std::string& asset, const std::string& points) {
  return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset +
         R"(</asset><library_effects><effect id="e"><profile_COMMON><technique sid="c"><lambert><emission><color>2 1 0.5 1</color>
</emission><diffuse><color>0.8 0.6 0.4 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="m" name="paint"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g" name="sheet"><mesh><source id="p"><float_array id="pa" count="12">)" +
         points +
         R"(</float_array><technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><polylist material="mm" count="1">
<input semantic="VERTEX" source="#v" offset="0"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n1" name="table"><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="mm" target="#m"/></technique_common></bind_material></instance_geometry></node>
<node id="n2" name="mirrored"><matrix>-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="mm" target="#m"/></technique_common></bind_material></instance_geometry></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

class ThroughAssimp : public ::testing::Test {
 protected:
  TempFolder folder_;
};

TEST_F(ThroughAssimp, ColladaSaysItsUnitAndAxes) {
  const Scene z_up =
      read_scene(folder_.write("a.dae", collada("<unit name=\"cm\" meter=\"0.01\"/><up_axis>Z_UP</up_axis>",
                                                "0 0 75 100 0 75 100 200 75 0 200 75")));
  const Scene y_up = read_scene(folder_.write("b.dae", collada("<unit name=\"m\" meter=\"1\"/><up_axis>Y_UP</up_axis>",
                                                               "0 0.75 0 1 0.75 0 1 0.75 -2 0 0.75 -2")));
  for (const Scene* scene : {&z_up, &y_up}) {
    EXPECT_LT(length(extent(*scene).lower - Vec3{-1, 0, 0.75}), 1e-6);
    EXPECT_LT(length(extent(*scene).upper - Vec3{1, 2, 0.75}), 1e-6);
    EXPECT_EQ(scene->polygons.corner.size(), 8u);  // quads stay quads
    EXPECT_GT(area_vector(*scene, 0).z, 0);
    EXPECT_EQ(scene->surfaces, (std::vector<std::string>{"table", "mirrored"}));
    EXPECT_NEAR(material(*scene, "paint").reflectance[1], 0.6, 1e-6);
    EXPECT_NEAR(material(*scene, "paint").exitance[0], 2 * std::numbers::pi, 1e-6);
  }
  EXPECT_GT(area_vector(z_up, 1).z, 0);  // the mirrored one faces up as well
}

TEST_F(ThroughAssimp, FbxSaysItsUnitAndAxes) {
  const std::filesystem::path sheet = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "tests/fuzz/corpus/fbx/sheet.fbx";
  std::string fbx = read_text(sheet);  // a sheet of 1.5 x 1 units, z up, unit 100 cm
  EXPECT_LT(length(extent(read_scene(folder_.write("a.fbx", fbx))).size() - Vec3{150, 100, 0}), 1e-3);
  const std::string unit = "\"UnitScaleFactor\", \"double\", \"Number\", \"\", 100",
                    axis = "\"UpAxis\", \"int\", \"Integer\", \"\", 2";
  ASSERT_NE(fbx.find(unit), std::string::npos);
  fbx.replace(fbx.find(unit), unit.size(), "\"UnitScaleFactor\", \"double\", \"Number\", \"\", 1");
  fbx.replace(fbx.find(axis), axis.size(), "\"UpAxis\", \"int\", \"Integer\", \"\", 1");
  EXPECT_LT(length(extent(read_scene(folder_.write("a.fbx", fbx))).size() - Vec3{1.5, 0, 1}), 1e-5);
}

TEST_F(ThroughAssimp, TheMarkOfUtf8IsSkipped) {
  const std::string dae = collada("<up_axis>Z_UP</up_axis>", "0 0 1 1 0 1 1 2 1 0 2 1");
  EXPECT_LT(length(extent(read_scene(folder_.write("a.dae", "\xef\xbb\xbf" + dae))).upper - Vec3{1, 2, 1}), 1e-6);
  const std::string fbx = read_text(std::filesystem::path(CLERESTORY_SOURCE_DIR) / "tests/fuzz/corpus/fbx/sheet.fbx");
  EXPECT_LT(length(extent(read_scene(folder_.write("a.fbx", "\xef\xbb\xbf" + fbx))).size() - Vec3{150, 100, 0}), 1e-3);
}

TEST_F(ThroughAssimp, DamagedFilesAreRefusedAndCrashesStayInTheChild) {
  for (const std::string_view name : {"a.dae", "a.fbx"}) {
    EXPECT_NE(refusal(folder_.write(name, "garbage")).find("cannot be read"), std::string::npos) << name;
    EXPECT_NE(refusal(folder_.write(name, std::string(5000, '\xff'))).find("cannot be read"), std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace clerestory
