// Rooms and the error of each, from scenes that a user would write.

#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "io/read_scene.h"
#include "pipeline/solve_scene.h"
#include "solver/model/units.h"
#include "tests/support/temp_folder.h"

namespace clerestory {
namespace {

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(CLERESTORY_SOURCE_DIR) / "data" / "scenes" / name;
}

Solved solve_draft(const std::filesystem::path& file) {
  return solve_scene(read_scene(file), {.solve = {.accuracy = Accuracy::draft}});
}

const ErrorOfPart& part_named(const MeasuredError& error, const std::string& name) {
  const auto found = std::ranges::find(error.parts, name, &ErrorOfPart::name);
  if (found == error.parts.end()) throw std::out_of_range(name);
  return *found;
}

/// Two rooms of 4 x 5 x 2.6 m with a door of 0.9 x 2 m between them, a lamp in each; walls as sheets.
std::string two_rooms_with_a_door() {
  return R"(
v 0 0 0
v 8 0 0
v 8 5 0
v 0 5 0
v 0 0 2.6
v 8 0 2.6
v 8 5 2.6
v 0 5 2.6
v 4 0 0
v 4 2 0
v 4 2 2
v 4 2.9 2
v 4 2.9 0
v 4 5 0
v 4 5 2.6
v 4 0 2.6
o floor
f 1 2 3 4
o ceiling
f 5 8 7 6
o south
f 1 5 6 2
o north
f 3 7 8 4
o west
f 1 4 8 5
o east
f 2 6 7 3
o partition
f 9 10 11 12 13 14 15 16
)";
}

struct TwoRooms {
  TempFolder folder;
  std::filesystem::path scene(const std::string& more = "") const {
    std::ofstream(folder / "rooms.obj") << two_rooms_with_a_door();
    std::ofstream(folder / "rooms.json")
        << R"({ "geometry": [{ "file": "rooms.obj" }], "materials": { "*": { "reflectance": 0.5 } },
      "luminaires": [ { "type": "point", "position": [2, 2.5, 2.3], "luminous_flux": 3000 },
                      { "type": "point", "position": [6, 2.5, 2.3], "luminous_flux": 300 } ])"
        << more << " }";
    return folder / "rooms.json";
  }
};

TEST(Rooms, AreAmongOthersTheOutdoorsBehindGlass) {
  const Solved office = solve_draft(shipped("office.json"));
  ASSERT_EQ(office.patches.rooms, (std::vector<std::string>{"outdoors", "room 1"}));
  // Inside, by its drawing: 4 x 6 x 2.8 m with a window, a door, desks and a cabinet; the reveal before the pane is
  // not.
  ASSERT_TRUE(office.error);
  const ErrorOfPart &out = office.error->parts[0], &in = office.error->parts[1];
  EXPECT_NEAR(in.area, 112.6, 1);
  EXPECT_NEAR(out.area + in.area, office.patches.total_area(), 1e-6);
  EXPECT_NEAR(in.mean_illuminance, 204, 12);
  EXPECT_GT(out.mean_illuminance, 4000);
  // Errors are those of the room and not of the facade, which is far brighter.
  EXPECT_GT(in.figures.upper(), 4 * out.figures.rms_relative);
  EXPECT_LT(in.figures.p95_relative, 0.5);
  EXPECT_EQ(office.error->worst(), &in);
}

TEST(Rooms, OfAHouseArePartedAtOpenDoors) {
  const Solved house = solve_draft(shipped("house.json"));
  EXPECT_EQ(house.patches.rooms.size(), 8u) << "seven rooms on two floors, and the outdoors";
  EXPECT_EQ(house.patches.rooms[0], "outdoors");
  for (std::size_t k = 2; k < house.error->parts.size(); ++k)
    EXPECT_LE(house.error->parts[k].area, house.error->parts[k - 1].area);
}

TEST(Rooms, AreToldByTheMajorityOfWhatTheySee) {
  const TwoRooms two;
  const Solved solved = solve_draft(two.scene());
  ASSERT_EQ(solved.patches.rooms.size(), 2u);
  for (std::size_t i = 0; i < solved.patches.patch_count(); ++i) {
    const auto c = solved.patches.corner_positions(PatchId{i});
    const Vec3 middle = (c[0] + c[1] + c[2]) / 3 + solved.patches.origin + solved.patches.normal[i] * 0.01;
    const auto first = solved.patches.corner_positions(PatchId{0});
    const double x = ((first[0] + first[1] + first[2]) / 3 + solved.patches.origin).x;
    if (std::abs(middle.x - 4) < 0.5 || std::abs(x - 4) < 0.5) continue;  // beside the door, either is right
    EXPECT_EQ(solved.patches.room[i] == solved.patches.room[0], (middle.x < 4) == (x < 4)) << middle.x;
  }
  const double bright = std::max(solved.error->parts[0].mean_illuminance, solved.error->parts[1].mean_illuminance);
  const double dim = std::min(solved.error->parts[0].mean_illuminance, solved.error->parts[1].mean_illuminance);
  EXPECT_GT(bright, 5 * dim);
}

TEST(Rooms, HaveTheNamesThatTheSceneGivesThem) {
  const TwoRooms two;
  const Solved solved = solve_draft(two.scene(R"(, "rooms": [{ "name": "studio", "surfaces": ["west"] },
                                                             { "name": "store", "surfaces": ["e?st"] }])"));
  ASSERT_EQ(solved.patches.rooms.size(), 2u);
  ASSERT_TRUE(solved.error);
  const ErrorOfPart &studio = part_named(*solved.error, "studio"), &store = part_named(*solved.error, "store");
  EXPECT_GT(studio.mean_illuminance, 5 * store.mean_illuminance);
  EXPECT_NEAR(studio.area, store.area, 6);
}

TEST(Rooms, NamedBySheetsEndAtTheirInnerSides) {
  // A box of sheets, 4 x 5 x 2.6 m, whose front is open: the sky lights both sides of each.
  const TempFolder folder;
  std::ofstream(folder / "box.obj") << R"(
v 0 0 0
v 4 0 0
v 4 5 0
v 0 5 0
v 0 0 2.6
v 4 0 2.6
v 4 5 2.6
v 0 5 2.6
o floor
f 1 2 3 4
o roof
f 5 8 7 6
o back
f 3 7 8 4
o west
f 1 4 8 5
o east
f 2 6 7 3
)";
  std::ofstream(folder / "box.json") << R"({ "geometry": [{ "file": "box.obj" }], "sky": { "model": "uniform" },
    "rooms": [{ "name": "R", "surfaces": ["*"] }] })";
  const Solved solved = solve_draft(folder / "box.json");
  ASSERT_TRUE(solved.error);
  EXPECT_NEAR(part_named(*solved.error, "R").area, 2 * 4 * 5 + 4 * 2.6 + 2 * 5 * 2.6, 0.1);
}

TEST(Rooms, HaveTheNamesOfVolumes) {
  const TwoRooms two;
  Scene scene = read_scene(two.scene());
  NamedSpace space{"A1", "", {}, {}};
  for (int c = 0; c < 8; ++c) space.vertices.push_back({c & 1 ? 4.0 : 0.0, c & 2 ? 5.0 : 0.0, c & 4 ? 2.6 : 0.0});
  for (const auto& [a, b, c, d] : {std::array{0u, 2u, 3u, 1u},
                                   {4u, 5u, 7u, 6u},
                                   {0u, 1u, 5u, 4u},
                                   {2u, 6u, 7u, 3u},
                                   {0u, 4u, 6u, 2u},
                                   {1u, 3u, 7u, 5u}})
    for (const std::uint32_t corner : {a, b, c, a, c, d}) space.corner.push_back(corner);
  scene.spaces.push_back(space);
  const Solved solved = solve_scene(scene, {.solve = {.accuracy = Accuracy::draft}});
  ASSERT_EQ(solved.patches.rooms.size(), 2u);
  EXPECT_NEAR(part_named(*solved.error, "A1").area, 2 * (4 * 5 + 4 * 2.6 + 5 * 2.6) - 1.8, 0.5);
}

/// Axis-parallel box as OBJ, its first vertex `first`; corner k has the bits x, y, z.
std::string box_obj(const std::string& name, const Vec3& low, const Vec3& high, int first) {
  std::ostringstream out;
  for (int c = 0; c < 8; ++c)
    out << "v " << (c & 1 ? high.x : low.x) << ' ' << (c & 2 ? high.y : low.y) << ' ' << (c & 4 ? high.z : low.z)
        << '\n';
  out << "o " << name << '\n';
  for (const auto& face :
       {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    out << 'f';
    for (const int corner : face) out << ' ' << first + corner;
    out << '\n';
  }
  return out.str();
}

TEST(Rooms, AreResolvedInALargeBuildingAsTheyWouldBeAlone) {
  const TempFolder folder;
  const std::string cell = box_obj("cell", {10, 10, 1}, {14, 13, 3.5}, 1),
                    table = box_obj("table", {11, 11, 1.4}, {13, 12, 1.7}, 9);
  std::ofstream(folder / "alone.obj") << cell << table;
  std::ofstream(folder / "hall.obj") << cell << table << box_obj("hall", {0, 0, 0}, {90, 80, 20}, 17);
  const auto solve = [&](const std::string& model) {
    std::ofstream(folder / "s.json") << R"({ "geometry": [{ "file": ")" << model << R"(" }],
      "materials": { "*": { "reflectance": 0.6 } }, "rooms": [{ "name": "cell", "surfaces": ["table"] }],
      "luminaires": [ { "type": "point", "position": [12, 11.5, 3.3], "luminous_flux": 1000 },
                      { "type": "point", "position": [50, 50, 10], "luminous_flux": 1e5 } ] })";
    Settings settings{.solve = {.accuracy = Accuracy::standard}};
    settings.error_samples = 4096;  // some eighty of them in the cell
    return solve_scene(read_scene(folder / "s.json"), settings);
  };
  const auto elements_in_cell = [](const Solved& s) {
    const auto cell_number =
        static_cast<std::uint32_t>(std::ranges::find(s.patches.rooms, "cell") - s.patches.rooms.begin());
    return static_cast<double>(std::ranges::count(s.patches.room, cell_number));
  };
  const Solved alone = solve("alone.obj"), in_hall = solve("hall.obj");
  ASSERT_EQ(in_hall.patches.rooms.size(), 2u) << "the hall is 300 times as large";
  EXPECT_GT(elements_in_cell(alone), 3000);
  EXPECT_GT(elements_in_cell(in_hall), elements_in_cell(alone) / 2);
  const ErrorFigures there = part_named(*in_hall.error, "cell").figures,
                     here = part_named(*alone.error, "cell").figures;
  std::printf("cell: rms %.3f median %.4f p95 %.3f alone, %.3f %.4f %.3f in the hall; elements %.0f, %.0f\n",
              here.rms_relative, here.median_relative, here.p95_relative, there.rms_relative, there.median_relative,
              there.p95_relative, elements_in_cell(alone), elements_in_cell(in_hall));
  EXPECT_LT(there.median_relative, 0.03);
}

TEST(Rooms, OfASceneFileAreCheckedLikeAllElse) {
  const TwoRooms two;
  const auto refusal = [&](const std::string& rooms) -> std::string {
    try {
      read_scene(two.scene(", \"rooms\": " + rooms));
    } catch (const std::exception& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{}").find("rooms"), std::string::npos);
  EXPECT_NE(refusal(R"([{ "surfaces": ["west"] }])").find("has no \"name\""), std::string::npos);
  EXPECT_NE(refusal(R"([{ "name": "A" }])").find("has no \"surfaces\""), std::string::npos);
  EXPECT_NE(refusal(R"([{ "name": "A", "surfaces": [3] }])").find("text"), std::string::npos);
  EXPECT_NE(refusal(R"([{ "name": "A", "surface": ["x"] }])").find("surfaces"), std::string::npos) << "nearest key";
  const Scene scene = read_scene(two.scene(R"(, "rooms": [{ "name": "A", "surfaces": ["nowhere"] }])"));
  EXPECT_TRUE(std::ranges::any_of(scene.warnings, [](const std::string& w) { return w.find("nowhere") != w.npos; }));
}

}  // namespace
}  // namespace clerestory
