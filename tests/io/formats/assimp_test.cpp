// IFC, Collada and FBX: through Assimp, in a child process.

#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

/// A block of 4 x 2 x 3 m, lower corner in the origin, in an IFC file of the given unit; u is a length of one metre.
std::string ifc_block(const std::string& unit, const std::string& zeros) {
  const auto metres = [&](int n) { return std::to_string(n) + zeros + "."; };
  return "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
         "FILE_NAME('block.ifc','2026-01-01T00:00:00',(''),(''),'','','');\nFILE_SCHEMA(('IFC2X3'));\nENDSEC;\nDATA;\n"
         "#1=IFCPERSON($,$,'x',$,$,$,$,$);\n#2=IFCORGANIZATION($,'x',$,$,$);\n#3=IFCPERSONANDORGANIZATION(#1,#2,$);\n"
         "#4=IFCAPPLICATION(#2,'1','x','x');\n" +
         unit +
         "\n#6=IFCUNITASSIGNMENT((#5));\n"
         "#7=IFCCARTESIANPOINT((0.,0.,0.));\n#8=IFCDIRECTION((0.,0.,1.));\n#9=IFCDIRECTION((1.,0.,0.));\n"
         "#10=IFCAXIS2PLACEMENT3D(#7,#8,#9);\n#11=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#10,$);\n"
         "#12=IFCOWNERHISTORY(#3,#4,$,.ADDED.,$,$,$,0);\n"
         "#13=IFCPROJECT('0YvctVUKr0kugbFTf53O9L',#12,'p',$,$,$,$,(#11),#6);\n#14=IFCLOCALPLACEMENT($,#10);\n"
         "#15=IFCSITE('1YvctVUKr0kugbFTf53O9L',#12,'site',$,$,#14,$,$,.ELEMENT.,$,$,$,$,$);\n"
         "#16=IFCBUILDING('2YvctVUKr0kugbFTf53O9L',#12,'building',$,$,#14,$,$,.ELEMENT.,$,$,$);\n"
         "#17=IFCBUILDINGSTOREY('3YvctVUKr0kugbFTf53O9L',#12,'ground',$,$,#14,$,$,.ELEMENT.,0.);\n"
         "#18=IFCRELAGGREGATES('4YvctVUKr0kugbFTf53O9L',#12,$,$,#13,(#15));\n"
         "#19=IFCRELAGGREGATES('5YvctVUKr0kugbFTf53O9L',#12,$,$,#15,(#16));\n"
         "#20=IFCRELAGGREGATES('6YvctVUKr0kugbFTf53O9L',#12,$,$,#16,(#17));\n"
         "#21=IFCCARTESIANPOINT((" +
         metres(2) + "," + metres(1) +
         "));\n#22=IFCAXIS2PLACEMENT2D(#21,$);\n"
         "#23=IFCRECTANGLEPROFILEDEF(.AREA.,$,#22," +
         metres(4) + "," + metres(2) +
         ");\n"
         "#24=IFCEXTRUDEDAREASOLID(#23,#10,#8," +
         metres(3) +
         ");\n"
         "#25=IFCSHAPEREPRESENTATION(#11,'Body','SweptSolid',(#24));\n#26=IFCPRODUCTDEFINITIONSHAPE($,$,(#25));\n"
         "#27=IFCBUILDINGELEMENTPROXY('7YvctVUKr0kugbFTf53O9L',#12,'block',$,$,#14,#26,$,$);\n"
         "#28=IFCRELCONTAINEDINSPATIALSTRUCTURE('8YvctVUKr0kugbFTf53O9L',#12,$,$,(#27),#17);\nENDSEC;\nEND-ISO-10303-"
         "21;\n";
}

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

TEST_F(ThroughAssimp, IfcComesInMetresZUpWhateverItsUnit) {
  const struct {
    std::string unit, zeros;
  } files[] = {{"#5=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);", ""},
               {"#5=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);", "000"}};
  for (const auto& [unit, zeros] : files) {
    const Scene scene =
        read_scene(folder_.write("block.ifc", ifc_block(unit, zeros)), {.unit = "m", .up = "z", .sky = {}});
    EXPECT_LT(length(extent(scene).lower), 1e-12) << unit;
    EXPECT_LT(length(extent(scene).upper - Vec3{4, 2, 3}), 1e-12) << unit;
    EXPECT_EQ(scene.polygons.face_count(), 6u);
    ASSERT_EQ(scene.surfaces.size(), 1u);
    EXPECT_TRUE(scene.surfaces[0].starts_with("IfcBuildingElementProxy_block")) << scene.surfaces[0];
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(0.5));  // no style: 0.5, with a warning
    EXPECT_NE(all_warnings(scene).find("nothing describes"), std::string::npos);
  }
}

TEST_F(ThroughAssimp, AnIfcFileThatEndsEarlyIsCalledCutOff) {
  const std::string whole = ifc_block("#5=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);", "");
  for (const std::size_t length : {whole.size() - 6, whole.size() / 2, std::size_t{40}})
    EXPECT_EQ(refusal(folder_.write("cut.ifc", whole.substr(0, length))),
              "cut.ifc: is cut off: its last line END-ISO-10303-21; is missing; copy or export it again");
}

TEST_F(ThroughAssimp, IfcInFeetOrCentimetresKeepsItsSize) {
  const std::string feet =
      "#101=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#102=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(0.3048),#101);\n"
      "#103=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n#5= IFCCONVERSIONBASEDUNIT (#103,.LENGTHUNIT.,'FOOT',#102);";
  EXPECT_LT(length(extent(read_scene(folder_.write("a.ifc", ifc_block(feet, "")))).upper - 0.3048 * Vec3{4, 2, 3}),
            1e-12);
  const std::string centimetres = "#5=IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.);";
  EXPECT_LT(length(extent(read_scene(folder_.write("a.ifc", ifc_block(centimetres, "00")))).upper - Vec3{4, 2, 3}),
            1e-12);
}

TEST_F(ThroughAssimp, AGeoreferencedIfcSiteKeepsItsHeight) {
  std::string file = ifc_block("#5=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);", "");
  const std::string placement = "#14=IFCLOCALPLACEMENT($,#10);";
  file.replace(file.find(placement), placement.size(),
               "#14=IFCLOCALPLACEMENT($,#110);\n#107=IFCCARTESIANPOINT((1000000.25,5000000.5,10.));\n"
               "#110=IFCAXIS2PLACEMENT3D(#107,#8,#9);");
  const Extent e = extent(read_scene(folder_.write("a.ifc", file)));
  EXPECT_NEAR(e.lower.z, 10, 1e-6);  // Assimp's own quarter turn would take 0.2 m off
  EXPECT_NEAR(e.size().x, 4, 1e-9);
  EXPECT_NEAR(e.lower.y, 5000000.5, 0.5);  // floats are half a metre apart there
}

TEST_F(ThroughAssimp, TheLargeBuildingIsTheSameAsIfcAndAsObj) {
  const std::filesystem::path models = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "../shared/data/models";
  if (!std::filesystem::exists(models / "LargeBuilding.ifc")) GTEST_SKIP() << "no " << models;
  const Scene ifc = read_scene(models / "LargeBuilding.ifc");
  const Scene obj = read_scene(models / "LargeBuilding.obj", {.unit = {}, .up = "y", .sky = {}});
  // Both went through float coordinates in millimetres: 60 m keep about 4 micrometres.
  EXPECT_LT(length(extent(ifc).lower - extent(obj).lower), 1e-5);
  EXPECT_LT(length(extent(ifc).upper - extent(obj).upper), 1e-5);
  EXPECT_NEAR(extent(ifc).size().z, 8.15, 1e-5);
  EXPECT_GT(ifc.surfaces.size(), 100u);
  EXPECT_EQ(material(ifc, "Glass").kind, MaterialKind::glass);
  EXPECT_NEAR(material(ifc, "DefaultRoof").reflectance[1], 0.498, 1e-3);
  double area[2] = {0, 0};
  for (std::size_t f = 0; f < ifc.polygons.face_count(); ++f) area[0] += length(area_vector(ifc, f)) / 2;
  for (std::size_t f = 0; f < obj.polygons.face_count(); ++f) area[1] += length(area_vector(obj, f)) / 2;
  EXPECT_NEAR(area[0] / area[1], 1, 0.01);
}

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
  const std::string block = ifc_block("#5=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);", "");
  for (const std::string_view name : {"a.ifc", "a.dae", "a.fbx"}) {
    EXPECT_NE(refusal(folder_.write(name, "garbage")).find("cannot be read"), std::string::npos) << name;
    EXPECT_NE(refusal(folder_.write(name, std::string(5000, '\xff'))).find("cannot be read"), std::string::npos)
        << name;
  }
  std::size_t refused = 0;
  for (std::size_t length = block.size() / 2; length < block.size(); length += 97) {
    const std::string message = refusal(folder_.write("a.ifc", block.substr(0, length)));
    refused += message.starts_with("a.ifc: ") ? 1 : 0;
  }
  EXPECT_GT(refused, 5u);       // cut in the last lines it may still make sense
  std::string spliced = block;  // a solid that is made of itself
  spliced.replace(spliced.find("(#23,#10,#8"), 11, "(#24,#10,#8");
  EXPECT_TRUE(refusal(folder_.write("a.ifc", spliced)).starts_with("a.ifc: "));
}

}  // namespace
}  // namespace clerestory
