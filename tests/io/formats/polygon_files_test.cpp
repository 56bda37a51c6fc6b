// PLY, STL and OFF: polygons without materials.

#include <cstring>

#include <gtest/gtest.h>

#include "tests/io/reading.h"

namespace clerestory {
namespace {

class PolygonFiles : public ::testing::Test {
 protected:
  Scene read(std::string_view name, std::string_view content) { return read_scene(folder_.write(name, content)); }
  std::string refused(std::string_view name, std::string_view content) { return refusal(folder_.write(name, content)); }
  TempFolder folder_;
};

constexpr std::string_view kPlyPentagon =
    "ply\nformat ascii 1.0\ncomment by hand\nelement vertex 5\nproperty double x\nproperty double y\nproperty double "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1.5 0.5 0\n1 1 0\n1000000.000000001 1 0\n5 0 1 2 3 4\n";

TEST_F(PolygonFiles, PlyKeepsPolygonsAndDoublePrecision) {
  const Scene scene = read("a.ply", kPlyPentagon);
  EXPECT_EQ(scene.polygons.face_count(), 1u);
  EXPECT_EQ(scene.polygons.corner.size(), 5u);
  EXPECT_EQ(scene.polygons.vertices[4].x, 1000000.000000001);
  EXPECT_EQ(scene.surfaces[0], "a");
  EXPECT_EQ(material(scene, "default").reflectance, Spectrum(0.5));
}

TEST_F(PolygonFiles, PlyIsReadInBothByteOrdersPastPropertiesItDoesNotNeed) {
  for (const bool big : {false, true}) {
    std::string bytes =
        std::string("ply\nformat binary_") + (big ? "big" : "little") +
        "_endian 1.0\nelement camera 1\nproperty list uchar short setup\nelement vertex 3\nproperty float x\n"
        "property uchar red\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar ushort vertex_index\nend_header\n";
    const auto put = [&](auto value) {
      char raw[sizeof(value)];
      std::memcpy(raw, &value, sizeof(value));
      if (big) std::reverse(raw, raw + sizeof(value));
      bytes.append(raw, sizeof(value));
    };
    put(std::uint8_t{2});
    put(std::int16_t{-7});
    put(std::int16_t{9});
    for (const auto& [x, y] : {std::pair{0.f, 0.f}, {2.f, 0.f}, {0.f, 3.f}}) {
      put(x);
      put(std::uint8_t{255});
      put(y);
      put(0.5f);
    }
    put(std::uint8_t{3});
    for (const std::uint16_t v : {0, 1, 2}) put(v);
    const Scene scene = read("a.ply", bytes);
    EXPECT_EQ(extent(scene).upper, (Vec3{2, 3, 0.5}));
    EXPECT_DOUBLE_EQ(area_vector(scene, 0).z, 6);
    bytes.pop_back();
    EXPECT_EQ(refused("a.ply", bytes), "a.ply: face 0 (from 0) of 1: the file ends before it; is it cut off?");
  }
}

TEST_F(PolygonFiles, PlyThatPromisesTooMuchIsRefusedAtOnce) {
  std::string ply(kPlyPentagon);
  ply.replace(ply.find("vertex 5"), 8, "vertex 4294967295");
  EXPECT_EQ(refused("a.ply", ply), "a.ply:4: 4.2949673e+09 of element 'vertex' in a file of 244 bytes");
  EXPECT_EQ(refused("a.ply", std::string(kPlyPentagon).replace(kPlyPentagon.size() - 12, 12, "5 0 1 2 3 9\n")),
            "a.ply: face 1 of 'a' uses vertex 9 (from 0), but there are 5");
  EXPECT_EQ(refused("a.ply", std::string(kPlyPentagon).replace(kPlyPentagon.size() - 12, 12, "5 0 1 2 3 x\n")),
            "a.ply: face 0 (from 0) of 1: 'x' is not a number");
  EXPECT_EQ(refused("a.ply", "not a ply\n"), "a.ply:1: does not start with 'ply'; is it damaged, or another format?");
  EXPECT_EQ(refused("a.ply", "ply\nformat ascii 1.0\n"),
            "a.ply:2: the header ends without 'end_header'; is the file cut off?");
  EXPECT_EQ(refused("a.ply", "ply\nformat ascii 1.0\nend_header\n"),
            "a.ply: has no faces; nothing to light. Export its surfaces as polygons or triangles");
}

TEST_F(PolygonFiles, StlTextKeepsTheNamesOfItsSolids) {
  const std::string solid =
      "solid WALL\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "1e0\nendloop\nendfacet\nendsolid WALL\n";
  const Scene scene = read("a.stl", solid + solid);
  EXPECT_EQ(scene.surfaces, (std::vector<std::string>{"WALL", "WALL 2"}));
  EXPECT_EQ(extent(scene).upper, (Vec3{1, 1, 1}));
  EXPECT_EQ(refused("a.stl", solid.substr(0, 55)), "a.stl:5: 'v' is not a word of an STL file");
  EXPECT_EQ(refused("a.stl", solid.substr(0, solid.size() - 14)),
            "a.stl:9: the file ends before 'endsolid'; is it cut off?");
  EXPECT_EQ(refused("a.stl", "solid x\nvertex 0 0 y\n"), "a.stl:2: 'y' is not a number");
  EXPECT_EQ(refused("a.stl", "solid x\nendsolid x\n"),
            "a.stl: has no faces; nothing to light. Export its surfaces as polygons or triangles");
  EXPECT_NE(refused("a.stl", "garbage").find("neither text that starts with 'solid' nor a binary STL"),
            std::string::npos);
}

TEST_F(PolygonFiles, StlBinaryIsKnownByItsSizeEvenWhenItStartsWithSolid) {
  std::string bytes = std::string("solid by name only").append(62, ' ');
  const std::uint32_t count = 1;
  const float numbers[12] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0};
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  bytes.append(reinterpret_cast<const char*>(numbers), 48);
  bytes.append(2, '\0');
  EXPECT_EQ(extent(read("a.stl", bytes)).upper, (Vec3{2, 3, 0}));
  bytes[0] = 'x';
  bytes.pop_back();
  EXPECT_EQ(refused("a.stl", bytes), "a.stl: is cut off, or no STL file: 1 triangles need 134 bytes, and it has 133");
  bytes[80] = bytes[81] = bytes[82] = bytes[83] = '\xff';
  EXPECT_NE(refused("a.stl", bytes).find("4294967295 triangles need"), std::string::npos);
}

TEST_F(PolygonFiles, OffKeepsPolygonsPastColoursAndRemarks) {
  const Scene scene = read("a.off",
                           "# by hand\nCOFF\n5 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1.5 0.5 0 1 0 0 1\n1 1 0 1 0 0 1\n0 "
                           "1 0 1 0 0 1\n5 0 1 2 3 4 0.2 0.3 0.4\n");
  EXPECT_EQ(scene.polygons.corner.size(), 5u);
  EXPECT_DOUBLE_EQ(extent(scene).upper.x, 1.5);
  EXPECT_EQ(read("a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").polygons.face_count(), 1u);
  EXPECT_EQ(refused("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n"),
            "a.off:4: the file ends where vertex 2 of 3 should follow; is it cut off?");
  EXPECT_EQ(refused("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "a.off:6: a face uses vertex 3, but there are 0 to 2");
  EXPECT_EQ(refused("a.off", "OFF\n3e9 1 0\n0 0 0\n"), "a.off:2: 3e+09 vertices in a file of 18 bytes");
  EXPECT_EQ(refused("a.off", "hello\n"),
            "a.off:1: starts with 'hello'; an .off file in text form starts with OFF, COFF or NOFF");
}

/// One triangle with corners (0, 0, 0), (2, 0, 0) and (0, 3, 0).
std::string binary_stl(const std::string& header) {
  std::string bytes = header + std::string(80 - header.size(), ' ');
  const std::uint32_t count = 1;
  const float numbers[12] = {0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0};
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  bytes.append(reinterpret_cast<const char*>(numbers), 48);
  return bytes + std::string(2, '\0');
}

/// The same as PLY, its lines ended by `end`; the first coordinate begins with the byte LF.
std::string binary_ply(const std::string& end) {
  std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  for (std::size_t at = header.find('\n'); at != header.npos; at = header.find('\n', at + end.size()))
    header.replace(at, 1, end);
  float points[9] = {0, 0, 0, 2, 0, 0, 0, 3, 0};
  reinterpret_cast<char*>(points)[0] = '\n';  // 1.4e-44
  header.append(reinterpret_cast<const char*>(points), sizeof points);
  return header + std::string("\3\0\1\2", 4);
}

TEST_F(PolygonFiles, TheMarkOfUtf8IsSkippedAlsoBeforeABinaryBody) {
  const std::string mark = "\xef\xbb\xbf";
  const std::string stl =
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 3 0\n"
      "endloop\nendfacet\nendsolid x\n";
  for (const auto& [name, content] : {std::pair{"a.stl", stl},
                                      {"a.stl", binary_stl("exported")},
                                      {"a.ply", binary_ply("\n")},
                                      {"a.ply", std::string(kPlyPentagon)},
                                      {"a.off", std::string("OFF\n3 1 0\n0 0 0\n2 0 0\n0 3 0\n3 0 1 2\n")}}) {
    EXPECT_EQ(extent(read(name, mark + content)).upper, extent(read(name, content)).upper) << name;
  }
  // A binary header may itself begin so.
  EXPECT_EQ(extent(read("a.stl", binary_stl(mark + "exported"))).upper, (Vec3{2, 3, 0}));
}

TEST_F(PolygonFiles, LinesMayEndInCrAlone) {
  for (const char* end : {"\n", "\r\n", "\r"})
    EXPECT_FLOAT_EQ(static_cast<float>(extent(read("a.ply", binary_ply(end))).upper.y), 3) << end;
  const auto with_cr = [](std::string content) {
    std::replace(content.begin(), content.end(), '\n', '\r');
    return content;
  };
  EXPECT_EQ(read("a.ply", with_cr(std::string(kPlyPentagon))).polygons.corner.size(), 5u);
  EXPECT_EQ(read("a.off", with_cr("OFF # x\n3 1 0\n0 0 0\n2 0 0\n0 3 0\n3 0 1 2\n")).polygons.face_count(), 1u);
  const Scene stl = read("a.stl", with_cr("solid left\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\n"
                                          "vertex 0 3 0\nendloop\nendfacet\nendsolid left\n"));
  EXPECT_EQ(stl.surfaces, std::vector<std::string>{"left"});
}

}  // namespace
}  // namespace clerestory
