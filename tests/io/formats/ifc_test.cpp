// IFC, by web-ifc in a Node child process.

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "solver/lights/luminaire.h"
#include "solver/model/units.h"
#include "tests/io/formats/ifc_text.h"
#include "tests/io/reading.h"

namespace clerestory {
namespace {

/// Area of faces in the plane axis = at, of a surface or of all, towards both sides.
double area_in_plane(const Scene& scene, int axis, double at, const std::string& surface = "") {
  double area = 0;
  for (std::size_t f = 0; f < scene.polygons.face_count(); ++f) {
    if (!surface.empty() && scene.surfaces[scene.polygons.surface[f]] != surface) continue;
    bool inside = true;
    for (std::uint32_t c = scene.polygons.face_begin[f]; c < scene.polygons.face_begin[f + 1]; ++c)
      inside &= std::abs(scene.polygons.vertices[scene.polygons.corner[c]][axis] - at) < 1e-5;
    if (inside) area += length(area_vector(scene, f)) / 2;
  }
  return area;
}

std::size_t faces_of(const Scene& scene, std::string_view material) {
  std::size_t count = 0;
  for (const MaterialId m : scene.polygons.material) count += scene.materials[m].name == material;
  return count;
}

class ReadIfc : public ::testing::Test {
 protected:
  void SetUp() override {
    IfcText ifc;
    ifc.wall("wall", ifc.box({}, {1, 1, 1}));
    try {
      read(ifc);
    } catch (const InputError& error) {
      if (std::string_view(error.what()).find("install_dependencies.sh") != std::string_view::npos)
        GTEST_SKIP() << error.what();
      throw;
    }
  }
  Scene read(IfcText& ifc, const ReadOptions& options = {}) {
    return read_scene(folder_.write("a.ifc", ifc.str()), options);
  }
  Scene read_with(IfcText& ifc, const std::string& rest) {
    folder_.write("a.ifc", ifc.str());
    return read_scene(folder_.write("scene.json", R"({ "geometry": [{ "file": "a.ifc" }], )" + rest + " }"));
  }
  TempFolder folder_;
};

TEST_F(ReadIfc, MillimetresMetresFeetAndInchesComeInMetresZUp) {
  const auto converted = [](const char* name, const char* metres) {
    // References count from 1, and the unit is the first entity; what it is made of may come after it.
    return std::string("IFCCONVERSIONBASEDUNIT(#901,.LENGTHUNIT.,'") + name + "',#902);\n" +
           "#901=IFCDIMENSIONALEXPONENTS(1,0,0,0,0,0,0);\n#902=IFCMEASUREWITHUNIT(IFCLENGTHMEASURE(" + metres +
           "),#903);\n#903=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)";
  };
  const struct {
    std::string unit;
    double per_metre;
  } files[] = {{"IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)", 1},
               {"IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)", 1000},
               {"IFCSIUNIT(*,.LENGTHUNIT.,.CENTI.,.METRE.)", 100},
               {converted("FOOT", "0.3048"), 1 / 0.3048},
               {converted("INCH", "0.0254"), 1 / 0.0254}};
  for (const auto& [unit, per_metre] : files) {
    IfcText ifc({.unit = unit, .per_metre = per_metre});
    ifc.wall("block", ifc.box({1, 2, 0}, {4, 2, 3}));
    const Scene scene = read(ifc, {.unit = "m", .up = "z", .sky = {}});
    // The file has six digits behind the point, web-ifc floats around the middle: 1e-6 of a foot.
    EXPECT_LT(length(extent(scene).lower - Vec3{1, 2, 0}), 1e-6) << unit;
    EXPECT_LT(length(extent(scene).upper - Vec3{5, 4, 3}), 1e-6) << unit;
    ASSERT_EQ(scene.surfaces, std::vector<std::string>{"block"});
    EXPECT_EQ(scene.polygons.face_count(), 12u);
    EXPECT_EQ(scene.materials[0].reflectance, Spectrum(0.5));  // no style: 0.5, with a warning
    EXPECT_NE(all_warnings(scene).find("nothing describes"), std::string::npos);
  }
}

TEST_F(ReadIfc, EverySchemaGivesTheSameRoomWithOwnerHistoriesAndWithout) {
  for (const IfcText::Options& options :
       {IfcText::Options{.schema = "IFC2X3"}, IfcText::Options{}, IfcText::Options{.owner_history = true},
        IfcText::Options{.schema = "IFC4X3_ADD2"}}) {
    IfcText ifc(options);
    ifc.cut(ifc.room(), ifc.box({1, -0.1, 1}, {2, 0.4, 1}));
    const Scene scene = read(ifc);
    EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"floor", "roof", "west", "east", "north", "south"}));
    EXPECT_NEAR(area_in_plane(scene, 1, 0, "south"), 4 * 3 - 2, 1e-5) << options.schema;
    EXPECT_LT(length(extent(scene).size() - Vec3{4, 4, 3.4}), 1e-6);
  }
}

TEST_F(ReadIfc, AStyleIsFoundWithAnAssignmentBetweenAndWithout) {
  for (const char* schema : {"IFC2X3", "IFC4"}) {
    IfcText ifc({.schema = schema});
    ifc.cut(ifc.room(), ifc.box({1, -0.1, 1}, {2, 0.4, 1}));
    const std::string pane = ifc.box({1, 0.09, 1}, {2, 0.02, 1});
    ifc.style("clear", "0.8,0.8,0.9", "0.7", {pane});
    ifc.window("win", pane);
    const Scene scene = read(ifc);
    EXPECT_EQ(material(scene, "clear").kind, MaterialKind::glass);
    EXPECT_EQ(material(scene, "clear").transmittance, Spectrum(0.7));
    EXPECT_EQ(faces_of(scene, "clear"), 12u);
    EXPECT_EQ(scene.surfaces.back(), "win");
  }
}

TEST_F(ReadIfc, HighlightsOfStylesAreGlossWhereItIsAskedFor) {
  for (const char* schema : {"IFC2X3", "IFC4"}) {
    IfcText ifc({.schema = schema});
    const std::string sharp = ifc.box({}, {1, 1, 1}), rough = ifc.box({2, 0, 0}, {1, 1, 1}),
                      matt = ifc.box({4, 0, 0}, {1, 1, 1});
    ifc.style("lacquer", "0.4,0.4,0.4", "0.", {sharp}, "IFCNORMALISEDRATIOMEASURE(0.25),IFCSPECULAREXPONENT(64.)");
    ifc.style("brass", "0.4,0.4,0.2", "0.", {rough}, "IFCNORMALISEDRATIOMEASURE(0.5),IFCSPECULARROUGHNESS(0.2)");
    ifc.style("chalk", "0.4,0.4,0.4", "0.", {matt}, "IFCNORMALISEDRATIOMEASURE(0.5),$");
    ifc.wall("a", sharp), ifc.wall("b", rough), ifc.wall("c", matt);
    const Scene scene = read(ifc, {.gloss = "model"});
    ASSERT_TRUE(material(scene, "lacquer").is_glossy()) << schema;
    EXPECT_NEAR(material(scene, "lacquer").gloss->specular[0], 0.1, 1e-12);
    EXPECT_EQ(material(scene, "lacquer").gloss->exponent, 64);
    ASSERT_TRUE(material(scene, "brass").is_glossy()) << schema;
    EXPECT_NEAR(material(scene, "brass").gloss->specular[2], 0.1, 1e-12);
    EXPECT_EQ(material(scene, "brass").gloss->roughness, 0.2);
    EXPECT_FALSE(material(scene, "chalk").is_glossy());
    EXPECT_FALSE(material(read(ifc), "brass").is_glossy());
  }
}

TEST_F(ReadIfc, TessellationAndBrepsAreCutByTheirOpenings) {
  const auto area = [&](auto make) {
    IfcText ifc;
    const std::string wall = ifc.wall("wall", make(ifc));
    ifc.cut(wall, ifc.brep({1, -0.1, 1}, {2, 0.4, 1}));
    const Scene scene = read(ifc);
    EXPECT_NEAR(area_in_plane(scene, 0, 1), 0.2, 1e-5);  // a reveal
    return area_in_plane(scene, 1, 0);
  };
  const Vec3 lower{}, size{4, 0.2, 3};
  EXPECT_NEAR(area([&](IfcText& ifc) { return ifc.triangles(lower, size); }), 10, 1e-5);
  EXPECT_NEAR(area([&](IfcText& ifc) { return ifc.polygons(lower, size); }), 10, 1e-5);
  EXPECT_NEAR(area([&](IfcText& ifc) { return ifc.brep(lower, size); }), 10, 1e-5);
}

TEST_F(ReadIfc, ANicheHasABackAndFourReveals) {
  IfcText ifc({.unit = "IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.)", .per_metre = 1000});
  ifc.cut(ifc.wall("wall", ifc.box({}, {4, 0.2, 3})), ifc.box({1, 0.05, 1}, {2, 0.25, 1}));
  const Scene scene = read(ifc);
  EXPECT_NEAR(area_in_plane(scene, 1, 0.05), 2, 1e-5);
  EXPECT_NEAR(area_in_plane(scene, 1, 0.2), 12 - 2, 1e-5);
  EXPECT_NEAR(
      area_in_plane(scene, 0, 1) + area_in_plane(scene, 0, 3) + area_in_plane(scene, 2, 1) + area_in_plane(scene, 2, 2),
      0.9, 1e-5);
}

TEST_F(ReadIfc, OnlyTheBodyOfAProductIsASurface) {
  IfcText ifc;
  const std::string box = ifc.add("IFCBOUNDINGBOX(" + ifc.point({0, 0, 0}) + ",9.,9.,9.)");
  const std::string shapes = ifc.shape(box, "Box") + "," + ifc.shape(ifc.box({-3, -3, 0}, {9, 9, 9}), "Clearance") +
                             "," + ifc.shape(ifc.box({}, {4, 0.2, 3}));
  ifc.element("IFCWALL", "wall", shapes, "$,$");
  EXPECT_LT(length(extent(read(ifc)).size() - Vec3{4, 0.2, 3}), 1e-6);
}

TEST_F(ReadIfc, PanesOfWindowsAreGlassAndLeavesOfDoorsAreNot) {
  IfcText ifc;
  ifc.room();
  std::string parts = ifc.box({1.05, 0.09, 1.05}, {1.9, 0.02, 0.9});  // the pane
  for (const auto& [lower, size] : {std::pair{Vec3{1, 0.05, 1}, Vec3{2, 0.1, 0.05}},
                                    {{1, 0.05, 1.95}, {2, 0.1, 0.05}},
                                    {{1, 0.05, 1.05}, {0.05, 0.1, 0.9}},
                                    {{2.95, 0.05, 1.05}, {0.05, 0.1, 0.9}}})
    parts += "," + ifc.box(lower, size);
  ifc.window("win", parts);
  ifc.element("IFCDOOR", "leaf", ifc.shape(ifc.box({0.5, 3.85, 0}, {0.9, 0.04, 2})), "1.,1.,$,$,$");
  const Scene scene = read(ifc);
  EXPECT_EQ(material(scene, "glass").kind, MaterialKind::glass);
  EXPECT_EQ(faces_of(scene, "glass"), 12u);
  EXPECT_NE(all_warnings(scene).find("'win' is glass that says no transparency"), std::string::npos);
}

TEST_F(ReadIfc, PanelsOfACurtainWallAreGlassByTheirNames) {
  IfcText ifc;
  const std::string glass = ifc.box({}, {1, 0.02, 2}), metal = ifc.box({1, 0, 0}, {1, 0.02, 2});
  ifc.style("Glazing", "0.5,0.6,0.7", "$", {glass});
  ifc.style("Metal", "0.5,0.5,0.5", "$", {metal});
  const std::string whole = ifc.element("IFCCURTAINWALL", "facade", "", "$");
  const std::string panels = ifc.product("IFCPLATE", "p1", ifc.shape(glass), "$,.CURTAIN_PANEL.") + "," +
                             ifc.product("IFCPLATE", "p2", ifc.shape(metal), "$,.CURTAIN_PANEL.");
  ifc.root("IFCRELAGGREGATES", "$,$," + whole + ",(" + panels + ")");
  const Scene scene = read(ifc);
  EXPECT_EQ(material(scene, "Glazing").kind, MaterialKind::glass);
  EXPECT_EQ(material(scene, "Metal").kind, MaterialKind::diffuse);
  EXPECT_NE(all_warnings(scene).find("'p2' is a panel of a curtain wall"), std::string::npos);
}

TEST_F(ReadIfc, AWindowWithoutAPaneIsSaidToStayOpaque) {
  IfcText ifc;
  ifc.window("thick", ifc.box({}, {2, 0.3, 1}));
  EXPECT_NE(all_warnings(read(ifc)).find("'thick' is a window without a part that looks like a pane"),
            std::string::npos);
}

TEST_F(ReadIfc, MaterialsGiveNamesStylesAndReflectances) {
  IfcText ifc;
  const std::string wall = ifc.wall("wall", ifc.box({}, {1, 1, 1}));
  const std::string slab = ifc.element("IFCSLAB", "slab", ifc.shape(ifc.box({2, 0, 0}, {1, 1, 1})), "$,.FLOOR.");
  const std::string post = ifc.wall("post", ifc.box({4, 0, 0}, {1, 1, 1}));
  const std::string plaster = ifc.add("IFCMATERIAL('Plaster',$,$)"), concrete = ifc.add("IFCMATERIAL('Concrete',$,$)");
  const auto property = [&](const std::string& value) {
    return ifc.add("IFCPROPERTYSINGLEVALUE('Reflectance',$," + value + ",$)");
  };
  ifc.add("IFCMATERIALPROPERTIES('optics',$,(" + property("IFCNORMALISEDRATIOMEASURE(0.72)") + ")," + plaster + ")");
  const std::string layers =
      ifc.add("IFCMATERIALLAYERSET((" + ifc.add("IFCMATERIALLAYER(" + plaster + ",0.1,$,$,$,$,$)") + "),'w',$)");
  ifc.material(ifc.add("IFCMATERIALLAYERSETUSAGE(" + layers + ",.AXIS2.,.POSITIVE.,0.,$)"), wall);
  ifc.material(concrete, slab);
  const std::string styled = ifc.add("IFCSTYLEDITEM($,(" + ifc.style("grey", "0.3,0.3,0.3", "$", {}) + "),$)");
  ifc.add("IFCMATERIALDEFINITIONREPRESENTATION($,$,(" +
          ifc.add("IFCSTYLEDREPRESENTATION(" + ifc.context() + ",'Style','Material',(" + styled + "))") + ")," +
          concrete + ")");
  const std::string set = ifc.root("IFCPROPERTYSET", "'light',$,(" + property("IFCREAL(35.)") + ")");
  ifc.root("IFCRELDEFINESBYPROPERTIES", "$,$,(" + post + ")," + set);
  const Scene scene = read(ifc);
  EXPECT_EQ(material(scene, "Plaster").reflectance, Spectrum(0.72));
  EXPECT_NEAR(material(scene, "grey").reflectance[0], 0.3, 1e-12);
  EXPECT_EQ(material(scene, "post").reflectance, Spectrum(0.35));  // per cent
}

TEST_F(ReadIfc, TrianglesHaveColoursOfTheirOwn) {
  IfcText ifc;
  const std::string item = ifc.triangles({}, {1, 1, 1});
  ifc.add("IFCINDEXEDCOLOURMAP(" + item + ",$," + ifc.add("IFCCOLOURRGBLIST(((0.5,0.,0.),(0.,0.5,0.)))") +
          ",(1,1,1,2,2,2,2,2,2,2,2,2))");
  ifc.wall("wall", item);
  const Scene scene = read(ifc);
  EXPECT_EQ(faces_of(scene, "colour 128 0 0"), 3u);
  EXPECT_EQ(faces_of(scene, "colour 0 128 0"), 9u);
}

TEST_F(ReadIfc, AGeoreferencedSiteKeepsItsPlaceAndTheScenesNorthIsComparedWithTheModels) {
  IfcText ifc({.site = {1'000'000.25, 5'000'000.5, 10}, .true_north = "1.,1."});
  ifc.room();
  const Scene scene = read_with(ifc, R"("location": { "north": 0 })");
  EXPECT_LT(length(extent(scene).lower - Vec3{1'000'000.25, 5'000'000.5, 9.8}), 1e-6);
  EXPECT_LT(length(extent(scene).size() - Vec3{4, 4, 3.4}), 1e-6);
  EXPECT_NEAR(scene.model_north_deg.value_or(0), 45, 1e-9);
  EXPECT_NE(all_warnings(scene).find("north is 45 degrees clockwise"), std::string::npos);
  EXPECT_EQ(all_warnings(read_with(ifc, R"("location": { "north": 45 })")).find("north is"), std::string::npos);
}

TEST_F(ReadIfc, SpacesAreNamedVolumesThatGridsFill) {
  IfcText ifc;
  ifc.room();
  ifc.space("R1", "Office", ifc.box({0.2, 0.2, 0}, {3.6, 3.6, 3}));
  ifc.space("R2", "Store", "");
  const Scene scene =
      read_with(ifc, R"("sensors": [{ "name": "desk", "space": "R*", "spacing": 0.5, "height": 0.75 }])");
  EXPECT_EQ(scene.surfaces.size(), 6u);
  ASSERT_EQ(scene.spaces.size(), 2u);
  EXPECT_EQ(scene.spaces[0].name + "/" + scene.spaces[0].long_name, "R1/Office");
  EXPECT_NEAR(floor_area(scene.spaces[0]), 3.6 * 3.6, 1e-5);
  EXPECT_NEAR(volume(scene.spaces[0]), 3.6 * 3.6 * 3, 1e-5);
  EXPECT_NEAR(height(scene.spaces[0]), 3, 1e-6);
  EXPECT_FALSE(scene.spaces[1].has_volume());
  ASSERT_EQ(scene.sensors.size(), 1u);
  EXPECT_EQ(scene.sensors[0].name, "desk R1");
  // 3.6 m have room for eight steps of 0.5 m, whose outer points lie 0.05 m off the walls.
  EXPECT_EQ(scene.sensors[0].points.size(), 64u);
  for (const SensorPoint& p : scene.sensors[0].points) EXPECT_NEAR(p.position.z, 0.75, 1e-6);
  EXPECT_NE(refusal(folder_.write("s.json", R"({ "geometry": [{ "file": "a.ifc" }],
      "sensors": [{ "space": "Hall*", "spacing": 1 }] })"))
                .find("matches no space; the models have 'R1', 'R2'"),
            std::string::npos);
  for (const char* kind : {R"("horizontal")", R"("camera", "camera": [9, 9, 9])"})
    EXPECT_NE(refusal(folder_.write("s.json", R"({ "geometry": [{ "file": "a.ifc" }], "sensors": [{ "space": "R1",
        "spacing": 1, "normal": [0, 1, 0], "kind": )" +
                                                  std::string(kind) + " }] }"))
                  .find("s.json: sensors[0].normal does not go with \"kind\""),
              std::string::npos);
}

/// A lamp of 1000 lm at (2, 2, 2.8) in a housing, with intensities 0..90 degrees from the nadir.
void add_lamp(IfcText& ifc, const std::string& intensities, bool positional = false) {
  const std::string colour = ifc.add("IFCCOLOURRGB($,1.,1.,1.)"), at = ifc.point({2, 2, 2.8});
  const std::string distribution = ifc.add("IFCLIGHTINTENSITYDISTRIBUTION(.TYPE_C.,(" +
                                           ifc.add("IFCLIGHTDISTRIBUTIONDATA(0.," + intensities + ")") + "))");
  std::string sources = ifc.add("IFCLIGHTSOURCEGONIOMETRIC('led'," + colour + ",0.,1.," + ifc.placement({2, 2, 2.8}) +
                                ",$,3000.,1000.,.LIGHTEMITTINGDIODE.," + distribution + ")");
  if (positional)
    sources += "," + ifc.add("IFCLIGHTSOURCEPOSITIONAL('bulb'," + colour + ",0.,1000.," + at + ",1.,1.,0.,0.)");
  const std::string shapes =
      ifc.shape(ifc.box({1.9, 1.9, 2.8}, {0.2, 0.2, 0.1})) + "," + ifc.shape(sources, "Lighting");
  ifc.element("IFCLIGHTFIXTURE", "Downlight 1", shapes, "$,$");
}

TEST_F(ReadIfc, AGoniometricSourceIsALuminaireOfItsFluxAndIntensities) {
  IfcText ifc;
  ifc.room();
  add_lamp(ifc, "(0.,0.523599,1.047198,1.570796),(320.,277.,160.,0.)", true);
  const Scene scene = read(ifc);
  ASSERT_EQ(scene.lights.luminaires.size(), 1u);
  const Luminaire& lamp = scene.lights.luminaires[0];
  EXPECT_NEAR(photometric(power(lamp)), 1000, 1e-6);
  EXPECT_LT(length(lamp.position - Vec3{2, 2, 2.8}), 1e-9);
  const auto& web = *std::get<WebLuminaire>(lamp.kind).web;
  EXPECT_EQ(web.vertical, (std::vector<double>{0, 30, 60, 90}));
  EXPECT_EQ(web.candela, (std::vector<float>{320, 277, 160, 0}));
  EXPECT_EQ(scene.surfaces.size(), 6u);  // its housing is part of the photometry
  EXPECT_NE(all_warnings(scene).find("'Downlight 1 (positional)'"), std::string::npos);
}

TEST_F(ReadIfc, ASingleRayIsNoDistributionAndTheFluxShinesFromAPoint) {
  IfcText ifc;
  ifc.room();
  add_lamp(ifc, "(0.),(100.)");
  const Scene scene = read(ifc);
  ASSERT_EQ(scene.lights.luminaires.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<PointLuminaire>(scene.lights.luminaires[0].kind));
  EXPECT_NEAR(photometric(power(scene.lights.luminaires[0])), 1000, 1e-6);
  EXPECT_NE(all_warnings(scene).find("taken as a point of 1000 lm"), std::string::npos);
}

TEST_F(ReadIfc, FixturesTakeThePhotometryOfTheSceneFile) {
  folder_.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 45 90\n0\n100 100 0\n");
  IfcText ifc;
  ifc.room();
  add_lamp(ifc, "(0.),(100.)");
  // Hung at (1, 3, 2.6), turned a quarter about z; its body reaches 0.1 m below that.
  const std::string turned =
      ifc.add("IFCAXIS2PLACEMENT3D(" + ifc.point({1, 3, 2.6}) + ",$," + ifc.add("IFCDIRECTION((0.,1.,0.))") + ")");
  ifc.product("IFCLIGHTFIXTURE", "Pendant", ifc.shape(ifc.box({-0.1, -0.1, -0.1}, {0.2, 0.2, 0.1})), "$,$",
              ifc.add("IFCLOCALPLACEMENT($," + turned + ")"));
  ifc.product("IFCLIGHTFIXTURE", "Spare", ifc.shape(ifc.box({0, 0, 5}, {0.2, 0.2, 0.1})), "$,$");
  const Scene scene =
      read_with(ifc, R"("fixtures": { "Pend*": { "file": "lamp.ies", "group": "a", "luminous_flux": 500 },
                                      "Down*": "lamp.ies", "Ghost*": "lamp.ies" })");
  ASSERT_EQ(scene.lights.luminaires.size(), 2u);
  const Luminaire& down = scene.lights.luminaires[0];
  EXPECT_NEAR(photometric(power(down)), std::get<WebLuminaire>(down.kind).web->flux, 1e-9);
  const Luminaire& pendant = scene.lights.luminaires[1];
  EXPECT_EQ(pendant.name + "/" + pendant.group, "Pendant/a");
  EXPECT_NEAR(photometric(power(pendant)), 500, 1e-9);
  EXPECT_LT(length(pendant.position - Vec3{1, 3, 2.5}), 1e-6);
  EXPECT_LT(length(std::get<WebLuminaire>(pendant.kind).axes.x - Vec3{0, 1, 0}), 1e-9);
  EXPECT_LT(length(std::get<WebLuminaire>(pendant.kind).axes.z - Vec3{0, 0, 1}), 1e-9);
  EXPECT_EQ(scene.surfaces.back(), "Spare");
  EXPECT_EQ(scene.surfaces.size(), 7u);
  EXPECT_NE(all_warnings(scene).find("they are left dark: 'Spare'"), std::string::npos);
  EXPECT_NE(all_warnings(scene).find("fixtures 'Ghost*' matches no light fixture"), std::string::npos);
}

TEST_F(ReadIfc, WhatIsNotUnderstoodIsNamedAndCounted) {
  IfcText ifc;
  ifc.wall("whole", ifc.box({}, {1, 1, 1}));
  for (const char* name : {"ring", "ring too"}) {
    const std::string self = ifc.add("IFCBOOLEANRESULT(.UNION.,$,$)");
    ifc.wall(name, ifc.add("IFCEXTRUDEDAREASOLID(" + self + ",$,$,1.)"));
  }
  const Scene scene = read(ifc);
  EXPECT_EQ(scene.surfaces, std::vector<std::string>{"whole"});
  EXPECT_NE(all_warnings(scene).find("'ring' (and 1 more) has a shape that could not be read"), std::string::npos);
  const auto note = std::ranges::find_if(scene.not_read, [](const NotRead& n) { return n.what.starts_with("shape"); });
  ASSERT_NE(note, scene.not_read.end());
  EXPECT_EQ(note->count, 2u);
}

TEST_F(ReadIfc, AShapeMadeOfItselfCostsThatShapeOnly) {
  IfcText ifc;
  const std::string before = ifc.add("IFCDIRECTION((1.,0.,0.))");
  const std::string next = "#" + std::to_string(std::stoi(before.substr(1)) + 1);
  ifc.wall("ring", ifc.add("IFCBOOLEANRESULT(.UNION.," + next + "," + next + ")"));
  ifc.wall("whole", ifc.box({}, {1, 1, 1}));
  const Scene scene = read(ifc);
  EXPECT_EQ(scene.surfaces, std::vector<std::string>{"whole"});
  EXPECT_NE(all_warnings(scene).find("'ring' has a shape"), std::string::npos);
}

TEST_F(ReadIfc, AByteOrderMarkIsSkippedAndUtf16IsNamed) {
  IfcText ifc;
  ifc.wall("wall", ifc.box({}, {1, 1, 1}));
  const std::string text = ifc.str();
  EXPECT_EQ(read_scene(folder_.write("bom.ifc", "\xef\xbb\xbf" + text)).surfaces.size(), 1u);
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += std::string{c, '\0'};
  EXPECT_EQ(refusal(folder_.write("wide.ifc", wide)),
            "wide.ifc: is UTF-16 text; IFC files are plain text (ISO 10303-21). Save it as UTF-8");
}

TEST_F(ReadIfc, TooLittleAddressSpaceForNodeIsNoFaultOfTheFile) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take more address space than any limit";
#endif
  IfcText ifc;
  ifc.room();
  const std::string file = folder_.write("a.ifc", ifc.str());
  rlimit before{};
  getrlimit(RLIMIT_AS, &before);
  rlimit tight = before;
  tight.rlim_cur = rlim_t{4} << 30;
  setrlimit(RLIMIT_AS, &tight);
  const std::string said = refusal(file);
  setrlimit(RLIMIT_AS, &before);
  EXPECT_EQ(said,
            "a.ifc: cannot be read: the .ifc importer, Node.js, takes some 16384 MiB of address space, and 4096 MiB "
            "are allowed (ulimit -v); allow more");
}

TEST_F(ReadIfc, NamesAreDecodedAndUnique) {
  IfcText ifc;
  ifc.wall("Caf\\X2\\00E9\\X0\\", ifc.box({}, {1, 1, 1}));
  ifc.wall("Caf\\X2\\00E9\\X0\\", ifc.box({2, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(read(ifc).surfaces, (std::vector<std::string>{"Caf\xc3\xa9", "Caf\xc3\xa9 2"}));
}

TEST_F(ReadIfc, DamagedFilesAreRefusedOrReadInPart) {
  IfcText ifc;
  ifc.cut(ifc.room(), ifc.box({1, -0.1, 1}, {2, 0.4, 1}));
  const std::string whole = ifc.str();
  const auto spoilt = [&](std::string_view what, std::string_view by) {
    std::string file = whole;
    for (std::size_t at = file.find(what); at != file.npos; at = file.find(what, at + by.size()))
      file.replace(at, what.size(), by);
    return folder_.write("spoilt.ifc", file);
  };
  EXPECT_NE(refusal(spoilt("FILE_SCHEMA(('IFC4'))", "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'))"))
                .find("has the schema 'AUTOMOTIVE_DESIGN', which is not read"),
            std::string::npos);
  for (const auto& [what, by] : {std::pair{"4.000000", "1.E400"},
                                 {"IFCLOCALPLACEMENT($", "IFCLOCALPLACEMENT(#99999999"},
                                 {"IFCRECTANGLEPROFILEDEF(.AREA.", "IFCRECTANGLEPROFILEDEF("},
                                 {"IFCUNITASSIGNMENT", "IFCNOSUCHTHING"},
                                 {"((", "("},
                                 {",$,", ",,"}}) {
    const std::string message = refusal(spoilt(what, by));
    EXPECT_TRUE(message == "(it was read)" || message.starts_with("spoilt.ifc: ")) << message;
  }
}

TEST_F(ReadIfc, TheLargeBuildingIsTheSameAsIfcAndAsObj) {
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
  EXPECT_NEAR(material(ifc, "Default Roof").reflectance[1], 0.498, 1e-3);
  const auto area = [](const Scene& scene, const std::function<bool(const Material&)>& counts) {
    double sum = 0;
    for (std::size_t f = 0; f < scene.polygons.face_count(); ++f)
      if (counts(scene.materials[scene.polygons.material[f]])) sum += length(area_vector(scene, f)) / 2;
    return sum;
  };
  const auto is_glass = [](const Material& m) { return m.kind == MaterialKind::glass; };
  EXPECT_NEAR(area(ifc, is_glass) / area(obj, is_glass), 1, 1e-5);
  // The twin was made by Assimp, which fills the frames of sashes and leaves out 5.6 m2 of wall tops.
  const auto is_no_sash = [](const Material& m) { return m.name != "Sash"; };
  EXPECT_NEAR(area(ifc, is_no_sash), area(obj, is_no_sash) + 5.64, 0.5);
  EXPECT_EQ(ifc.spaces.size(), 8u);
}

TEST(RefuseIfc, WhatIsNoWholeStepFileIsRefusedWithoutNode) {
  const TempFolder folder;
  IfcText ifc;
  ifc.wall("wall", ifc.box({}, {1, 1, 1}));
  const std::string whole = ifc.str();
  for (const std::size_t length : {whole.size() - 6, whole.size() / 2, std::size_t{40}})
    EXPECT_EQ(refusal(folder.write("cut.ifc", whole.substr(0, length))),
              "cut.ifc: is cut off: its last line END-ISO-10303-21; is missing; copy or export it again");
  EXPECT_NE(refusal(folder.write("a.ifc", "garbage")).find("cannot be read"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.ifc", "PK\x03\x04 and more")).find("zip archive"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.ifc", "<?xml version=\"1.0\"?><ifc/>")).find("is XML"), std::string::npos);
}

TEST(RefuseIfc, WithoutNodeTheMessageTellsHowToInstallItAndOtherFormatsAreRead) {
  const TempFolder folder;
  const char* path = std::getenv("PATH");
  const std::string before = path ? path : "";
  IfcText ifc;
  ifc.wall("wall", ifc.box({}, {1, 1, 1}));
  const std::string file = folder.write("a.ifc", ifc.str()), room = folder.write("a.obj", kRoomObj);
  setenv("PATH", "/nowhere", 1);
  const std::string message = refusal(file), other = refusal(room);
  setenv("PATH", before.c_str(), 1);
  EXPECT_NE(message.find("a.ifc: IFC is read by Node.js"), std::string::npos) << message;
  EXPECT_NE(message.find("bash apps/install_dependencies.sh"), std::string::npos) << message;
  EXPECT_EQ(other, "(it was read)");
}

}  // namespace
}  // namespace clerestory
