#include "io/read_result.h"

#include <filesystem>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "io/write_result.h"
#include "solver/model/error.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

/// A triangle with light on both of its sides, far from the origin, in a room.
void write_sheet(const fs::path& file) {
  PatchSet patches;
  patches.origin = {1e6, -2e6, 50};
  patches.vertices = {{0, 0, 0}, {3, 0, 0}, {0, 4, 0}};
  patches.corners = {{VertexId{std::size_t{0}}, VertexId{std::size_t{1}}, VertexId{std::size_t{2}}}};
  patches.side_material = {{MaterialId{std::size_t{0}}, MaterialId{std::size_t{0}}}};
  patches.side_surface = {{SurfaceId{std::size_t{0}}, SurfaceId{std::size_t{0}}}};
  patches.materials.resize(1);
  patches.materials[0].name = "wall";
  patches.surfaces = {"sheet"};
  make_patches(patches, {true, true});
  patches.room = {1, 0}, patches.rooms = {"outdoors", "R1"};
  Solution solution;
  solution.E = solution.B = Field(2, 3);
  VertexLightmap lightmap;
  lightmap.corners = {{0, 1, 2}, {3, 5, 4}};
  lightmap.position = patches.vertices;
  lightmap.position.insert(lightmap.position.end(), patches.vertices.begin(), patches.vertices.end());
  lightmap.patch_of_point = {0, 0, 0, 1, 1, 1};
  lightmap.E = Field(6, 3);
  for (std::size_t i = 0; i < 6; ++i) lightmap.E.set(i, Spectrum(1.0 + static_cast<double>(i)));
  write_result(file, patches, lightmap, solution, {}, new_report("sheet.obj"));
}

TEST(ReadResult, BringsBackWhatWasWritten) {
  const TempFolder folder;
  write_sheet(folder / "a.vtp");
  const WrittenResult r = read_result(fs::path(folder / "a.vtp"));
  ASSERT_EQ(r.points.size(), 6u);
  EXPECT_EQ(r.points[1].x, 1e6 + 3);
  EXPECT_EQ(r.points[1].y, -2e6);
  EXPECT_EQ(r.points[1].z, 50);
  EXPECT_EQ(r.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {3, 5, 4}}));
  EXPECT_EQ(r.of_points.at("irradiance").components, 3);
  EXPECT_EQ(r.of_points.at("irradiance").value.size(), 18u);
  for (std::size_t i = 0; i < 6; ++i)  // 179 lm/W, and the weights of the channels sum to 1
    EXPECT_FLOAT_EQ(r.of_points.at("illuminance").value[i], 179 * (1 + static_cast<float>(i)));
  EXPECT_EQ(r.of_cells.at("room").value, (std::vector<float>{1, 0}));
  EXPECT_EQ(r.texts.at("room_names"), (std::vector<std::string>{"outdoors", "R1"}));
}

std::string refused(const fs::path& file) {
  try {
    read_result(file);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(ReadResult, RefusesWhatNoSolveWroteAndSaysWhy) {
  const TempFolder folder;
  write_sheet(folder / "a.vtp");
  const std::string whole = read_text(folder / "a.vtp");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
      text.replace(at, from.size(), to);
    EXPECT_NE(text, whole) << from;
    return fs::path(folder.write("b.vtp", text));
  };
  EXPECT_NE(refused(folder / "none.vtp").find("none.vtp"), std::string::npos);
  EXPECT_NE(refused(folder.write("t.vtp", "no picture")).find("t.vtp: is no VTK PolyData"), std::string::npos);
  EXPECT_NE(refused(folder.write("c.vtp", whole.substr(0, whole.size() / 2))).find("c.vtp: is damaged"),
            std::string::npos);
  EXPECT_NE(refused(changed("\"illuminance\"", "\"luminosity\"")).find("no array 'illuminance'"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
