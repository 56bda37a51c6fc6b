#include "pipeline/solve_scene.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/result_checks.h"
#include "pipeline/target_rounds.h"
#include "solver/model/error.h"
#include "solver/model/units.h"
#include "solver/run/sound_result.h"

namespace clerestory {
namespace {

/// A box of 4 x 3 x 2.5 m, seen from inside, that glows all over: E = M / (1 - rho) everywhere.
/// A box of the first material: its faces look inwards, or outwards as those of a solid.
void add_box(Scene& scene, const Vec3& lower, const Vec3& upper, SurfaceId surface, bool inwards) {
  const auto first = static_cast<std::uint32_t>(scene.polygons.vertices.size());
  for (int c = 0; c < 8; ++c)
    scene.polygons.add_vertex({c & 1 ? upper.x : lower.x, c & 2 ? upper.y : lower.y, c & 4 ? upper.z : lower.z});
  for (auto face : {std::array{0u, 1u, 3u, 2u},
                    {4u, 6u, 7u, 5u},
                    {0u, 4u, 5u, 1u},
                    {2u, 3u, 7u, 6u},
                    {0u, 2u, 6u, 4u},
                    {1u, 5u, 7u, 3u}}) {
    if (!inwards) std::ranges::reverse(face);
    for (const std::uint32_t corner : face) scene.polygons.add_corner(first + corner);
    scene.polygons.end_face(MaterialId{std::size_t{0}}, surface);
  }
}

Scene glowing_box(double rho = 0.5) {
  Scene scene;
  scene.file = "box";
  scene.surfaces = {"room"};
  Material& wall = scene.materials.emplace_back();
  wall.name = "wall";
  wall.reflectance = Spectrum(rho);
  wall.exitance = Spectrum(10.0);
  wall.sides = 1;
  add_box(scene, {0, 0, 0}, {4, 3, 2.5}, SurfaceId{std::size_t{0}}, true);
  scene.sensors = {{.name = "desk", .points = {{{1, 1.5, 0.8}, {0, 0, 1}}}}};
  return scene;
}

Settings draft() { return {.solve = {.accuracy = Accuracy::draft}}; }

TEST(SolveScene, GivesTheClosedFormInAClosedRoom) {
  const Solved solved = solve_scene(glowing_box(), draft());
  EXPECT_NEAR(solved.sensor_E[0][0], 20, 20 * 1e-6);  // gathers of an even room are exact
  ASSERT_TRUE(solved.error.has_value());
  EXPECT_LE(solved.error->rms_relative, solved.error->confidence);
  EXPECT_EQ(solved.solution.stop, StopReason::converged);
}

TEST(SolveScene, RefusesWhatNoFileCouldSay) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](const std::function<void(Scene&, Settings&)>& spoil) -> std::string {
    Scene scene = glowing_box();
    Settings settings = draft();
    spoil(scene, settings);
    try {
      solve_scene(scene, settings);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  using S = Scene&;
  using O = Settings&;
  EXPECT_EQ(
      refusal([](S s, O) { s.materials[0].reflectance = Spectrum(1.2); }),
      "box: material 'wall': reflectance = 1.20 is outside [0, 1); a surface cannot give back or pass more than it "
      "receives.");
  for (const auto& [spoil, word] : std::initializer_list<std::pair<std::function<void(S, O)>, const char*>>{
           {[](S s, O) { s.materials[0].reflectance = Spectrum(kNone); }, "reflectance"},
           {[](S s, O) { s.materials[0].exitance = Spectrum(kNone); }, "exitance"},
           {[](S s, O) { s.polygons.material[2] = MaterialId{std::size_t{9}}; }, "material that is not there"},
           {[](S s, O) { s.polygons.corner[5] = 99; }, "vertex 99"},
           {[](S s, O) {
              s.lights.luminaires.push_back({"w", {}, {}, WebLuminaire{}});
            },
            "photometric web"},
           {[](S s, O) {
              s.lights.luminaires.push_back({"p", {kNone, 0, 0}, {}, PointLuminaire{}});
            },
            "position"},
           {[](S s, O) { s.sensors[0].points[0].normal = {}; }, "sensors 'desk'"},
           {[](S, O o) { o.channels = 2; }, "channels = 2"},
           {[](S, O o) { o.detail = -0.1; }, "detail"},
           {[](S, O o) { o.target_error = -1.0; }, "target_error"},
           {[](S, O o) { o.target_error = 2.0; }, "it is relative: 0.02 is 2 %"},
           {[](S, O o) { o.solve.tighten = -1; }, "tighten"}})
    EXPECT_NE(refusal(spoil).find(word), std::string::npos) << word << ": " << refusal(spoil);
  Scene misspelt = glowing_box();
  misspelt.settings.method = "hierachical";
  EXPECT_THROW(settings_of(misspelt), InputError);
}

TEST(SolveScene, SettingsMayBeUsedTwiceWithATimeLimit) {
  // The limit counts from each call, not from when the settings were made: an hour is enough for both.
  Settings settings = draft();
  settings.time_limit = 3600;
  for (int k = 0; k < 2; ++k) EXPECT_EQ(solve_scene(glowing_box(), settings).solution.stop, StopReason::converged);
  settings.start = std::chrono::steady_clock::now() - std::chrono::hours(2);
  EXPECT_EQ(solve_scene(glowing_box(), settings).solution.stop, StopReason::time_limit);
}

TEST(SolveScene, WithTimeEnoughGivesWhatItGivesWithoutALimit) {
  // By way of a draft, whose elements tell that there is time.
  for (const Accuracy level : {Accuracy::draft, Accuracy::standard}) {
    Settings settings = draft();
    settings.solve.accuracy = level;
    const Solved free = solve_scene(glowing_box(), settings);
    settings.time_limit = 3600;
    const Solved limited = solve_scene(glowing_box(), settings);
    EXPECT_EQ(limited.solution.stop, StopReason::converged);
    EXPECT_EQ(limited.settings.solve.accuracy, level);
    EXPECT_EQ(limited.lightmap.E.value, free.lightmap.E.value);
    EXPECT_EQ(limited.solution.E.value, free.solution.E.value);
    EXPECT_EQ(limited.sensor_E.value, free.sensor_E.value);
  }
}

TEST(SolveScene, WhoseTimeIsOverShowsVerticesAllTheSame) {
  Settings settings;
  settings.time_limit = 1;
  settings.start = std::chrono::steady_clock::now() - std::chrono::hours(1);
  const Solved late = solve_scene(glowing_box(), settings);
  EXPECT_EQ(late.solution.stop, StopReason::time_limit);
  EXPECT_EQ(late.settings.solve.accuracy, Accuracy::draft);
  EXPECT_EQ(late.solution.stopped_at, "the ambient estimate");
  for (std::size_t i = 0; i < late.patches.patch_count(); ++i)
    for (const std::uint32_t p : late.lightmap.corners[i])
      EXPECT_NEAR(late.lightmap.E[p][0], late.patches.M[i][0] > 0 ? 20 : 0, 0.5);  // the box is dark outside
}

/// Stops at once, and counts what it is told.
class Impatient : public Observer {
 public:
  bool should_stop() const override { return true; }
};

TEST(SolveScene, StoppedBeforeThereArePatchesIsEmpty) {
  Impatient observer;
  const Solved solved = solve_scene(glowing_box(), draft(), observer);
  EXPECT_TRUE(solved.empty());
  EXPECT_EQ(solved.solution.stop, StopReason::interrupted);
}

/// Stops once there is something to lose.
class Leaving : public Observer {
 public:
  void has_result() override { has_it = true; }
  bool should_stop() const override { return has_it; }
  bool has_it = false;
};

Scene box_of_two_groups() {
  Scene scene = glowing_box();
  scene.materials[0].group = "walls";
  scene.lights.luminaires.push_back({"lamp", {2, 1.5, 1.25}, "desk", PointLuminaire{Spectrum(118.0)}});
  return scene;
}

TEST(SolveScene, InLayersGivesEachTheClosedFormOfItsOwnLight) {
  Settings settings = draft();
  settings.layers = true;
  settings.error_samples = 0;
  const Solved solved = solve_scene(box_of_two_groups(), settings);
  ASSERT_EQ(solved.layers.layers.size(), 2u);
  EXPECT_EQ(solved.layers.layers[0].name, "desk");
  EXPECT_EQ(solved.layers.layers[1].name, "walls");
  const Field &E = solved.layers.light.E_elements, &B = solved.layers.light.B_elements;
  double flux = 0, area = 0;
  for (std::size_t i = 0; i < E.size(); ++i) {
    if (solved.patches.M.at(i, 0) == 0) continue;  // the box is dark outside
    EXPECT_NEAR(E.at(i, 1), 20, 0.2) << "M / (1 - rho); layers share the 1 % that totals are put right by";
    EXPECT_NEAR(B.at(i, 1), 10 + 0.5 * E.at(i, 1), 1e-9);
    EXPECT_NEAR(B.at(i, 0), 0.5 * E.at(i, 0), 1e-9);
    flux += E.at(i, 0) * solved.patches.area[i], area += solved.patches.area[i];
  }
  EXPECT_NEAR(area, 59, 1e-6);
  EXPECT_NEAR(flux, 118 / (1 - 0.5), 0.01 * 236) << "1 % of a draft's energy";
  EXPECT_DOUBLE_EQ(solved.layers.energy[0].emitted, 118);
  EXPECT_NEAR(solved.layers.sensor_E.at(0, 0) + solved.layers.sensor_E.at(0, 1), solved.sensor_E.at(0, 0), 1e-6);
}

TEST(SolveScene, StoppedBeforeItHasLayersShowsTheLightTogether) {
  Settings settings = draft();
  settings.layers = true;
  Leaving observer;
  const Solved solved = solve_scene(box_of_two_groups(), settings, observer);
  ASSERT_FALSE(solved.empty());
  EXPECT_EQ(solved.solution.stop, StopReason::interrupted);
  EXPECT_TRUE(solved.layers.light.empty());
  EXPECT_GT(solved.lightmap.E[0][0], 0);
}

TEST(SolveScene, RefusesLayersThatCannotBe) {
  Settings settings = draft();
  settings.layers = true;
  settings.solve.method = Method::progressive;
  EXPECT_THROW(solve_scene(box_of_two_groups(), settings), InputError);
  settings.solve.method = Method::hierarchical;
  Scene scene = box_of_two_groups();
  scene.materials[0].group = "sky";
  EXPECT_THROW(solve_scene(scene, settings), InputError);
}

class Listener : public Observer {
 public:
  void warn(const std::string& line) override { warnings.push_back(line); }
  void step(const std::string& line) override { steps.push_back(line); }
  std::vector<std::string> warnings, steps;
};

TEST(RoundFor, IsTheFirstThatReachesTheTargetByWhatTheErrorIsNow) {
  EXPECT_EQ(round_for(0.05, 0, 0.1), 1u);   // a standard has half the error of a draft
  EXPECT_EQ(round_for(0.021, 0, 0.1), 3u);  // and a fine one, raised once, a fifth
  EXPECT_EQ(round_for(0.02, 1, 0.03), 2u);  // from a standard on
  EXPECT_EQ(round_for(1e-6, 0, 0.1), 1u) << "one after another where none is expected to reach it";
  for (std::size_t k = 1; k < kTargetRounds.size(); ++k) {
    EXPECT_LT(kTargetRounds[k].error, kTargetRounds[k - 1].error);
    EXPECT_GT(kTargetRounds[k].time, kTargetRounds[k - 1].time);
  }
}

TEST(SolveScene, GoesFromADraftToWhatATargetErrorNeedsAndSaysBefore) {
  // A lamp under the ceiling: a draft is some per cent off.
  Scene scene = glowing_box();
  scene.materials[0].exitance = Spectrum(0.0);
  scene.lights.luminaires.push_back({"lamp", {2, 1.5, 2.2}, {}, PointLuminaire{Spectrum(10.0)}});
  Settings settings;  // of `standard`, which a target does not start with
  settings.target_error = 0.5;
  Listener easy;
  const Solved rough = solve_scene(scene, settings, easy);
  EXPECT_TRUE(meets_target(rough));
  EXPECT_EQ(rough.settings.solve.accuracy, Accuracy::draft);
  EXPECT_TRUE(easy.steps.empty());
  ASSERT_TRUE(rough.error);
  settings.target_error = 0.9 * rough.error->largest().lower;  // draft is above for sure
  ASSERT_GT(settings.target_error, 0.005);
  Listener hard;
  const Solved better = solve_scene(scene, settings, hard);
  EXPECT_TRUE(meets_target(better));
  EXPECT_GT(better.settings.solve.accuracy, Accuracy::draft);
  ASSERT_FALSE(hard.steps.empty());
  EXPECT_NE(hard.steps[0].find("with draft, asked for"), std::string::npos) << hard.steps[0];
  EXPECT_NE(hard.steps[0].find("in about"), std::string::npos) << hard.steps[0];
}

TEST(SolveScene, WarnsOnceHoweverManyRoundsATargetErrorTakes) {
  Scene scene = glowing_box();
  scene.lights.luminaires.push_back({"outside", {9, 9, 9}, {}, PointLuminaire{Spectrum(1.0)}});
  Settings settings = draft();
  settings.target_error = 1e-4;  // below what a measurement can be sure of
  settings.max_element = 2.0;
  Listener observer;
  solve_scene(scene, settings, observer);
  EXPECT_EQ(
      std::ranges::count_if(observer.warnings, [](const std::string& w) { return w.find("'outside'") != w.npos; }), 1);
}

double smallest(const Field& x) { return *std::ranges::min_element(x.value); }
void expect_nothing_negative(const Solved& s) {
  EXPECT_GE(smallest(s.solution.E), 0);
  EXPECT_GE(smallest(s.solution.B), 0);
  EXPECT_GE(smallest(s.lightmap.E), 0);
  EXPECT_GE(smallest(s.sensor_E), 0);
}

/// The box without glow, and a lamp of 10 W so far off the wall y = 0.
Scene box_with_lamp(double distance) {
  Scene scene = glowing_box();
  scene.materials[0].exitance = Spectrum(0.0);
  scene.lights.luminaires.push_back({"lamp", {1.7, distance, 1.1}, {}, PointLuminaire{Spectrum(10.0)}});
  return scene;
}

TEST(SolveScene, ResolvesRoomsThatWereGoodEnoughNoBetterThanThen) {
  // Two rooms alike, 6 m apart, each with its lamp.
  Scene scene = box_with_lamp(0.3);
  scene.surfaces.push_back("other");
  add_box(scene, {6, 0, 0}, {10, 3, 2.5}, SurfaceId{std::size_t{1}}, true);
  scene.lights.luminaires.push_back({"lamp", {7.7, 0.3, 1.1}, {}, PointLuminaire{Spectrum(10.0)}});
  const auto elements = [&](const Settings& settings) {
    const Solved s = solve_scene(scene, settings);
    std::array<std::ptrdiff_t, 2> count{};
    for (std::uint32_t room = 0; room < 2; ++room) count[room] = std::ranges::count(s.patches.room, room);
    return std::pair{count, s.patches.rooms};
  };
  Settings settings;
  const auto [fine, rooms] = elements(settings);
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NEAR(static_cast<double>(fine[0]) / static_cast<double>(fine[1]), 1, 0.2);
  settings.solve.good_rooms = {{rooms[1], Accuracy::draft, 0, 1.0}};
  const auto kept = elements(settings).first;
  EXPECT_NEAR(static_cast<double>(kept[0]) / static_cast<double>(fine[0]), 1, 0.1);
  EXPECT_LT(static_cast<double>(kept[1]), 0.7 * static_cast<double>(fine[1]));
}

TEST(SolveScene, KeepsTheEnergyOfALampHoweverNearToAWall) {
  for (const Method method : {Method::hierarchical, Method::progressive, Method::gauss_seidel})
    for (const double distance : {1e-6, 1e-3, 1e-2}) {
      SCOPED_TRACE(testing::Message() << kMethodNames[static_cast<std::size_t>(method)] << ", " << distance << " m");
      Settings settings = draft();
      settings.solve.method = method;
      const Solved s = solve_scene(box_with_lamp(distance), settings);
      const double exact = 10 / (59.0 * (1 - 0.5));  // flux / (A (1 - rho))
      double cells = 0, points = 0;
      for (std::size_t i = 0; i < s.patches.patch_count(); ++i) {
        cells += s.patches.area[i] * s.solution.E[i][0] / 59;
        for (const std::uint32_t p : s.lightmap.corners[i]) points += s.patches.area[i] / 3 * s.lightmap.E[p][0] / 59;
      }
      EXPECT_NEAR(cells / exact, 1, 5e-3);
      EXPECT_NEAR(points / exact, 1, 1e-2);  // lines between points lose a little where light bulges
      EXPECT_NEAR(s.solution.energy.imbalance(), 0, 1e-3);
      expect_nothing_negative(s);
    }
}

TEST(SolveScene, KeepsTheLightOfADownlightInThePlaneOfACeilingAtAnyHeight) {
  // Heights that double holds exactly, and such that it does not: meshing rounds both.
  for (const double height : {2.5, 2.65, 2.7, 2.75, 3.1, 3.33}) {
    SCOPED_TRACE(testing::Message() << height << " m");
    Scene scene = glowing_box();
    scene.materials[0].exitance = Spectrum(0.0);
    for (Vec3& v : scene.polygons.vertices)
      if (v.z > 1) v.z = height;
    SpotLuminaire down{{0, 0, -1}, Spectrum(1.0), 0.5, 1.0};
    scene.lights.luminaires.push_back({"downlight", {1.7, 1.1, height}, {}, down});
    const Solved s = solve_scene(scene, draft());
    double received = 0;
    for (std::size_t i = 0; i < s.patches.patch_count(); ++i) received += s.patches.area[i] * s.solution.E[i][0];
    EXPECT_NEAR(received * (1 - 0.5) / s.solution.energy.emitted, 1, 5e-3);
    EXPECT_GT(s.solution.energy.emitted, 1);
    EXPECT_NEAR(s.solution.energy.imbalance(), 0, 1e-3);
  }
}

TEST(SolveScene, LeavesNothingNegativeInANarrowWedgeUnderTheSky) {
  // Two squares of 1 m that meet in an edge at 0.1 degrees: between them each hides nearly all of the sky.
  Scene scene;
  scene.file = "wedge";
  scene.surfaces = {"wedge"};
  Material& wall = scene.materials.emplace_back();
  wall.name = "wall";
  wall.reflectance = Spectrum(0.5);
  wall.sides = 1;
  const double h = 1.7453e-3;
  for (const Vec3& v : {Vec3{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, h}, {1, 1, h}})
    scene.polygons.add_vertex(v);
  for (const auto& face : {std::array{0, 1, 2, 3}, {0, 3, 5, 4}}) {
    for (const int corner : face) scene.polygons.add_corner(static_cast<std::uint32_t>(corner));
    scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
  }
  scene.lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(50.0)};
  const Solved s = solve_scene(scene, draft());
  EXPECT_GT(*std::ranges::max_element(s.lightmap.E.value), 10);  // the side that looks up
  EXPECT_GE(smallest(s.solution.E), 0);
  EXPECT_GE(smallest(s.solution.B), 0);
  EXPECT_GE(smallest(s.lightmap.E), 0);
}

bool any_says(const std::vector<std::string>& warnings, const std::string& words) {
  return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
}

TEST(WarnAboutResult, SaysHowMuchLightIsMissingOrTooMuch) {
  Solved solved = solve_scene(glowing_box(), draft());
  Listener quiet;
  warn_about_result(solved, quiet);
  EXPECT_TRUE(quiet.warnings.empty());
  solved.solution.energy = {.emitted = 20, .absorbed = 16, .escaped = 1};
  Listener missing;
  warn_about_result(solved, missing);
  EXPECT_TRUE(any_says(missing.warnings, "15.0 % of the light is missing from this result (537 lm of 3580 lm)"));
  solved.solution.energy.absorbed = 22;
  Listener too_much;
  warn_about_result(solved, too_much);
  EXPECT_TRUE(any_says(too_much.warnings, "15.0 % more light than was sent"));
  solved.solution.energy.absorbed = 18.9;
  solved.error = MeasuredError{{.rms_relative = 0.3, .p95_relative = 0.2, .samples = 64, .confidence = 0.1}};
  Listener error;
  warn_about_result(solved, error);
  ASSERT_EQ(error.warnings.size(), 1u);
  EXPECT_TRUE(any_says(error.warnings, "the measured error is 30.0 % rms"));
}

TEST(WarnAboutResult, SaysWhenTheErrorOfTheSensorsIsLargeOrNotKnown) {
  Solved solved = solve_scene(glowing_box(), draft());
  const auto warnings = [&] {
    Listener listener;
    warn_about_result(solved, listener);
    return listener.warnings;
  };
  solved.error_sensors = MeasuredError{{.rms_relative = 0.3, .p95_relative = 0.2, .samples = 64, .confidence = 0.1}};
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_TRUE(any_says(warnings(), "the measured error of the sensors is 30.0 % rms"));
  solved.error_sensors.reset();  // no path found the 20 W/m2 that they show
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_TRUE(any_says(warnings(), "how wrong the sensors are is not known: they show up to 3580 lx"));
  solved.solution.stop = StopReason::time_limit;  // then they may not have been measured at all
  EXPECT_TRUE(warnings().empty());
  solved.solution.stop = StopReason::converged;
  solved.sensor_E.set(0, Spectrum(0.0));  // nothing is shown, and nothing was found
  EXPECT_TRUE(warnings().empty());
}

TEST(WarnAboutResult, NamesTheRoomsThatAreOffAndCallsABoundUselessWhereItIs) {
  Solved solved = solve_scene(glowing_box(), draft());
  const auto room = [](const char* name, double rms) {
    return ErrorOfPart{name, 10, 100, {.rms_relative = rms, .samples = 64, .confidence = 0.1 * rms}};
  };
  solved.error = MeasuredError{{.rms_relative = 0.01, .samples = 320, .confidence = 0.001}};
  solved.error->parts = {room("hall", 0.5),  room("bath", 0.2),  room("cellar", 0.4),
                         room("good", 0.01), room("attic", 0.3), room("loft", 0.25)};
  const auto warnings = [&] {
    Listener listener;
    warn_about_result(solved, listener);
    return listener.warnings;
  };
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_TRUE(any_says(warnings(), "in 'hall' is 50.0 % rms (+- 5.00 %)")) << warnings()[0];
  EXPECT_TRUE(any_says(warnings(), "; so it is in 'cellar', 40.0 %, 'attic', 30.0 %, 'loft', 25.0 %, and 1 more room:"))
      << warnings()[0];
  EXPECT_FALSE(any_says(warnings(), "good"));
  solved.error.emplace(MeasuredError{{.rms_relative = 0.01, .samples = 320, .confidence = 0.001}});
  solved.error_sensors = MeasuredError{{.rms_relative = 0.8, .samples = 64, .bound = true}};
  ASSERT_EQ(warnings().size(), 1u);
  EXPECT_TRUE(any_says(warnings(), "how wrong the sensors are is hardly known: below 80.0 % rms")) << warnings()[0];
  solved.error_sensors->rms_relative = 0.04;  // a bound that is worth having
  EXPECT_TRUE(warnings().empty());
}

/// A room with a table or, from the floor up, a chest.
Scene room_with_table(double bottom) {
  Scene scene = box_with_lamp(1.5);
  scene.surfaces.push_back("table");
  add_box(scene, {2, 1, bottom}, {3, 2, 0.75}, SurfaceId{std::size_t{1}}, false);
  return scene;
}

TEST(SolveScene, SaysThatALampStandsInsideOfASolid) {
  Scene scene = room_with_table(0.70);
  Listener before;
  solve_scene(scene, draft(), before);
  EXPECT_FALSE(any_says(before.warnings, "inside of the solid"));
  scene.lights.luminaires.push_back({"lost", {2.5, 1.5, 0.73}, {}, PointLuminaire{Spectrum(5.0)}});
  Listener observer;
  solve_scene(scene, draft(), observer);
  EXPECT_TRUE(
      any_says(observer.warnings, "luminaire 'lost' at (2.500, 1.500, 0.7300) stands inside of the solid 'table'"));
}

TEST(SolveScene, SaysThatALampStandsInsideOfASolidThatStandsOnTheFloor) {
  Scene scene = room_with_table(0);
  scene.lights.luminaires.push_back({"lost", {2.5, 1.5, 0.3}, {}, PointLuminaire{Spectrum(5.0)}});
  scene.lights.luminaires.push_back({"found", {2.5, 1.5, 0.8}, {}, PointLuminaire{Spectrum(5.0)}});
  Listener observer;
  solve_scene(scene, draft(), observer);
  EXPECT_TRUE(
      any_says(observer.warnings, "luminaire 'lost' at (2.500, 1.500, 0.3000) stands inside of the solid 'table'"));
  EXPECT_FALSE(any_says(observer.warnings, "'found'"));
}

TEST(SolveScene, TakesALampInAnOpalShadeAndARoomWoundOutwardsForNoSolids) {
  Scene scene = room_with_table(0);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "opal", scene.materials[1].kind = MaterialKind::diffuser;
  scene.materials[1].reflectance = Spectrum(0.3), scene.materials[1].transmittance = Spectrum(0.5);
  for (std::size_t face = 6; face < 12; ++face) scene.polygons.material[face] = MaterialId{std::size_t{1}};
  scene.lights.luminaires.push_back({"shaded", {2.5, 1.5, 0.3}, {}, PointLuminaire{Spectrum(5.0)}});
  Listener opal;
  solve_scene(scene, draft(), opal);
  EXPECT_FALSE(any_says(opal.warnings, "inside of the solid"));
  Scene corridor = box_with_lamp(0.5);
  std::reverse(corridor.polygons.corner.begin(), corridor.polygons.corner.end());  // six faces of four corners
  for (Vec3& v : corridor.polygons.vertices) v.y *= 0.4;
  corridor.materials[0].sides = 2;
  Listener outwards;
  solve_scene(corridor, draft(), outwards);
  EXPECT_FALSE(any_says(outwards.warnings, "inside of the solid"));
}

TEST(RequireSound, RefusesWhatIsNoNumberOrNegativeAndClearsRounding) {
  Field field(3, 1);
  field.value = {1, -1e-7, 0};
  require_sound(field, "light");
  EXPECT_EQ(field.value[1], 0);
  field.value = {1, -0.01, 0};
  EXPECT_THROW(require_sound(field, "light"), std::logic_error);
  field.value = {1, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_THROW(require_sound(field, "light"), std::logic_error);
}

}  // namespace
}  // namespace clerestory
