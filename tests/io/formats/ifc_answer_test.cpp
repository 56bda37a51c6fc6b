// The answer of the IFC reader, byte by byte.

#include "io/formats/ifc_answer.h"

#include <cstring>

#include <gtest/gtest.h>

#include "solver/model/error.h"

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
  EXPECT_EQ(failure("CLIFC001" + end("")), "a.ifc: has no faces; nothing to light");
}

TEST(IfcAnswer, TheProductInWorkIsKnownWhereItEnds) {
  EXPECT_EQ(last_ifc_product("CLIFC001" + record(1, "a") + record(2, triangle(0)) + record(1, "b") + "cut"), "b");
  EXPECT_EQ(last_ifc_product(""), "");
}

}  // namespace
}  // namespace clerestory
