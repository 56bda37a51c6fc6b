#include "solver/gather/gather.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/evaluate/measured_error.h"
#include "solver/form_factors/point_to_polygon.h"
#include "solver/gather/gather_point.h"
#include "solver/gather/gather_time.h"
#include "solver/model/random_stream.h"
#include "solver/paths/path_tracer.h"
#include "solver/run/accuracy.h"
#include "solver/run/level_in_time.h"
#include "tests/support/gather_quality.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;

/// Everything has the exitance 3 and the reflectance 1/2: B = E = 6 everywhere.
struct Furnace {
  static PatchSet glowing() {
    test::RoomWithBlocks room = test::room_of_2160_patches();
    room.exitance = 3;
    return room.build();
  }
  PatchSet patches = glowing();
  RayScene rays{patches};
  Lights none{};
  Problem problem{patches, rays, none};
};

TEST(GatherPoint, IsExactInAFurnace) {
  const Furnace furnace;
  const auto& [patches, rays, none, problem] = furnace;
  Field B(patches.patch_count(), 1);
  for (double& b : B.value) b = 6;
  unsigned long long traced = 0;
  const Spectrum E = gather_point(Illumination(problem, B), {0.5, 0.5, rays.lift()}, {0, 0, 1},
                                  GatherPattern(test::gather_quality(), 1), traced)
                         .E;
  EXPECT_NEAR(E[0], 6, 1e-9);
}

TEST(GatherPoint, OfASmallLampAndASmallWindowHasNoBias) {
  // A dark room open to the sky by a slot, with a lamp of 12 cm under the ceiling: the mean of many gathers must be
  // the exact irradiance, from the closed forms of both rectangles (Howell C-14: sum of four corner rectangles).
  PatchBuilder b(0.0);
  b.material(0.0, 1000).rectangle({1, 1, 1}, {0, 0.12, 0}, {0.12, 0, 0});
  b.material(0.0, 0);
  b.rectangle({-3, -3, 2}, {0, 8, 0}, {3, 0, 0}).rectangle({0.05, -3, 2}, {0, 8, 0}, {6, 0, 0});  // slot of 5 cm in x
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights;
  lights.sky = Sky{SkyModel::uniform, Spectrum(100), 0.0};
  const Problem problem{patches, rays, lights};
  const Illumination light(problem);
  Field B(patches.patch_count(), 1);
  for (std::size_t i = 0; i < B.size(); ++i) B.set(i, patches.M[i]);
  const Vec3 p{0.4, 0.3, 0}, n{0, 0, 1};
  double sum = 0, squares = 0;
  constexpr int kRepeats = 400;
  unsigned long long traced = 0;
  for (std::uint64_t k = 0; k < kRepeats; ++k) {
    const GatherPattern pattern(test::gather_quality({16, 256, 512}, 32), stream_key(8, k));
    const double E = gather_point(Illumination(problem, B), p, n, pattern, traced).E[0];
    sum += E, squares += E * E;
  }
  const double estimate = sum / kRepeats;
  const double std_error = std::sqrt((squares / kRepeats - estimate * estimate) / kRepeats);
  unsigned long long path_rays = 0;
  const PathEstimate paths = trace_paths_at_point(light, p, n, 5, 1 << 20, path_rays);
  EXPECT_NEAR(estimate, paths.E[0], 4 * std::hypot(std_error, paths.std_error[0]));
  EXPECT_LT(std_error, 0.01 * estimate);
  EXPECT_LT(paths.std_error[0], 0.005 * estimate);
}

/// A floor, a black plate 0.1 m above it up to x = 0, and a wall at x = 1 that glows: from under the plate a strip of
/// it.
struct UnderAPlate {
  static PatchSet build() {
    PatchBuilder b(0.0);
    b.material(0.0, 1000).rectangle({1, -3, 0}, {0, 0, 1}, {0, 6, 0});
    b.material(0.0, 0).rectangle({-2, -50, 0.1}, {0, 100, 0}, {2, 0, 0});
    return b.build();
  }
  PatchSet patches = build();
  RayScene rays{patches};
  Lights none{};
  Problem problem{patches, rays, none};
  Vec3 p{-0.3, 0, 0}, n{0, 0, 1};
  double E = 0;  ///< what is seen of the wall ends where the line over the plate's edge meets it

  UnderAPlate() {
    const double top = 0.1 / 0.3 * 1.3;
    const std::array<Vec3, 4> seen{Vec3{1, -3, 0}, {1, -3, top}, {1, 3, top}, {1, 3, 0}};
    E = 1000 * std::abs(point_to_polygon(p, n, seen));
  }
  static constexpr int kRepeats = 100;
  struct Estimate {
    double mean = 0, spread = 0;
  };
  Estimate gather(double noise) const {
    GatherQuality quality = test::gather_quality({16, 256, 1024}, 0);
    quality.noise = noise;
    const Illumination light(problem, patches.M);
    double sum = 0, squares = 0;
    unsigned long long traced = 0;
    for (std::uint64_t k = 0; k < kRepeats; ++k) {
      const double found =
          gather_point(light, p, n, GatherPattern(quality, stream_key(3, k)), GatherPlan{}, traced).E[0];
      sum += found, squares += found * found;
    }
    return {sum / kRepeats, std::sqrt(squares / kRepeats - sum * sum / kRepeats / kRepeats)};
  }
};

TEST(GatherPoint, IsGatheredAnewWithMoreRaysWhereItIsNoisy) {
  const UnderAPlate place;
  const auto plain = place.gather(1), sharp = place.gather(0.05);
  EXPECT_LT(sharp.spread, 0.5 * plain.spread);
  EXPECT_NEAR(sharp.mean, place.E, 4 * sharp.spread / std::sqrt(UnderAPlate::kRepeats));
}

TEST(MeasuredError, IsNothingForAnExactFieldAndFindsAFieldThatIsFivePerCentTooBright) {
  const Furnace furnace;
  const auto& [patches, rays, none, problem] = furnace;
  VertexLightmap lightmap;  // three points a patch are as good as any
  for (std::size_t i = 0; i < patches.patch_count(); ++i)
    lightmap.corners.push_back({static_cast<std::uint32_t>(3 * i), static_cast<std::uint32_t>(3 * i + 1),
                                static_cast<std::uint32_t>(3 * i + 2)});
  lightmap.E = Field(3 * patches.patch_count(), 1);
  Solution solution;
  solution.rays = 5'000'000;
  solution.E = solution.B = Field(patches.patch_count(), 1);
  for (double& E : solution.E.value) E = 6;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) solution.B.set(i, patches.M[i] + patches.rho[i] * 6);
  for (const double factor : {1.0, 1.05}) {
    for (double& E : lightmap.E.value) E = 6 * factor;
    const MeasuredError error = measure_error(problem, lightmap, solution, effort(Accuracy::standard).error, 1);
    EXPECT_GE(error.samples, 256u);
    EXPECT_NEAR(error.rms_relative, factor - 1, std::max(error.confidence, 0.005)) << factor;
    EXPECT_LT(error.confidence, 0.02);
  }
}

TEST(QualityInTime, IsTheFirstThatTimeIsEnoughForOrTheLast) {
  const Furnace furnace;
  const Field B(furnace.patches.patch_count(), 1);
  const Illumination light = gather_illumination(furnace.problem, B);
  const auto floor = [](std::size_t) { return ReceivingPoint{{0.5, 0.5, 1e-6}, {0, 0, 1}}; };
  const std::vector<GatherQuality> qualities{effort(Accuracy::standard).vertices, effort(Accuracy::draft).vertices};
  const auto rays_in = [&](double seconds) {
    return quality_in_time(light, {1000, floor}, qualities, seconds, 1).bundle.rays;
  };
  EXPECT_EQ(rays_in(1e6), qualities[0].bundle.rays);
  EXPECT_EQ(rays_in(0), qualities[1].bundle.rays);
  EXPECT_GT(seconds_a_gather(light, {1000, floor, qualities[0]}, 1), 0);
  EXPECT_EQ(seconds_a_gather(light, {0, floor, qualities[0]}, 1), 0);
}

TEST(LevelsInTime, AreTheFinestThatTimeIsEnoughFor) {
  const Furnace furnace;
  Solution solution;
  solution.B = Field(furnace.patches.patch_count(), 1);
  VertexLightmap points;
  points.sample_position = {{0.5, 0.5, 0}}, points.sample_normal = {{0, 0, 1}};
  const auto levels = [&](double left, Accuracy at_most) {
    return levels_in_time({furnace.problem, solution, points, {}, 10, left, at_most, 1});
  };
  EXPECT_EQ(levels(1e6, Accuracy::fine).from_the_start, Accuracy::fine);
  EXPECT_EQ(levels(1e6, Accuracy::standard).from_the_start, Accuracy::standard);
  // A draft's elements took ten seconds: a standard's take more than those that are left, one point's gather does not.
  EXPECT_EQ(levels(10, Accuracy::standard).from_the_start, Accuracy::draft);
  EXPECT_EQ(levels(10, Accuracy::standard).from_here, Accuracy::standard);
  EXPECT_EQ(levels(0, Accuracy::fine).from_here, Accuracy::draft);
}

}  // namespace
}  // namespace clerestory
