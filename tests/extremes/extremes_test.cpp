// The ends of what is allowed: reflectances, sizes, brightness, distances, broken faces, scales and places. Each test
// prints what it measured: the rows of README.md.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/model/random_stream.h"
#include "solver/model/units.h"
#include "tests/extremes/extreme_scene.h"

namespace clerestory {
namespace {

using test::expect_sound;
using test::ModelText;
using test::Outcome;
using test::Quad;
using test::solve_extreme;

constexpr const char* kFurnace = R"("materials": {"*": {"reflectance": 0.5, "exitance": 100, "sides": 1}})";
constexpr double kWhite = 200;  // of it, 100 / (1 - 0.5) [W/m2]

void row(const char* what, double measured, const char* unit) {
  std::printf("| %s | %.3g %s |\n", what, measured, unit);
}

std::string sensor(const Vec3& p, const Vec3& n) {
  char line[200];
  std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", p.x, p.y, p.z, n.x, n.y, n.z);
  return line;
}

Quad flat(double x, double y, double z, double width, double depth) {
  return {Vec3{x, y, z}, {x + width, y, z}, {x + width, y + depth, z}, {x, y + depth, z}};
}
Quad turned_over(const Quad& q) { return {q[0], q[3], q[2], q[1]}; }

/// Largest deviation of any cell of a closed furnace [1].
double off_white(const Outcome& outcome) {
  double worst = 0;
  for (const double E : outcome.result.of_cells.at("irradiance").values)
    worst = std::max(worst, std::abs(E / kWhite - 1));
  return worst;
}

// one room, moved
struct Face {
  std::string surface, material;
  Quad corners;
};

/// A room of 4 x 3 x 2.5 m with a table and a glowing panel, alike left and right of x = 2.
std::vector<Face> room_with_table() {
  const auto box = [](std::vector<Face>& faces, const std::vector<std::string>& names, const Vec3& a, const Vec3& b,
                      bool inwards) {
    const Quad sides[] = {{Vec3{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}},
                          {Vec3{a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z}},
                          {Vec3{a.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, b.y, b.z}, {a.x, a.y, b.z}},
                          {Vec3{b.x, a.y, a.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}},
                          {Vec3{a.x, a.y, a.z}, {a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, a.y, a.z}},
                          {Vec3{a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}}};
    for (std::size_t k = 0; k < 6; ++k)
      faces.push_back({names[k % names.size()], "plain", inwards ? sides[k] : turned_over(sides[k])});
  };
  std::vector<Face> faces;
  box(faces, {"floor", "ceiling", "west", "east", "south", "north"}, {0, 0, 0}, {4, 3, 2.5}, true);
  box(faces, {"table"}, {1.25, 1, 0.7}, {2.75, 2, 0.75}, false);
  faces.push_back({"panel", "panel", turned_over(flat(1.5, 1, 2.3, 1, 1))});
  return faces;
}
constexpr const char* kOfRoom =
    R"("materials": {"plain": {"reflectance": 0.5, "sides": 1}, "panel": {"reflectance": 0.1, "exitance": 500, "sides": 1}})";

std::string as_obj(const std::vector<Face>& faces, const std::function<Vec3(const Vec3&)>& move) {
  ModelText model;
  for (const Face& f : faces)
    model.object(f.surface, f.material)
        .quad({move(f.corners[0]), move(f.corners[1]), move(f.corners[2]), move(f.corners[3])});
  return model.text();
}
Vec3 as_it_is(const Vec3& p) { return p; }

/// Largest difference of the means of a surface, to the largest of these means [1].
double difference(const Outcome& a, const Outcome& b) {
  const auto of_a = a.by_surface(), of_b = b.by_surface();
  EXPECT_EQ(of_a.size(), of_b.size());
  double most = 0, worst = 0;
  for (const auto& [name, mean] : of_a) most = std::max(most, mean.E);
  for (const auto& [name, mean] : of_a) worst = std::max(worst, std::abs(mean.E - of_b.at(name).E) / most);
  return worst;
}

/// What draft says of means of rooms (solver/run/check_laws.cpp), and so of surfaces of a room.
constexpr double kOfDraft = 0.02;

class MovedRoom : public testing::Test {
 protected:
  static Outcome solve(const std::vector<Face>& faces, const std::function<Vec3(const Vec3&)>& move = as_it_is,
                       std::vector<std::string> options = {}) {
    const Outcome outcome = solve_extreme(as_obj(faces, move), kOfRoom, options);
    expect_sound(outcome);
    return outcome;
  }
  std::vector<Face> faces_ = room_with_table();
};

TEST_F(MovedRoom, IsTheSameAtScalesFromAMillionthToAMillion) {
  const Outcome here = solve(faces_);
  double worst = 0;
  for (const double scale : {1e-6, 1e-3, 1e3, 1e6}) {
    SCOPED_TRACE(scale);
    worst = std::max(worst, difference(here, solve(faces_, [&](const Vec3& p) { return p * scale; })));
  }
  EXPECT_LT(worst, kOfDraft);
  row("scale 1e-6 to 1e6, means of surfaces differ by", 100 * worst, "%");
}

TEST_F(MovedRoom, IsTheSameTenThousandKilometresOffTheOrigin) {
  const double off = difference(solve(faces_), solve(faces_, [](const Vec3& p) { return p + Vec3{1e7, -1e7, 1e7}; }));
  EXPECT_LT(off, kOfDraft);
  row("1e7 m off the origin, means of surfaces differ by", 100 * off, "%");
}

TEST_F(MovedRoom, IsTheSameHoweverItIsTurned) {
  const double a = 0.7, b = 1.1;
  const auto turn = [&](const Vec3& p) {
    const Vec3 q{p.x * std::cos(a) - p.y * std::sin(a), p.x * std::sin(a) + p.y * std::cos(a), p.z};
    return Vec3{q.x, q.y * std::cos(b) - q.z * std::sin(b), q.y * std::sin(b) + q.z * std::cos(b)};
  };
  const double off = difference(solve(faces_), solve(faces_, turn));
  EXPECT_LT(off, kOfDraft);
  row("turned about two axes, means of surfaces differ by", 100 * off, "%");
}

TEST_F(MovedRoom, IsTheSameInAnyOrderOfItsFacesAndTheirCorners) {
  const Outcome before = solve(faces_);
  RandomStream random(3, 0);
  for (std::size_t k = faces_.size(); k > 1; --k)
    std::swap(faces_[k - 1], faces_[static_cast<std::size_t>(random.uniform() * static_cast<double>(k))]);
  for (Face& f : faces_)
    std::ranges::rotate(f.corners, f.corners.begin() + 1 + static_cast<long>(random.uniform() * 3));
  const double off = difference(before, solve(faces_));
  EXPECT_LT(off, kOfDraft);
  row("faces and corners in another order, means of surfaces differ by", 100 * off, "%");
}

TEST_F(MovedRoom, IsAlikeLeftAndRightWhereItsModelIs) {
  for (const char* method : {"hierarchical", "progressive", "gauss-seidel"}) {
    const auto means = solve(faces_, as_it_is, {"--method", method, "--max-element", "0.7"}).by_surface();
    const double off = std::abs(means.at("west").E / means.at("east").E - 1);
    EXPECT_LT(off, kOfDraft) << method;
    row((std::string("mirror symmetry, ") + method + ", walls differ by").c_str(), 100 * off, "%");
  }
}

TEST_F(MovedRoom, HasOneLimitForAllMethods) {
  const auto paths = solve(faces_, as_it_is, {"--method", "path", "--max-element", "0.7"}).by_surface();
  for (const char* method : {"hierarchical", "progressive", "gauss-seidel", "jacobi"}) {
    SCOPED_TRACE(method);
    double most = 0, worst = 0;
    for (const auto& [name, mean] : paths) most = std::max(most, mean.E);
    for (const auto& [name, mean] :
         solve(faces_, as_it_is, {"--method", method, "--max-element", "0.7"}).by_surface()) {
      const double off = std::abs(mean.E - paths.at(name).E);
      EXPECT_LT(off, kOfDraft * most + 4 * paths.at(name).std_error) << name;
      worst = std::max(worst, off / most);
    }
    row((std::string("against path, ") + method + ", means of surfaces differ by").c_str(), 100 * worst, "%");
  }
}

// sizes and brightness
TEST(Extremes, AReflectanceOfOneIsRefusedAndSaysWhy) {
  ModelText model;
  model.object("room", "wall").box({0, 0, 0}, {4, 3, 2.5}, false);
  const Outcome outcome = solve_extreme(model.text(), R"("materials": {"wall": {"reflectance": 1, "exitance": 1}})");
  EXPECT_EQ(outcome.run.exit_code, 3);
  EXPECT_NE(outcome.run.err.find("reflectance = 1 is outside [0, 1); a wall cannot reflect more than it receives"),
            std::string::npos)
      << outcome.run.err;
}

TEST(Extremes, ThingsAMillionTimesSmallerThanTheirRoomAreAsWhiteAsIt) {
  // A cube of 0.1 mm stands free in a hall of 100 m. Its edges are a fortieth of the meshing tolerance's reach above
  // it.
  ModelText model;
  model.object("hall", "w").box({0, 0, 0}, {100, 100, 100}, false);
  model.object("cube", "w").box({40, 50, 30}, {40.0001, 50.0001, 30.0001}, true);
  for (const char* method : {"hierarchical", "progressive"}) {
    SCOPED_TRACE(method);
    const Outcome outcome = solve_extreme(model.text(), kFurnace, {"--method", method});
    expect_sound(outcome);
    const auto means = outcome.by_surface();
    ASSERT_TRUE(means.contains("cube")) << "nothing is left out for its size";
    EXPECT_LT(off_white(outcome), 0.01);
    row((std::string("sizes 1 : 1e6, ") + method + ", furnace off white by").c_str(), 100 * off_white(outcome), "%");
  }
}

TEST(Extremes, RoomsOfExitances1ToATrillionAreEachRight) {
  ModelText model;
  model.object("bright", "bright").box({0, 0, 0}, {4, 3, 2.5}, false);
  model.object("dim", "dim").box({5, 0, 0}, {9, 3, 2.5}, false);
  for (const char* method : {"hierarchical", "progressive", "gauss-seidel"}) {
    const Outcome outcome = solve_extreme(model.text(),
                                          R"("materials": {"bright": {"reflectance": 0.5, "exitance": 1e9, "sides": 1},
        "dim": {"reflectance": 0.5, "exitance": 1e-3, "sides": 1}})",
                                          {"--method", method, "--max-element", "1.2"});
    expect_sound(outcome);
    const auto means = outcome.by_surface();
    EXPECT_NEAR(means.at("bright").E / 2e9, 1, 1e-3) << method;
    EXPECT_NEAR(means.at("dim").E / 2e-3, 1, 1e-3) << method;
    row((std::string("exitances 1 : 1e12 side by side, ") + method + ", the dim room is off by").c_str(),
        100 * std::abs(means.at("dim").E / 2e-3 - 1), "%");
  }
}

TEST(Extremes, AClosedRoomOfOneReflectanceHasItsExactMeanUpToFourNines) {
  // flux / (A (1 - rho)), though the light comes from a panel only; its black back is part of the room.
  double worst = 0;
  for (const double rho : {0.0, 0.5, 0.99, 0.9999}) {
    ModelText model;
    model.object("room", "wall").box({0, 0, 0}, {4, 3, 2.5}, false);
    model.object("panel", "panel").quad(turned_over(flat(1.5, 1, 2.5, 1, 1)));
    const std::string r = std::to_string(rho);
    const Outcome outcome = solve_extreme(
        model.text(), R"("materials": {"panel": {"reflectance": )" + r +
                          R"(, "exitance": 500, "sides": 1}, "wall": {"reflectance": )" + r + R"(, "sides": 1}})");
    expect_sound(outcome);
    double flux = 0, area = 0;
    const auto &E = outcome.result.of_cells.at("irradiance").values, &A = outcome.result.of_cells.at("area").values;
    for (std::size_t i = 0; i < E.size(); ++i) flux += A[i] * E[i], area += A[i];
    const double exact = 500 / (2 * (12 + 10 + 7.5) * (1 - rho));
    EXPECT_NEAR(area, 59, 1e-6);
    EXPECT_NEAR(flux / area / exact, 1, rho > 0.99 ? 1e-2 : 2e-3) << rho;  // the bars of tests/laws
    worst = std::max(worst, std::abs(flux / area / exact - 1));
  }
  row("reflectance 0 to 0.9999, mean of a closed room off by", 100 * worst, "%");
}

// lights
std::string lamp_at(double height) {
  char rest[300];
  std::snprintf(rest, sizeof rest, R"("materials": {"black": {"reflectance": 0, "sides": 1}},
        "luminaires": [{"type": "point", "position": [0, 0, %.17g], "luminous_flux": 1000}])",
                height);
  return rest;
}
double intensity_over_square(double d) { return 1000 / (4 * std::numbers::pi * d * d); }

TEST(Extremes, ALampLightsAWallByItsSolidAngleFromAMicrometreToAKilometre) {
  ModelText model;
  model.object("wall", "black").quad(flat(-5, -5, 0, 10, 10));
  double worst = 0, worst_foot = 0;
  for (const double d : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1.0, 30.0, 1e3}) {
    SCOPED_TRACE(d);
    const Outcome outcome = solve_extreme(model.text(), lamp_at(d), {}, sensor({0, 0, 0}, {0, 0, 1}));
    expect_sound(outcome);
    // The square takes this share of the flux: solid angle of a square of 10 m over its middle.
    const double h = 5 / d, share = std::atan(h * h / std::sqrt(1 + 2 * h * h)) / std::numbers::pi;
    const double off = std::abs(outcome.figure("energy.absorbed") * kWhiteEfficacy / 1000 / share - 1);
    EXPECT_LT(off, 0.01);
    worst = std::max(worst, off);
    if (d < 1e-3) continue;
    // Sensors on a surface stand off it by RayScene::lift(), 5e-7 of the diagonal, and are nearer to the lamp by that.
    ASSERT_EQ(outcome.sensors_lux.size(), 1u);
    const double lift = 5e-7 * std::sqrt(200), foot = std::abs(outcome.sensors_lux[0] / intensity_over_square(d) - 1);
    EXPECT_LT(foot, 2.1 * lift / d + 1e-6);
    worst_foot = std::max(worst_foot, foot);
  }
  row("lamp 1 um to 1 km before a wall, flux off by", 100 * worst, "%");
  row("lamp 1 mm to 1 km before a wall, foot of its perpendicular off by", 100 * worst_foot, "%");
}

TEST(Extremes, ALampLightsASensorInTheAirByTheInverseSquareFromAMicrometreToAKilometre) {
  ModelText model;
  model.object("wall", "black").quad(flat(-5, -5, 0, 10, 10));
  double worst = 0;
  for (const double d : {1e-6, 1e-4, 1e-2, 1.0, 1e3}) {
    SCOPED_TRACE(d);
    const Outcome outcome = solve_extreme(model.text(), lamp_at(2 + d), {}, sensor({0, 0, 2}, {0, 0, 1}));
    expect_sound(outcome);
    ASSERT_EQ(outcome.sensors_lux.size(), 1u);
    // Where the lamp stands is known to 2e-16 of its height.
    const double off = std::abs(outcome.sensors_lux[0] / intensity_over_square((2 + d) - 2) - 1);
    EXPECT_LT(off, 1e-9);
    worst = std::max(worst, off);
  }
  row("lamp 1 um to 1 km from a sensor in the air, off by", 100 * worst, "%");
}

TEST(Extremes, AMirrorThatHangsOnAWallKeepsTheLightOfTheRoom) {
  // In the gap behind it most of what a patch sees is itself, over the mirror: from 1 cm down the balance used to
  // diverge.
  for (const double gap : {0.02, 0.01, 0.002}) {
    SCOPED_TRACE(testing::Message() << "gap " << gap << " m");
    ModelText model;
    const double x = 5 - gap;
    model.object("room", "wall").box({0, 0, 0}, {5, 4, 3}, false);
    model.object("mirror", "mirror").quad({Vec3{x, 0.5, 0.5}, {x, 0.5, 2.5}, {x, 3.5, 2.5}, {x, 3.5, 0.5}});
    const Outcome out = solve_extreme(
        model.text(), R"("materials": {"wall": {"reflectance": 0.8}, "mirror": {"type": "mirror", "reflectance": 0.9}},
                         "luminaires": [{"type": "point", "position": [2.5, 2, 2.5], "luminous_flux": 3000}])",
        // Elements of half a metre know the light of the gap, which falls from its rim on, to 10 to 20 %, and the check
        // says so.
        {"--max-element", "0.2"});
    ASSERT_EQ(out.run.exit_code, 0) << out.run.err;
    EXPECT_LT(std::abs(out.figure("energy.imbalance")), 0.01);
    EXPECT_LT(out.figure("iterations"), 100);
  }
}

TEST(Extremes, AThousandLampsAddUp) {
  ModelText model;
  model.object("floor", "black").quad(flat(0, 0, 0, 100, 100));
  RandomStream random(5, 0);
  std::vector<Vec3> lamps;
  std::string rest = R"("materials": {"black": {"reflectance": 0, "sides": 1}}, "luminaires": [)";
  for (int k = 0; k < 1000; ++k) {
    lamps.push_back({100 * random.uniform(), 100 * random.uniform(), 2 + 2 * random.uniform()});
    char lamp[200];
    std::snprintf(lamp, sizeof lamp, R"(%s{"type": "point", "position": [%.17g, %.17g, %.17g], "luminous_flux": 500})",
                  k ? "," : "", lamps.back().x, lamps.back().y, lamps.back().z);
    rest += lamp;
  }
  std::string sensors;
  std::vector<double> exact;
  for (int k = 0; k < 20; ++k) {
    const Vec3 p{5 + 90 * random.uniform(), 5 + 90 * random.uniform(), 0.5};
    sensors += sensor(p, {0, 0, 1});
    exact.push_back(0);
    for (const Vec3& lamp : lamps) {
      const Vec3 d = lamp - p;
      exact.back() += 500 / (4 * std::numbers::pi) * d.z / std::pow(dot(d, d), 1.5);
    }
  }
  const Outcome outcome = solve_extreme(model.text(), rest + "]", {}, sensors);
  expect_sound(outcome);
  ASSERT_EQ(outcome.sensors_lux.size(), exact.size());
  double worst = 0;
  for (std::size_t k = 0; k < exact.size(); ++k)
    worst = std::max(worst, std::abs(outcome.sensors_lux[k] / exact[k] - 1));
  EXPECT_LT(worst, 1e-4);  // nothing is random where nothing blocks
  row("1,000 lamps over a floor, sensors off by", 100 * worst, "%");
}

TEST(Extremes, TheSunATenthOfADegreeUpLightsAFloorByTheVisibleShareOfItsDisc) {
  // The disc's lower part is below the floor: mean over the disc of max(0, sin(elevation)).
  constexpr double kNormal = 80'000, kElevation = 0.1 * std::numbers::pi / 180,
                   kRadius = 0.533 / 2 * std::numbers::pi / 180;
  double share = 0;
  constexpr int kSteps = 100'000;
  for (int k = 0; k < kSteps; ++k) {
    const double y = kRadius * (2 * (k + 0.5) / kSteps - 1), width = 2 * std::sqrt(kRadius * kRadius - y * y);
    share += std::max(0.0, std::sin(kElevation + y)) * width * (2 * kRadius / kSteps);
  }
  share /= std::numbers::pi * kRadius * kRadius;
  ModelText model;
  model.object("floor", "black").quad(flat(-50, -5, 0, 55, 10));
  model.object("wall", "black").quad({Vec3{5, -5, 0}, {5, -5, 1}, {5, 5, 1}, {5, 5, 0}});  // faces -x, where the sun is
  char rest[300];
  std::snprintf(rest, sizeof rest, R"("materials": {"black": {"reflectance": 0, "sides": 1}},
      "sun": {"direction": [%.17g, 0, %.17g], "normal_illuminance": %g})",
                -std::cos(kElevation), std::sin(kElevation), kNormal);
  const std::string places = sensor({0, 0, 0.001}, {0, 0, 1}) + sensor({4.999, 0, 0.8}, {-1, 0, 0});
  const Outcome outcome = solve_extreme(model.text(), rest, {"--accuracy", "fine"}, places);
  expect_sound(outcome);
  ASSERT_EQ(outcome.sensors_lux.size(), 2u);
  const double off = std::abs(outcome.sensors_lux[0] / (kNormal * share) - 1);
  // 64 points of the disc, of which 27 % give nothing: the others scatter by 80 % of their mean, which 8 x 8 strata
  // bring down to a few per cent.
  EXPECT_LT(off, 0.05);
  EXPECT_NEAR(outcome.sensors_lux[1] / (kNormal * std::cos(kElevation)), 1, 1e-4) << "all of the disc, square on";
  row("sun at 0.1 degree, floor off by", 100 * off, "%");
  row("sun at 0.1 degree, wall that faces it off by",
      100 * std::abs(outcome.sensors_lux[1] / (kNormal * std::cos(kElevation)) - 1), "%");
}

// broken faces
struct Broken {
  std::string name;
  double area;  ///< that they add to both sides together, each place once [m2]
  std::vector<Quad> faces;
  friend void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }
};

class BrokenFaces : public testing::TestWithParam<Broken> {};

TEST_P(BrokenFaces, InAFurnaceLeaveItWhite) {
  // Every face acts on both sides, so that what is wound the wrong way round shines as well. The outside of the shell
  // gets no light and is left out.
  ModelText model;
  model.object("shell", "w").box({-1, -1, -1}, {5, 4, 3.5}, false);
  model.object("room", "w").box({0, 0, 0}, {4, 3, 2.5}, false);
  model.object("broken", "w");
  for (const Quad& q : GetParam().faces) model.quad(q);
  const std::string both = R"("materials": {"*": {"reflectance": 0.5, "exitance": 100, "sides": 2}})";
  const Outcome outcome = solve_extreme(model.text(), both);
  expect_sound(outcome);
  const double worst = off_white(outcome);
  EXPECT_LT(worst, 0.01);
  // The shell's inside, both sides of the room, and what the faces add to that.
  const double area = 2 * (6 * 5 + 6 * 4.5 + 5 * 4.5) + 2 * 59 + GetParam().area;
  EXPECT_NEAR(outcome.figure("energy.emitted") / 100, area, 1e-4) << "no place shines twice, and none is lost";
  row((GetParam().name + ", furnace off white by").c_str(), 100 * worst, "%");
}

INSTANTIATE_TEST_SUITE_P(
    Extremes, BrokenFaces,
    testing::Values(Broken{"coincident", 0,
                           std::vector<Quad>{flat(0, 0, 0, 4, 3), flat(0, 0, 0, 4, 3),
                                             turned_over(flat(0, 0, 0, 4, 3))}},
                    Broken{"overlapping", 2 * 3.46,
                           std::vector<Quad>{flat(0.5, 0.5, 1, 2, 1), flat(1, 1, 1, 2, 1), flat(1.5, 0.7, 1, 0.3, 2)}},
                    Broken{"self-crossing", 2, std::vector<Quad>{{Vec3{1, 1, 1}, {3, 2, 1}, {3, 1, 1}, {1, 2, 1}}}},
                    Broken{"crossing", 8,
                           std::vector<Quad>{flat(1, 1, 1, 2, 1),
                                             {Vec3{2, 0.5, 0.5}, {2, 2.5, 0.5}, {2, 2.5, 1.5}, {2, 0.5, 1.5}}}},
                    Broken{"sliver", 0, std::vector<Quad>{flat(0.5, 1, 1, 3, 3e-6), flat(0.5, 1.5, 1, 3e-5, 1)}},
                    Broken{"inverted", 4, std::vector<Quad>{turned_over(flat(1, 1, 1, 1, 1)), flat(1, 1, 0.5, 1, 1)}},
                    Broken{"without-area", 0, std::vector<Quad>{{Vec3{1, 1, 1}, {2, 1, 1}, {3, 1, 1}, {2, 1, 1}}}}),
    [](const auto& broken) {
      std::string name = broken.param.name;
      std::erase(name, '-');
      return name;
    });

// little, and nothing
TEST(Extremes, OneFaceUnderTheSkyHasAllOfIt) {
  ModelText model;
  model.object("face", "plain").quad(flat(0, 0, 0, 1, 1));
  for (const char* method : {"hierarchical", "progressive", "gauss-seidel", "jacobi", "path", "bidirectional"}) {
    SCOPED_TRACE(method);
    const Outcome outcome = solve_extreme(model.text(), R"("materials": {"plain": {"reflectance": 0.5, "sides": 1}},
        "sky": {"model": "uniform", "horizontal_illuminance": 17900})",
                                          {"--method", method});
    expect_sound(outcome);
    // Its front has 100 W/m2; its black back is part of it, and has 20 of the ground's.
    EXPECT_NEAR(outcome.by_surface().at("face").E, 60, 1e-6);
    EXPECT_NEAR(outcome.figure("energy.escaped"), 50, 1e-6);
  }
}

TEST(Extremes, WhereNothingSeesAnythingIsRefusedAndSaysSo) {
  // A hundred squares in a row, back to front; and one alone.
  for (const int count : {1, 100}) {
    ModelText model;
    for (int k = 0; k < count; ++k) model.object("s" + std::to_string(k), "glow").quad(flat(2.0 * k, 0, 0, 1, 1));
    const Outcome outcome =
        solve_extreme(model.text(), R"("materials": {"glow": {"reflectance": 0.5, "exitance": 100, "sides": 1}})");
    EXPECT_EQ(outcome.run.exit_code, 3);
    EXPECT_NE(outcome.run.err.find("no light reaches any surface"), std::string::npos) << outcome.run.err;
  }
}

TEST(Extremes, ASealedDarkRoomBesideALitOneCostsNoElementAndAloneIsRefused) {
  ModelText lit, dark;
  lit.object("lit", "glow").box({0, 0, 0}, {4, 3, 2.5}, false);
  dark.object("dark", "plain").box({5, 0, 0}, {9, 3, 2.5}, false);
  const std::string rest = R"("materials": {"glow": {"reflectance": 0.5, "exitance": 100, "sides": 1},
      "plain": {"reflectance": 0.5, "sides": 1}})";
  const Outcome outcome = solve_extreme(lit.text() + dark.text(), rest);  // OBJ counts corners backwards here
  expect_sound(outcome);
  EXPECT_FALSE(outcome.by_surface().contains("dark"));
  EXPECT_LT(off_white(outcome), 1e-3);
  const Outcome alone = solve_extreme(dark.text(), R"("materials": {"plain": {"reflectance": 0.5, "sides": 1}})");
  EXPECT_EQ(alone.run.exit_code, 3);
  EXPECT_NE(alone.run.err.find("light"), std::string::npos) << alone.run.err;
}

}  // namespace
}  // namespace clerestory
