#include "solver/methods/hierarchical.h"

#include <atomic>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/methods/path.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "tests/support/unjoined_lightmap.h"

namespace clerestory {
namespace {

struct Room {
  PatchSet patches;
  Lights lights;
  RayScene rays{patches};
  Problem problem{patches, rays, lights};
  VertexLightmap map = test::unjoined_lightmap(patches);

  explicit Room(PatchSet p, Lights l = {}) : patches(std::move(p)), lights(std::move(l)) {}
  HierarchicalSolution solve(const HierarchyOptions& options = {}, const Monitor& monitor = {}) const {
    ElementMesh mesh(patches, map);
    return hierarchical(problem, mesh, options, monitor);
  }
};

double mean(const PatchSet& patches, const Field& x) {
  double sum = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) sum += patches.area[i] * x[i][0];
  return sum / patches.total_area();
}

struct Estimate {
  double value = 0, std_error = 0;
};

/// Of independent values.
Estimate mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Estimate e;
  double squares = 0;
  for (const double x : values) e.value += x / n;
  for (const double x : values) squares += std::pow(x - e.value, 2);
  e.std_error = std::sqrt(squares / (n * (n - 1)));
  return e;
}

/// Mean square over the area of a difference whose own noise is known: the noise is taken off, and what is left has the
/// standard error that this noise leaves, Var d^2 = 4 d^2 s^2 + 2 s^4.
class MeanSquare {
 public:
  void add(double area, double difference, double variance) {
    const double d2 = difference * difference;
    area_ += area, sum_ += area * (d2 - variance);
    spread_ += area * area * (4 * d2 * variance + 2 * variance * variance);
  }
  Estimate result() const { return {sum_ / area_, std::sqrt(spread_) / area_}; }

 private:
  double area_ = 0, sum_ = 0, spread_ = 0;
};

/// RMS difference over the area / mean of the reference, without the reference's own noise.
Estimate rms_error(const PatchSet& patches, const Field& E, const Solution& reference) {
  MeanSquare square;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double noise = reference.std_error.size() > 0 ? reference.std_error[i][0] : 0;
    square.add(patches.area[i], E[i][0] - reference.E[i][0], noise * noise);
  }
  const Estimate e = square.result();
  const double rms = std::sqrt(std::max(0.0, e.value)), level = mean(patches, reference.E);
  return {rms / level, rms > 0 ? e.std_error / (2 * rms) / level : std::sqrt(e.std_error) / level};
}

/// A run for each seed. Elements differ from seed to seed, so irradiance is that of the room's patches.
struct Runs {
  std::vector<Field> E;
  std::vector<double> mean, direct, imbalance;  ///< of E [W/m2], flux of small lights [W], of the energy balance [1]
  std::vector<bool> in_the_dark;                ///< by patch: small lights never reach it
};
Runs runs(const Room& room, HierarchyOptions options, int seeds = 6) {
  const PatchSet& patches = room.patches;
  Runs out;
  out.in_the_dark.assign(patches.patch_count(), true);
  for (int seed = 1; seed <= seeds; ++seed) {
    options.seed = static_cast<std::uint64_t>(seed);
    ElementMesh mesh(patches, room.map);
    const HierarchicalSolution h = hierarchical(room.problem, mesh, options);
    Field& E = out.E.emplace_back(patches.patch_count(), 1);
    double direct = 0;
    std::size_t k = 0;
    for (const std::uint32_t leaf : mesh.leaves()) {
      const auto& e = mesh[leaf];
      E.at(e.patch, 0) += h.solution.E[k][0] * e.area / patches.area[e.patch];
      direct += h.elements.area[k] * h.delta_light[k][0];
      if (h.delta_light[k++][0] > 0) out.in_the_dark[e.patch] = false;
    }
    out.mean.push_back(mean(patches, E)), out.direct.push_back(direct);
    out.imbalance.push_back(h.solution.energy.imbalance());
  }
  return out;
}

/// The runs' mean is the reference but for the standard errors of both, all over and patch by patch; there constant
/// elements may err too, by `constant` of the mean. A single run is off by less than n^-3/4, n the fewest rays of a
/// kind: stratified rays that find something between nothing and twice the mean (tests/convergence/gather_test.cpp).
void expect_agreement(const Room& room, const Runs& runs, const Solution& reference, int fewest_rays, double constant) {
  const PatchSet& patches = room.patches;
  MeanSquare bias;
  double noise = 0, light = 0, area = 0, reference_variance = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double a = patches.area[i];
    const double known_to = reference.std_error.size() > 0 ? reference.std_error[i][0] : 0;
    reference_variance += std::pow(a / patches.total_area() * known_to, 2);
    if (!runs.in_the_dark[i]) continue;  // on the edge of a shadow nothing is even
    std::vector<double> E;
    for (const Field& run : runs.E) E.push_back(run[i][0]);
    const Estimate e = mean_of(E);
    const double variance = e.std_error * e.std_error;
    bias.add(a, e.value - reference.E[i][0], variance + known_to * known_to);
    noise += a * variance * static_cast<double>(runs.E.size()), light += a * reference.E[i][0], area += a;
  }
  const Estimate square = bias.result(), all = mean_of(runs.mean);
  EXPECT_LT(square.value, std::pow(constant * light / area, 2) + 4 * square.std_error)
      << "patches are off, beyond noise, by " << std::sqrt(square.value);
  EXPECT_NEAR(all.value, mean(patches, reference.E), 4 * std::hypot(all.std_error, std::sqrt(reference_variance)));
  EXPECT_LT(std::sqrt(noise * area) / light, std::pow(fewest_rays, -0.75));
}

/// Irradiance of `leaves` by paths, in eight independent parts: their spread counts what stratification gains, which
/// the spread of single paths does not.
Solution paths(const Room& room, const PatchSet& leaves, int count) {
  constexpr int kParts = 8;
  const Problem problem{leaves, room.rays, room.lights};
  DirectLight none;
  none.E = Field(leaves.patch_count(), leaves.channels);
  const Closure closure = measure_closure(problem, 16, 1);
  std::vector<Field> parts;
  for (std::uint64_t part = 0; part < kParts; ++part)
    parts.push_back(
        path_trace(problem, Illumination(problem), "path", none, closure, {.paths = count / kParts, .seed = 99 + part})
            .E);
  Solution all;
  all.E = all.std_error = Field(leaves.patch_count(), 1);
  for (std::size_t i = 0; i < leaves.patch_count(); ++i) {
    std::vector<double> E;
    for (const Field& part : parts) E.push_back(part[i][0]);
    const Estimate e = mean_of(E);
    all.E.at(i, 0) = e.value, all.std_error.at(i, 0) = e.std_error;
  }
  return all;
}

/// What constant elements may err by: they are halved while light varies by more than the tolerance inside of them, so
/// what they send is off by half of it at most, of the part that they reflect.
double constant_elements(double rho) { return rho * HierarchyOptions{}.tolerance / 2; }

/// A room with two blocks and a lamp 12 mm under its ceiling, black on its back.
PatchSet lamp_room(double rho, std::size_t cells = 12) {
  test::PatchBuilder b(rho);
  const std::size_t n = cells, block = std::max<std::size_t>(1, cells / 4);
  b.box({0, 0, 0}, {5.5, 0, 0}, {0, 4.5, 0}, {0, 0, 2.8}, {n, n * 9 / 11, n / 2}, true);
  b.box({1.2, 1.0, 0.1}, {0.955, 0.296, 0}, {-0.355, 1.146, 0}, {0, 0, 1.9}, {block, block, block}, false);
  b.box({3.6, 2.3, 0.3}, {1.221, -0.446, 0}, {0.309, 0.845, 0}, {0, 0, 0.8}, {block, block, block}, false);
  b.material(rho, 100).rectangle({2.3, 1.9, 2.788}, {0, 0.7, 0}, {0.9, 0, 0}, 4, 4);
  b.material(rho).rectangle({2.3, 1.9, 2.789}, {0.9, 0, 0}, {0, 0.7, 0}, 2, 2);
  return b.build();
}

TEST(Hierarchical, AFurnaceGlowsAlikeEverywhere) {
  for (const double rho : {0.0, 0.5, 0.99, 0.9999}) {
    const Room room(
        test::RoomWithBlocks{.room_cells = {6, 5, 4}, .block_cells = 2, .reflectance = rho, .exitance = 10}.build());
    const HierarchicalSolution h = room.solve({.residual = 1e-9});
    const double exact = 10 / (1 - rho);
    for (std::size_t i = 0; i < h.elements.patch_count(); ++i)
      ASSERT_NEAR(h.solution.B[i][0], exact, 1e-5 * exact) << "rho " << rho << ", residual over 1 - rho";
    EXPECT_NEAR(h.solution.energy.imbalance(), 0, 1e-5);
    EXPECT_EQ(h.elements.patch_count(), room.patches.patch_count()) << "nothing is worth halving";
  }
}

TEST(Hierarchical, ClosedRoomsKeepTheirEnergyAndMean) {
  for (const double rho : {0.3, 0.6, 0.9}) {
    const Room room(lamp_room(rho));
    const Runs r = runs(room, {});
    double emitted = 0;
    for (std::size_t i = 0; i < room.patches.patch_count(); ++i) emitted += room.patches.area[i] * room.patches.M[i][0];
    // One reflectance: mean E = emitted / ((1 - rho) A), and the imbalance is what the mean is off.
    const double exact = emitted / ((1 - rho) * room.patches.total_area());
    const Estimate imbalance = mean_of(r.imbalance), E = mean_of(r.mean);
    EXPECT_NEAR(imbalance.value, 0, 4 * imbalance.std_error) << "rho " << rho;
    EXPECT_NEAR(E.value, exact, 4 * E.std_error) << "rho " << rho;
  }
}

TEST(Hierarchical, ANearlyWhiteRoomConvergesInFewSweeps) {
  test::PatchBuilder b(0.9999);
  b.box({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, {0, 0, 3}, {8, 8, 6}, true);
  b.material(0.9999, 10).rectangle({2, 2, 2.5}, {0, 0.5, 0}, {0.5, 0, 0}, 2, 2);
  b.material(0.9999).rectangle({2, 2, 2.502}, {0.5, 0, 0}, {0, 0.5, 0}, 2, 2);
  const Room room(b.build());
  const HierarchicalSolution h = room.solve();
  EXPECT_LT(h.solution.iterations, 40);
  EXPECT_LE(h.solution.residual, 1e-5);
}

TEST(Hierarchical, TheSameBitsForOneAndTwoThreads) {
  const Room room(lamp_room(0.5));
  const HierarchicalSolution two = room.solve({.bundle_rays = 64, .bright_rays = 16});
  set_thread_count(1);
  const HierarchicalSolution one = room.solve({.bundle_rays = 64, .bright_rays = 16});
  set_thread_count(0);
  EXPECT_EQ(one.solution.E.value, two.solution.E.value);
  EXPECT_EQ(one.solution.B.value, two.solution.B.value);
  EXPECT_EQ(one.solution.energy.absorbed, two.solution.energy.absorbed);
}

TEST(Hierarchical, ATighterToleranceBringsTheWholeFieldNearerToTheTruth) {
  const Room room(lamp_room(0.5, 6));
  // The truth on elements that are finer than what either run makes: E of a point is that of the element it lies in.
  double last = 1;
  for (const double tolerance : {1e9, 0.3, 0.05}) {
    const HierarchicalSolution h =
        room.solve({.bundle_rays = 1024, .bright_rays = 256, .tolerance = tolerance, .shortest_edge = 0.1});
    ElementMesh fine(room.patches, room.map);
    for (int k = 0; k < 5; ++k) fine.split(fine.leaves());
    const PatchSet points = fine.leaf_patches();
    static const Solution truth = paths(room, points, 256);
    Solution shown = truth;
    for (std::size_t i = 0; i < points.patch_count(); ++i) {
      const auto c = points.corner_positions(PatchId{i});
      const Vec3 x = (c[0] + c[1] + c[2]) / 3;
      const Hit hit = room.rays.first_hit(h.elements, {x + points.normal[i] * 1e-4, -points.normal[i]});
      ASSERT_TRUE(hit.patch.valid());
      shown.E.set(i, h.solution.E[hit.patch]);
    }
    const Estimate error = rms_error(points, shown.E, truth);
    EXPECT_LT(error.value + 4 * error.std_error, last)
        << "tolerance " << tolerance << ", " << h.elements.patch_count() << " elements";
    last = error.value - 4 * error.std_error;
  }
}

TEST(Hierarchical, AgreesWithPaths) {
  const Room room(lamp_room(0.5));
  expect_agreement(room, runs(room, {}), paths(room, room.patches, 1024), HierarchyOptions{}.bright_rays,
                   constant_elements(0.5));
}

TEST(Hierarchical, ClassicRefinementAndTheFullMatrixAgree) {
  test::PatchBuilder b(0.6);
  b.box({0, 0, 0}, {3, 0, 0}, {0, 3, 0}, {0, 0, 3}, {4, 4, 4}, true);
  b.material(0.3, 5).box({1, 1, 1}, {0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}, {2, 2, 2}, false);
  const Room room(b.build());
  const Solution exact =
      gauss_seidel(room.patches, form_factor_matrix(room.patches, room.rays), Field(room.patches.patch_count(), 1));
  double last = 1, links = 0;
  for (const double tolerance : {30.0, 1.0, 0.03}) {
    const HierarchicalSolution h =
        room.solve({.oracle = Oracle::bf, .tolerance = tolerance, .shortest_edge = 10});  // none is halved
    ASSERT_EQ(h.elements.patch_count(), room.patches.patch_count());
    const double error = rms_error(room.patches, h.solution.E, exact).value;
    EXPECT_LT(error, last) << "tolerance " << tolerance;
    last = error;
    links = static_cast<double>(h.solution.links) / static_cast<double>(h.elements.patch_count());
  }
  // A link is known from 16 pairs, to a quarter where they are between nothing and twice their mean, and a receiver's
  // sum over its links better by the root of their number.
  EXPECT_LT(last, 0.25 / std::sqrt(links));
  const HierarchyOptions bundles{.bundle_rays = 1024, .tolerance = 1e9};
  expect_agreement(room, runs(room, bundles), exact, bundles.bright_rays, 0);
}

TEST(Hierarchical, ClassicRefinementTakesNoLightOfAClusterThatIsNotSeenOfIt) {
  // A sealed room whose outer faces glow: clusters hold these and the inner ones, which see each other only.
  test::PatchBuilder b(0.5);
  b.box({-3, -3, -3}, {6, 0, 0}, {0, 6, 0}, {0, 0, 6}, {4, 4, 4}, true);
  b.box({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {4, 4, 4}, true);
  b.material(0.5, 1000).box({-1.1, -1.1, -1.1}, {2.2, 0, 0}, {0, 2.2, 0}, {0, 0, 2.2}, {4, 4, 4}, false);
  const Room room(b.build());
  const Solution classic = room.solve({.oracle = Oracle::bf, .tolerance = 1, .shortest_edge = 10}).solution;
  for (std::size_t p = 0; p < room.patches.patch_count(); ++p) {
    const auto x = room.patches.corner_positions(PatchId{p});
    const Vec3 c = (x[0] + x[1] + x[2]) / 3 + room.patches.origin;
    if (std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)}) > 1.01) continue;
    EXPECT_LT(classic.E[p][0], 1) << p << ", chosen by area it would be more";
  }
}

TEST(Hierarchical, TheCeilingSpotAboveAnUplightIsFoundByItself) {
  // All light comes from a small uplight that nobody sees but the ceiling.
  test::PatchBuilder b(0.7);
  b.box({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, {0, 0, 2.8}, {12, 10, 7}, true);
  b.box({2.3, 1.8, 2.3}, {0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.05}, {2, 2, 1}, false);
  b.material(0.1, 2000).rectangle({2.4, 1.9, 2.3505}, {0.2, 0, 0}, {0, 0.2, 0}, 2, 2);
  const Room room(b.build());
  const HierarchicalSolution h = room.solve({.shortest_edge = 0.05});
  EXPECT_GT(h.elements.patch_count(), room.patches.patch_count()) << "the spot's edge is worth halving";
  expect_agreement(room, runs(room, {.shortest_edge = 0.05}), paths(room, room.patches, 1024),
                   HierarchyOptions{}.bright_rays, constant_elements(0.7));
}

TEST(Hierarchical, ASunPatchLightsTheRoomAndIsHalvedAlongItsEdge) {
  // A room with a hole of 0.5 m in its ceiling, sun straight through it: 0.25 m2 x 1000 W/m2 x cos.
  test::PatchBuilder b(0.5);
  const std::size_t n = 8;
  b.rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, n, n);
  b.rectangle({0, 0, 0}, {0, 4, 0}, {0, 0, 3}, n, 6).rectangle({4, 0, 0}, {0, 0, 3}, {0, 4, 0}, 6, n);
  b.rectangle({0, 0, 0}, {0, 0, 3}, {4, 0, 0}, 6, n).rectangle({0, 4, 0}, {4, 0, 0}, {0, 0, 3}, n, 6);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < n; ++i)
      if (i != 4 || j != 4) {
        const double x = 0.5 * static_cast<double>(i), y = 0.5 * static_cast<double>(j);
        b.rectangle({x, y, 3}, {0, 0.5, 0}, {0.5, 0, 0});
      }
  Sun sun;
  sun.direction = normalized({0.1, 0.23, 1});
  sun.normal_irradiance = Spectrum(1000);
  Lights lights;
  lights.suns.push_back({sun});
  const Room room(b.build(), lights);
  EXPECT_GT(room.solve({.shortest_edge = 0.05}).elements.patch_count(), room.patches.patch_count() + 50);
  const Runs r = runs(room, {.shortest_edge = 0.05});
  const Estimate direct = mean_of(r.direct), imbalance = mean_of(r.imbalance);
  EXPECT_NEAR(direct.value, 0.25 * 1000 * sun.direction.z, 4 * direct.std_error) << "straddling elements keep it";
  EXPECT_NEAR(imbalance.value, 0, 4 * imbalance.std_error);
  expect_agreement(room, r, paths(room, room.patches, 1024), HierarchyOptions{}.bright_rays, constant_elements(0.5));
}

TEST(Hierarchical, AnOpenFloorTakesTheWholeSky) {
  test::PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 4, 4);
  Lights lights;
  lights.sky = Sky{};
  lights.sky->model = SkyModel::uniform;
  lights.sky->horizontal_irradiance = Spectrum(100);
  const HierarchicalSolution h = Room(b.build(), lights).solve();
  for (std::size_t i = 0; i < h.elements.patch_count(); ++i) EXPECT_NEAR(h.solution.E[i][0], 100, 1e-9 * 100);
  EXPECT_NEAR(h.solution.energy.emitted, 100, 1e-9 * 100);
  EXPECT_NEAR(h.solution.energy.escaped, 50, 1e-6 * 50);
  EXPECT_NEAR(h.solution.energy.imbalance(), 0, 1e-6);
}

TEST(Hierarchical, StoppedBeforeItsFirstRoundItGivesTheAmbientEstimateAndSaysSo) {
  const Room room(lamp_room(0.5, 6));
  const std::atomic<bool> stop{true};
  Monitor monitor;
  monitor.interrupted = [&] { return stop.load(); };
  const HierarchicalSolution h = room.solve({}, monitor);
  EXPECT_EQ(h.solution.stop, StopReason::interrupted);
  ASSERT_EQ(h.solution.E.size(), h.elements.patch_count());
  EXPECT_GT(mean(h.elements, h.solution.E), 0);
  ASSERT_FALSE(h.solution.log.empty());
  EXPECT_NE(h.solution.log[0].find("ambient"), std::string::npos) << h.solution.log[0];
}

TEST(Hierarchical, StoppedAfterElementsWereHalvedTheHalvesShowWhatWasFoundForTheWhole) {
  const Room room(lamp_room(0.5, 6));
  ElementMesh mesh(room.patches, room.map);
  const std::size_t before = mesh.leaf_count();
  std::atomic<bool> stop = false;
  Monitor monitor;
  monitor.interrupted = [&] { return stop.load(); };
  monitor.progress = [&](std::string_view, double) { stop = mesh.leaf_count() > before; };
  const HierarchicalSolution h = hierarchical(room.problem, mesh, {}, monitor);
  ASSERT_GT(mesh.leaf_count(), before);
  ASSERT_EQ(h.solution.stop, StopReason::interrupted);
  ASSERT_EQ(h.elements.patch_count(), mesh.leaf_count());
  ASSERT_EQ(h.solution.E.size(), mesh.leaf_count());
  ASSERT_EQ(h.solution.B.size(), mesh.leaf_count());
  for (std::size_t i = 0; i < mesh.leaf_count(); ++i)
    EXPECT_NEAR(h.solution.B[i][0], h.elements.M[i][0] + h.elements.rho[i][0] * h.solution.E[i][0], 1e-9) << i;
}

TEST(Hierarchical, WithADeadlineThatIsPastItStillHasALight) {
  const Room room(lamp_room(0.5, 6));
  Monitor monitor;
  monitor.deadline = std::chrono::steady_clock::now();
  const HierarchicalSolution h = room.solve({}, monitor);
  EXPECT_EQ(h.solution.stop, StopReason::time_limit);
  EXPECT_GT(mean(h.elements, h.solution.E), 0);
}

}  // namespace
}  // namespace clerestory
