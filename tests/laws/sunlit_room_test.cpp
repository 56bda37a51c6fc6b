// Where the sun shines into a room is geometry: window and mullion, moved along the sun's direction onto the floor.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/support/result_file.h"
#include "tests/support/run_program.h"

namespace clerestory {
namespace {

constexpr double kNormalIlluminance = 50'000;                      ///< [lx]
constexpr double kSunRadius = 0.533 / 2 * std::numbers::pi / 180;  ///< [rad]
const Vec3 kToSun = normalized({-0.4, -0.8, 0.9});
constexpr double kEdgeIsKnownTo = 0.005;                                          ///< [m]
constexpr double kSill = 0.8, kHead = 2.4;                                        ///< height of the panes [m]
constexpr double kLeft = 0.5, kMullion = 1.65, kMullionEnd = 1.75, kRight = 2.6;  ///< panes along x [m]

/// Black room of 4 x 4 x 3 m; its wall y = 0 has a window of two panes without glass, 10 cm apart.
constexpr const char* kRoom = R"(
v 0 0 0
v 4 0 0
v 4 4 0
v 0 4 0
v 0 0 3
v 4 0 3
v 4 4 3
v 0 4 3
usemtl black
o floor
f 1 2 3 4
o ceiling
f 5 8 7 6
o wall east
f 2 6 7 3
o wall north
f 3 7 8 4
o wall west
f 4 8 5 1
v 0 0 0.8
v 4 0 0.8
v 4 0 2.4
v 0 0 2.4
v 0.5 0 0.8
v 1.65 0 0.8
v 1.75 0 0.8
v 2.6 0 0.8
v 0.5 0 2.4
v 1.65 0 2.4
v 1.75 0 2.4
v 2.6 0 2.4
o wall south
f 1 9 13 14 15 16 10 2
f 12 5 6 11 20 19 18 17
f 9 12 17 13
f 14 18 19 15
f 16 20 11 10
)";

struct Segment {
  Vec3 a, b;
};

/// The shadow on the floor of a point of the wall y = 0.
Vec3 on_floor(double x, double z) { return Vec3{x, 0, z} - kToSun * (z / kToSun.z); }

/// The edges of a pane's light, as the sun's centre throws them.
std::vector<Segment> edges_of_light() {
  std::vector<Segment> edges;
  for (const auto& [from, to] : {std::pair{kLeft, kMullion}, std::pair{kMullionEnd, kRight}}) {
    const Vec3 corner[] = {on_floor(from, kSill), on_floor(to, kSill), on_floor(to, kHead), on_floor(from, kHead)};
    for (int k = 0; k < 4; ++k) edges.push_back({corner[k], corner[(k + 1) % 4]});
  }
  return edges;
}

double distance(const Vec3& p, const Segment& s) {
  const Vec3 along = s.b - s.a;
  const double t = std::clamp(dot(p - s.a, along) / dot(along, along), 0.0, 1.0);
  return length(p - (s.a + along * t));
}

double distance_to_edges(const Vec3& p) {
  double nearest = 1e9;
  for (const Segment& edge : edges_of_light()) nearest = std::min(nearest, distance(p, edge));
  return nearest;
}

/// Whether the centre of the sun is seen from the floor through a pane.
bool is_lit(const Vec3& p) {
  const double t = -p.y / kToSun.y, x = p.x + t * kToSun.x, z = t * kToSun.z;
  return z > kSill && z < kHead && ((x > kLeft && x < kMullion) || (x > kMullionEnd && x < kRight));
}

/// Half the width of the penumbra [m] on the floor, at most: the ray is tilted against the floor.
double penumbra(const Vec3& p) { return -p.y / kToSun.y * std::tan(kSunRadius) / kToSun.z; }

/// The floor of a result.
struct Floor {
  std::vector<std::array<Vec3, 3>> triangles;
  std::vector<std::array<double, 3>> lux;                   ///< at their corners
  std::map<std::size_t, std::pair<Vec3, double>> vertices;  ///< position, illuminance [lx]

  explicit Floor(const ResultFile& result) {
    const auto& names = result.texts.at("surface_names");
    const auto& E = result.of_points.at("illuminance").values;
    for (std::size_t i = 0; i < result.triangles.size(); ++i) {
      const auto surface = static_cast<std::size_t>(result.of_cells.at("surface").values[i]);
      if (names.at(surface) != "floor") continue;
      const auto& t = result.triangles[i];
      triangles.push_back({result.points[t[0]], result.points[t[1]], result.points[t[2]]});
      lux.push_back({E[t[0]], E[t[1]], E[t[2]]});
      for (const std::size_t v : t) vertices[v] = {result.points[v], E[v]};
    }
  }

  /// As ParaView shows it [lx].
  double at(double x, double y) const {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto& [a, b, c] = triangles[i];
      const auto area = [&](const Vec3& p, const Vec3& q) { return (p.x - x) * (q.y - y) - (p.y - y) * (q.x - x); };
      const double wa = area(b, c), wb = area(c, a), wc = area(a, b);
      if (std::min({wa, wb, wc}) < -1e-9) continue;
      return (wa * lux[i][0] + wb * lux[i][1] + wc * lux[i][2]) / (wa + wb + wc);
    }
    ADD_FAILURE() << "no element of the floor at " << x << ", " << y;
    return {};
  }
};

class SunlitRoom : public testing::Test {
 protected:
  static Floor solve() {
    const TempFolder folder;
    folder.write("room.obj", kRoom);
    const std::string scene = folder.write("room.json", R"({ "geometry": [{ "file": "room.obj" }],
        "materials": { "black": { "reflectance": 0, "sides": 1 } },
        "sun": { "direction": [-0.4, -0.8, 0.9], "normal_illuminance": 50000 } })");
    const ProgramRun run = run_program({"solve", scene, "-o", folder / "out.vtp", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return Floor(read_result(folder / "out.vtp"));
  }
  const double full_ = kNormalIlluminance * kToSun.z;  ///< [lx]
};

TEST_F(SunlitRoom, IsLitOrDarkBesideThePenumbra) {
  const Floor floor = solve();
  std::size_t lit = 0, dark = 0;
  double worst_lit = 0, worst_dark = 0;
  for (const auto& [id, vertex] : floor.vertices) {
    const auto& [p, lux] = vertex;
    if (distance_to_edges(p) < kEdgeIsKnownTo + penumbra(p)) continue;
    (is_lit(p) ? lit : dark)++;
    double& worst = is_lit(p) ? worst_lit : worst_dark;
    worst = std::max(worst, std::abs(lux / full_ - (is_lit(p) ? 1 : 0)));
    EXPECT_NEAR(lux / full_, is_lit(p) ? 1 : 0, 0.02) << p.x << ", " << p.y;
  }
  std::printf("%zu vertices: %zu lit, off by up to %.3f %%; %zu dark, up to %.3f %%\n", floor.vertices.size(), lit,
              100 * worst_lit, dark, 100 * worst_dark);
  EXPECT_GT(lit, 50u);
  EXPECT_GT(dark, 50u);
}

TEST_F(SunlitRoom, EdgesLieWhereGeometryPutsThem) {
  const Floor floor = solve();
  double worst = 0;
  // Across each edge at inner points of it: the place nearest to the edge where half the light is reached.
  for (const Segment& edge : edges_of_light()) {
    const Vec3 along = normalized(edge.b - edge.a), across{-along.y, along.x, 0};  // to the lit side
    for (int k = 1; k < 12; ++k) {
      const Vec3 p = edge.a + (edge.b - edge.a) * (k / 12.0);
      double nearest = 1e9;
      constexpr double kStep = 0.001;
      for (double s = -0.3; s < 0.3; s += kStep) {
        const Vec3 before = p + across * s, after = p + across * (s + kStep);
        if (floor.at(before.x, before.y) < full_ / 2 && floor.at(after.x, after.y) >= full_ / 2)
          nearest = std::abs(s) < std::abs(nearest) ? s + kStep / 2 : nearest;
      }
      EXPECT_LT(std::abs(nearest), kEdgeIsKnownTo) << "edge at " << p.x << ", " << p.y;
      worst = std::max(worst, std::abs(nearest));
    }
  }
  std::printf("edges are off by up to %.1f mm\n", 1000 * worst);
}

TEST(SunThroughSlats, MakesNoElementBrighterThanTheSun) {
  // Many edges to an element: what its corners miss is put right by the flux that the transport found, but not beyond.
  std::string slats = "v -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nf 1 2 3 4\n";
  for (int i = 0; i < 30; ++i) {
    const double x = -2 + 0.13 * i;
    for (const auto& [dx, y, z] : {std::tuple{0.0, -2, 0.6}, {0.09, -2, 0.62}, {0.09, 2, 0.62}, {0.0, 2, 0.6}})
      slats += "v " + std::to_string(x + dx) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    slats += "f -4 -3 -2 -1\n";
  }
  const TempFolder folder;
  folder.write("slats.obj", slats);
  const std::string scene = folder.write("slats.json", R"({ "geometry": [{ "file": "slats.obj", "up": "z" }],
      "materials": { "default": { "reflectance": 0 } },
      "sun": { "direction": [0.2, 0.3, 1], "normal_illuminance": 10000 } })");
  const ProgramRun run = run_program({"solve", scene, "-o", folder / "out.vtp", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const ResultFile result = read_result(folder / "out.vtp");
  const auto& E = result.of_cells.at("illuminance").values;
  EXPECT_LT(*std::max_element(E.begin(), E.end()), 10'000);
}

}  // namespace
}  // namespace clerestory
