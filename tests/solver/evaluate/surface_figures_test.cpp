#include "solver/evaluate/surface_figures.h"

#include <gtest/gtest.h>

#include "tests/support/written_sheets.h"

namespace clerestory {
namespace {

TEST(SurfaceFigures, AreThoseOfTheLinearField) {
  // E = 100 x + 30 y over sheets of 1 m2: the mean of sheet i is 100 (i + 1/2) + 15, its ends are those of its corners.
  const auto rooms = figures_by_room(written_sheets(4, [](double x, double y) { return 100 * x + 30 * y; }));
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_EQ(rooms[1].name, "room 1");
  EXPECT_NEAR(rooms[1].lit.area, 2, 1e-12);
  EXPECT_NEAR(rooms[1].lit.mean, 315, 1e-9);
  EXPECT_EQ(rooms[1].lit.lowest, 200);
  EXPECT_EQ(rooms[1].lit.highest, 430);
  ASSERT_EQ(rooms[1].surfaces.size(), 2u);
  EXPECT_EQ(rooms[1].surfaces[1].surface, 3u);
  EXPECT_NEAR(rooms[1].surfaces[1].lit.mean, 365, 1e-9);
}

TEST(SurfaceFigures, ListTheLargestSurfaceFirst) {
  WrittenResult r = written_sheets(2, [](double, double) { return 1.0; });
  for (std::size_t i = 4; i < 8; ++i) r.points[i].y *= 3;
  const auto rooms = figures_by_room(r);
  EXPECT_EQ(rooms[0].surfaces[0].surface, 1u);
  EXPECT_NEAR(rooms[0].surfaces[0].lit.area, 3, 1e-12);
}

TEST(SurfaceFigures, OfAResultWithoutRoomsAreOfTheScene) {
  WrittenResult r = written_sheets(4, [](double x, double) { return x; });
  r.room.clear(), r.rooms.clear();
  const auto rooms = figures_by_room(r);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_EQ(rooms[0].name, "scene");
  EXPECT_NEAR(rooms[0].lit.mean, 2, 1e-6);
}

TEST(SurfaceFigures, LeaveOutTrianglesWithoutAreaAndKeepDarkRooms) {
  WrittenResult r = written_sheets(2, [](double x, double) { return x < 1.5 ? 0.0 : 50.0; });
  r.triangles[2] = r.triangles[3] = {4, 4, 4};
  const auto rooms = figures_by_room(r);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_EQ(rooms[0].surfaces.size(), 1u);
  EXPECT_EQ(rooms[0].lit.highest, 0);
  EXPECT_NEAR(rooms[0].lit.area, 1, 1e-12);
}

TEST(MaterialAreas, CountPanesToo) {
  WrittenResult r = written_sheets(3, [](double, double) { return 1.0; });
  r.materials.resize(2);
  r.around.panes = {{{Vec3{0, 0, 0}, {2, 0, 0}, {0, 3, 0}}, 1, 0}};
  const auto areas = areas_of_materials(r);
  EXPECT_NEAR(areas[0], 3, 1e-12);
  EXPECT_NEAR(areas[1], 3, 1e-12);
}

}  // namespace
}  // namespace clerestory
