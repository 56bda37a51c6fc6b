// Surfaces micrometres apart, sharp wedges and solids that run through each other: no light comes where none can.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "tests/support/csv_rows.h"
#include "tests/support/model_text.h"
#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

using test::ModelText;

struct Solved {
  ResultFile result;
  std::vector<double> sensors_lux;
  ProgramRun run;
};

Solved solve(const ModelText& model, const std::string& rest_of_scene, const std::string& sensors = {},
             const std::string& accuracy = "draft") {
  const TempFolder folder;
  folder.write("model.obj", model.text());
  const std::string scene =
      folder.write("scene.json", R"({"geometry": [{"file": "model.obj"}], )" + rest_of_scene + "}");
  std::vector<std::string> arguments{"solve", scene, "-o", folder / "out.vtp", "--quiet", "--accuracy", accuracy};
  if (!sensors.empty())
    for (const std::string& a : {std::string("--sensors"), folder.write("points.csv", sensors),
                                 std::string("--sensors-out"), folder / "o.csv"})
      arguments.push_back(a);
  Solved solved;
  solved.run = run_program(arguments);
  EXPECT_EQ(solved.run.exit_code, 0) << solved.run.err;
  if (solved.run.exit_code != 0) return solved;
  solved.result = read_result(folder / "out.vtp");
  if (!sensors.empty())
    for (const auto& row : test::csv_rows(folder / "o.csv"))
      solved.sensors_lux.push_back(std::stod(row.at("illuminance")));
  return solved;
}

/// A room of 4 x 4 x 3 times `scale`, with a panel of 1 x 1 at the given height, looking down.
ModelText room_with_panel(double scale, double height, const Vec3& offset = {}) {
  const auto at = [&](double x, double y, double z) { return Vec3{x * scale, y * scale, z} + offset; };
  ModelText model;
  model.object("room", "wall").box(offset, at(4, 4, 3 * scale), false);
  model.object("lamp", "lamp")
      .quad({at(1.5, 1.5, height), at(1.5, 2.5, height), at(2.5, 2.5, height), at(2.5, 1.5, height)});
  return model;
}

std::string lamp_of(double lumens) {
  return R"("materials": {"lamp": {"reflectance": 0.0, "luminous_flux": )" + std::to_string(lumens) +
         R"(}, "*": {"reflectance": 0.5}})";
}

double energy(const Solved& solved, const std::string& what) {
  return solved.result.numbers.at("energy." + what).values[0];
}

std::string point(const Vec3& p) {
  char line[120];
  std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,0,0,1\n", p.x, p.y, p.z);
  return line;
}

TEST(TightPlaces, APanelBelowACeilingLosesNothingFromAClosedRoomAtAnyGap) {
  // Joined with the ceiling all of its 1000 lm go down, else half of them end in the gap, between its black back and
  // the ceiling: 74.08 and 37.04 lx at this point, by radiosity on 1,280 patches of the room with a black square in its
  // ceiling, written for this (paths give 36.99 and 37.08 with a gap of 0.1 mm, +- 0.08). 1 % for the sampling.
  const double joined = 6e-7 * length(Vec3{4, 4, 3});  // the tolerance of meshing, 3.8 um
  for (const double gap : {0.0, 1e-6, 3e-6, 5e-6, 1e-4, 1e-3}) {
    SCOPED_TRACE(testing::Message() << "gap " << gap << " m");
    // The sensor looks for itself: coarse elements do, which bring it what walls reflect.
    const Solved solved = solve(room_with_panel(1, 3 - gap), lamp_of(1000) + R"(, "solver": {"max_element": 0.5})",
                                point({2, 2, 0.85}), "fine");
    ASSERT_EQ(solved.sensors_lux.size(), 1u);
    EXPECT_EQ(energy(solved, "escaped"), 0);
    EXPECT_NEAR(energy(solved, "emitted"), 1000 / kWhiteEfficacy, 1e-6);
    const double expected = gap < joined ? 74.08 : 37.04;
    EXPECT_NEAR(solved.sensors_lux[0], expected, 0.01 * expected);
  }
}

TEST(TightPlaces, APanelOutsideOfAWallLightsNothingInside) {
  struct Case {
    double scale, gap;
    Vec3 offset;
  };
  for (const Case& c : {Case{1, 1e-6, {}}, Case{1, 1e-5, {}}, Case{1, 1e-4, {}}, Case{0.2, 1e-6, {}},
                        Case{20, 1e-4, {}}, Case{2000, 5e-2, {}}, Case{1, 1e-5, {4e5, 5e6, 100}}}) {
    SCOPED_TRACE(testing::Message() << "scale " << c.scale << ", gap " << c.gap << " m, at " << c.offset.x);
    const Solved solved = solve(room_with_panel(c.scale, 3 * c.scale + c.gap, c.offset), lamp_of(1000),
                                point(Vec3{2, 2, 0.8} * c.scale + c.offset));
    ASSERT_EQ(solved.sensors_lux.size(), 1u);
    EXPECT_EQ(solved.sensors_lux[0], 0);
    const double ceiling = 3 * c.scale + c.offset.z;
    for (const auto& t : solved.result.triangles)  // the dark inside is left out
      for (const std::size_t v : t) EXPECT_GT(solved.result.points[v].z, ceiling - 1e-6 * c.scale);
  }
}

/// B = M / (1 - rho) = 200 in every cell that `counts`.
template <class Counts>
void expect_white(const ResultFile& result, const Counts& counts) {
  const auto& B = result.of_cells.at("radiosity").values;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < B.size(); ++i) {
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = result.points[result.triangles[i][k]];
    if (!counts(x)) continue;
    ++counted;
    EXPECT_NEAR(B[i], 200, 2) << "cell " << i << " at " << x[0].x << ", " << x[0].y << ", " << x[0].z;
  }
  EXPECT_GT(counted, 100u);
}

const char* const kFurnace = R"("materials": {"*": {"reflectance": 0.5, "exitance": 100, "sides": 1}})";

ModelText wedge(double degrees, bool closed) {
  const double rise = std::tan(degrees * std::numbers::pi / 180);
  ModelText model;
  model.object("w", "w");
  model.quad({Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  model.quad({Vec3{0, 0, 0}, {0, 1, 0}, {1, 1, rise}, {1, 0, rise}});
  if (!closed) return model;
  model.quad({Vec3{1, 0, 0}, {1, 0, rise}, {1, 1, rise}, {1, 1, 0}});
  model.quad({Vec3{0, 0, 0}, {0, 0, 0}, {1, 0, rise}, {1, 0, 0}});
  model.quad({Vec3{0, 1, 0}, {0, 1, 0}, {1, 1, 0}, {1, 1, rise}});
  return model;
}

TEST(TightPlaces, AClosedWedgeOfAnyAngleIsWhiteToItsEdge) {
  for (const double degrees : {0.01, 0.1, 1.0, 5.0}) {
    SCOPED_TRACE(testing::Message() << degrees << " degrees");
    const Solved solved = solve(wedge(degrees, true), kFurnace);
    expect_white(solved.result, [](const auto&) { return true; });
    // Within the tolerance of meshing of its edge (0.5 mm at 0.1 degrees) a wedge has no height, and no side.
    EXPECT_LE(energy(solved, "escaped"), degrees < 0.1 ? 1e-7 * energy(solved, "emitted") : 0);
  }
}

TEST(TightPlaces, NoPlaceOfAnOpenWedgeIsDarkerThanBlack) {
  for (const double degrees : {0.1, 1.0}) {
    const Solved solved =
        solve(wedge(degrees, false), std::string(R"("materials": {"*": {"reflectance": 0.5, "sides": 1}},
        "sky": {"model": "uniform", "horizontal_illuminance": 10000})"));
    for (const auto* arrays : {&solved.result.of_points, &solved.result.of_cells})
      for (const double E : arrays->at("irradiance").values) EXPECT_GE(E, 0) << degrees;
  }
}

TEST(TightPlaces, WhatIsSeenOfBoxesThatRunThroughEachOtherIsWhite) {
  struct Solid {
    Vec3 low, high;
  };
  std::vector<Solid> solids;
  RandomStream random(7, 0);
  ModelText model;
  model.object("room", "w").box({0, 0, 0}, {4, 3, 2.5}, false);
  for (int k = 0; k < 60; ++k) {
    const double size = 0.1 + 0.3 * random.uniform();
    const Vec3 low{0.5 + 2.5 * random.uniform(), 0.5 + 1.5 * random.uniform(), 0.5 + 1.2 * random.uniform()};
    solids.push_back({low, low + Vec3{size, size, size}});
    model.object("k" + std::to_string(k), "w").box(low, low + Vec3{size, size, size}, true);
  }
  const Solved solved = solve(model, kFurnace, {}, "standard");
  expect_white(solved.result, [&](const std::array<Vec3, 3>& x) {
    const Vec3 n = normalized(cross(x[1] - x[0], x[2] - x[0]));
    const Vec3 before = (x[0] + x[1] + x[2]) / 3 + n * 1e-6;
    return std::ranges::none_of(solids, [&](const Solid& s) {
      return before.x > s.low.x && before.x < s.high.x && before.y > s.low.y && before.y < s.high.y &&
             before.z > s.low.z && before.z < s.high.z;
    });
  });
}

TEST(TightPlaces, ASensorSeesTheSideOfATableThatItIsOn) {
  ModelText model;
  model.object("room", "black").box({0, 0, 0}, {4, 4, 3}, false);
  model.object("lamp", "lamp").quad({Vec3{0, 0, 2.9}, {0, 4, 2.9}, {4, 4, 2.9}, {4, 0, 2.9}});
  model.object("table", "black").quad({Vec3{1, 1, 0.8}, {3, 1, 0.8}, {3, 3, 0.8}, {1, 3, 0.8}});
  std::string sensors;
  const std::array<double, 6> heights{0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
  for (const double h : heights) sensors += point({2.3, 1.9, 0.8 + h});
  for (const double h : heights) sensors += h > 0 ? point({2.3, 1.9, 0.8 - h}) : std::string();
  const Solved solved = solve(
      model, R"("materials": {"lamp": {"reflectance": 0, "luminance": 100, "sides": 1}, "*": {"reflectance": 0}})",
      sensors);
  ASSERT_EQ(solved.sensors_lux.size(), 2 * heights.size() - 1);
  for (std::size_t k = 0; k < heights.size(); ++k)
    EXPECT_NEAR(solved.sensors_lux[k] / solved.sensors_lux[heights.size() - 1], 1, 0.01) << heights[k];
  EXPECT_GT(solved.sensors_lux[0], 100);
  for (std::size_t k = heights.size(); k < solved.sensors_lux.size(); ++k) EXPECT_EQ(solved.sensors_lux[k], 0);
}

TEST(Slits, UnderASlabThatOverhangsLetInWhatATracerSays) {
  // Walls of 4 x 4 m that end so far below a slab at 3 m; slab and floor go on for 0.5 m all round. Uniform sky of
  // 10,000 lx, black ground. Values in the middle of the room, beside the slit and low at a wall [lx]: a tracer of
  // lines in double, which starts at the slit; standard errors below 3, 3 and 10 %. At draft four
  // seeds of this program gave 0.7 to 2.1 times that, and once 3.5; this is the first seed.
  struct Case {
    double gap;
    std::array<double, 3> lux;
  };
  for (const Case& c :
       {Case{1e-4, {0.00354, 0.148, 0.00151}}, Case{1e-3, {0.0385, 1.58, 0.0191}}, Case{1e-2, {0.566, 22.4, 0.252}}}) {
    SCOPED_TRACE(testing::Message() << "gap " << c.gap << " m");
    const double top = 3 - c.gap;
    ModelText model;
    model.object("slabs", "wall")
        .quad({Vec3{-0.5, -0.5, 0}, {4.5, -0.5, 0}, {4.5, 4.5, 0}, {-0.5, 4.5, 0}})
        .quad({Vec3{-0.5, -0.5, 3}, {4.5, -0.5, 3}, {4.5, 4.5, 3}, {-0.5, 4.5, 3}});
    model.object("walls", "wall")
        .quad({Vec3{0, 0, 0}, {4, 0, 0}, {4, 0, top}, {0, 0, top}})
        .quad({Vec3{0, 4, 0}, {4, 4, 0}, {4, 4, top}, {0, 4, top}})
        .quad({Vec3{0, 0, 0}, {0, 4, 0}, {0, 4, top}, {0, 0, top}})
        .quad({Vec3{4, 0, 0}, {4, 4, 0}, {4, 4, top}, {4, 0, top}});
    const Solved solved = solve(model, R"("materials": {"*": {"reflectance": 0.5}},
                  "sky": {"model": "uniform", "horizontal_illuminance": 10000, "ground_reflectance": 0})",
                                point({2, 2, 0.85}) + point({0.02, 3.98, 2.98}) + point({3.98, 0.02, 1.5}));
    ASSERT_EQ(solved.sensors_lux.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_LT(solved.sensors_lux[k], 2.2 * c.lux[k]) << k;
      EXPECT_GT(solved.sensors_lux[k], 0.6 * c.lux[k]) << k;
    }
  }
}

}  // namespace
}  // namespace clerestory
