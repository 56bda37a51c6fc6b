// The answer of the IFC reader, byte by byte.

#include "io/formats/ifc_answer.h"

#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

template <class T>
std::string bytes_of(std::initializer_list<T> values) {
  return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}
std::string record(std::uint32_t tag, const std::string& bytes) {
  return bytes_of<std::uint32_t>({tag, 0}) + bytes_of<std::uint64_t>({bytes.size()}) + bytes;
}
/// One triangle, in a place that turns z up and moves it by 10 along x.
std::string triangle(std::uint32_t owner, std::uint32_t last_corner = 2) {
  return bytes_of<std::uint32_t>({owner, 0, 3, 3}) + bytes_of<double>({1, 0, 0, 10, 0, 0, -1, 0, 0, 1, 0, 0}) +
         bytes_of<float>({0, 0, 0, 0.1f, 0, 0, 0, 0.1f, 0}) + bytes_of<std::uint32_t>({0, 1, last_corner});
}
std::string end(const std::string& surfaces = R"("wall")") {
  return record(4, R"({"surfaces":[)" + surfaces + R"(],"materials":[{"name":"paint","colour":[0.5,0.25,1]}],
      "spaces":[{"name":"R1"}],"fixtures":[],"left_out":[{"what":"IfcGrid","count":2,"first":"g"}]})");
}

std::string failure(const std::string& answer) {
  try {
    model_of_ifc_answer(answer, "folder/a.ifc");
    return "(it was read)";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(IfcAnswer, SurfacesAndSpacesStandWhereTheirPlaceSays) {
  const Model model = model_of_ifc_answer(
      "CLIFC001" + record(1, "wall") + record(2, triangle(0)) + record(3, triangle(0)) + end(), "a.ifc");
  EXPECT_EQ(model.surfaces, std::vector<std::string>{"wall"});
  ASSERT_EQ(model.polygons.vertices.size(), 3u);
  EXPECT_EQ(model.polygons.vertices[1], (Vec3{10.1, 0, 0}));  // 0.1f as it was written
  EXPECT_EQ(model.polygons.vertices[2], (Vec3{10, 0, 0.1}));
  EXPECT_EQ(model.materials[0].material.reflectance[1], 0.25);
  EXPECT_EQ(model.spaces[0].corner, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(model.not_read[0].count, 2u);
}

TEST(IfcAnswer, ARefusalIsToldAsOne) {
  EXPECT_EQ(failure("CLIFC001" + record(4, R"({"refused":"has the schema 'X'"})")), "a.ifc: has the schema 'X'");
}

TEST(IfcAnswer, WhatDoesNotFitTogetherIsFoundOut) {
  const std::string whole = "CLIFC001" + record(2, triangle(0)) + end();
  EXPECT_EQ(failure(whole), "(it was read)");
  for (std::size_t length = 0; length < whole.size(); length += 7)
    EXPECT_NE(failure(whole.substr(0, length)), "(it was read)");
  EXPECT_EQ(failure("CLIFC001" + record(2, triangle(1)) + end()), "a mesh belongs to no surface or material");
  EXPECT_EQ(failure("CLIFC001" + record(3, triangle(1)) + end()), "a mesh belongs to no space");
  EXPECT_NE(failure("CLIFC001" + record(2, triangle(0, 3)) + end()).find("uses vertex 3"), std::string::npos);
  EXPECT_EQ(failure("CLIFC001" + record(2, triangle(0) + "x") + end()), "a mesh of the answer is too long");
  EXPECT_EQ(failure("CLIFC001" + end("")),
            "a.ifc: has no faces; nothing to light. Export its surfaces as polygons or triangles");
}

/// A light source of planes C at these angles, all of 100 cd/lm down to 60 degrees.
std::string planes(std::initializer_list<double> angles) {
  std::string list;
  for (const double angle : angles)
    list += (list.empty() ? R"({"angle":)" : R"(,{"angle":)") + std::to_string(angle) +
            R"(,"angles":[0,60],"intensities":[100,100]})";
  return R"("distribution":{"type":"TYPE_C","planes":[)" + list + "]}";
}

/// The wall, and a fixture for each of these light sources.
Model lit_wall(const std::vector<std::string>& sources, const std::string& ifc_file = "a.ifc") {
  std::string fixtures;
  for (const std::string& source : sources)
    fixtures +=
        (fixtures.empty() ? "" : ",") +
        std::string(R"({"names":["lamp"],"is_fixture":true,"position":[0,0,2],"x":[1,0,0],"z":[0,0,1],"sources":[
      {"kind":"goniometric","name":"led","flux":800,"colour":[1,1,1],"position":[0,0,2],"x":[1,0,0],"z":[0,0,1],)") +
        source + "}]}";
  return model_of_ifc_answer(
      "CLIFC001" + record(2, triangle(0)) +
          record(4,
                 R"({"surfaces":["wall"],"materials":[{"name":"paint"}],"spaces":[],"fixtures":[)" + fixtures + "]}"),
      ifc_file);
}

TEST(IfcAnswer, IntensitiesAreOfTheSymmetryThatTheirPlanesSay) {
  const auto kind = [](std::initializer_list<double> angles) -> std::string {
    const Luminaire light = lit_wall({planes(angles)}).fixtures[0].lights[0];
    const auto* web = std::get_if<WebLuminaire>(&light.kind);
    if (!web) return "a point";
    constexpr const char* kNames[] = {"none", "rotational", "about 0-180", "about 90-270", "quadrants"};
    constexpr WebSymmetry kKinds[] = {WebSymmetry::none, WebSymmetry::rotational, WebSymmetry::about_0_180,
                                      WebSymmetry::about_90_270, WebSymmetry::quadrants};
    return kNames[std::ranges::find(kKinds, web->web->symmetry) - std::begin(kKinds)];
  };
  EXPECT_EQ(kind({0}), "rotational");
  EXPECT_EQ(kind({90}), "rotational") << "one plane, wherever it is";
  EXPECT_EQ(kind({0, 45, 90}), "quadrants");
  EXPECT_EQ(kind({0, 90, 180}), "about 0-180");
  EXPECT_EQ(kind({90, 180, 270}), "about 90-270");
  EXPECT_EQ(kind({0, 90, 180, 270}), "none");
  EXPECT_EQ(kind({0, 90, 180, 270, 360}), "none");
  for (const auto& angles : {std::initializer_list<double>{45, 90}, {30, 180}, {0, 45}, {0, 135}})
    EXPECT_EQ(kind(angles), "a point");
}

TEST(IfcAnswer, PhotometricFilesBesideTheModelAreFoundInAnyCaseReadOnceAndTold) {
  TempFolder folder;
  const std::string good =
      folder.write("Lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 2 1 1 2 0 0 0\n1 1 50\n0 90\n0\n100 0\n");
  const std::string bad = folder.write("bad.ies", "no photometry\n");
  const Model model = lit_wall({R"("file":"C:\\lamps\\LAMP.IES")", R"("file":"lamp.ies")", R"("file":"bad.ies")",
                                R"("file":"bad.ies")", R"("file":"none.ies")"},
                               folder / "a.ifc");
  const auto web = [&](std::size_t i) {
    const auto* luminaire = std::get_if<WebLuminaire>(&model.fixtures[i].lights[0].kind);
    return luminaire ? luminaire->web.get() : nullptr;
  };
  ASSERT_NE(web(0), nullptr);
  EXPECT_EQ(web(0), web(1));
  EXPECT_EQ(web(2), nullptr);
  EXPECT_EQ(model.files, (std::vector<std::filesystem::path>{good, bad}));
  const auto count = [&](const std::string& words) {
    return std::ranges::count_if(model.warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
  };
  EXPECT_EQ(count("no line TILT"), 1) << "what is wrong with it is said once";
  EXPECT_EQ(count("'bad.ies' gives no light that can be read"), 2);
  EXPECT_EQ(count("'none.ies' is not beside the model"), 1);
}

TEST(IfcAnswer, TheProductInWorkIsKnownWhereItEnds) {
  EXPECT_EQ(last_ifc_product("CLIFC001" + record(1, "a") + record(2, triangle(0)) + record(1, "b") + "cut"), "b");
  EXPECT_EQ(last_ifc_product(""), "");
}

}  // namespace
}  // namespace clerestory
