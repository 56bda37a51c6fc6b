#include "pipeline/solve_scene.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// A box of 4 x 3 x 2.5 m, seen from inside, that glows all over: E = M / (1 - rho) everywhere.
Scene glowing_box(double rho = 0.5) {
  Scene scene;
  scene.file = "box";
  scene.surfaces = {"room"};
  Material& wall = scene.materials.emplace_back();
  wall.name = "wall";
  wall.reflectance = Spectrum(rho);
  wall.exitance = Spectrum(10.0);
  wall.sides = 1;
  for (int c = 0; c < 8; ++c) scene.polygons.add_vertex({c & 1 ? 4.0 : 0.0, c & 2 ? 3.0 : 0.0, c & 4 ? 2.5 : 0.0});
  for (const auto& face :
       {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
    for (const int corner : face) scene.polygons.add_corner(static_cast<std::uint32_t>(corner));
    scene.polygons.end_face(MaterialId{std::size_t{0}}, SurfaceId{std::size_t{0}});
  }
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
           {[](S, O o) { o.target_error = -1.0; }, "target_error"},
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

class Listener : public Observer {
 public:
  void warn(const std::string& line) override { warnings.push_back(line); }
  std::vector<std::string> warnings;
};

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

}  // namespace
}  // namespace clerestory
