// Many faces in one place. Their pairs grow with the square of their number: meshed in time that goes by the number,
// or refused with a reason. At these sizes the square takes minutes, which the time limit of the suite tells, or
// gigabytes.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "meshing/build_patches.h"
#include "meshing/triangulate_polygon.h"
#include "solver/model/error.h"
#include "solver/model/random_stream.h"
#include "tests/meshing/mesh_checks.h"

namespace clerestory {
namespace {

using namespace testing;

constexpr double kPi = std::numbers::pi;

std::string refusal(SceneMaker& maker) {
  try {
    build_patches(maker.scene(), {.max_element = 100});
    return "(it was meshed)";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// n corners on a circle, each joined to the one most opposite to it.
std::vector<Vec3> star(int n) {
  std::vector<Vec3> corners;
  for (int k = 0; k < n; ++k) {
    const double phi = 2 * kPi * k * (n / 2) / n;
    corners.push_back({std::cos(phi), std::sin(phi), 0});
  }
  return corners;
}

/// A number in [0, 1).
double random(std::uint64_t n) { return static_cast<double>(stream_key(1, 2, n) >> 11) * 0x1p-53; }

TEST(Crowded, APolygonThatCrossesItselfAFewTimesIsCutWhereItDoes) {
  const PolygonTriangles pieces = triangulate_polygon(star(51));
  EXPECT_FALSE(pieces.gave_up);
  EXPECT_EQ(pieces.crossings.size(), 51u * 48 / 2) << "each side of the star meets all but three";
}

TEST(Crowded, APolygonThatCrossesItselfMillionsOfTimesIsRefused) {
  SceneMaker maker;
  maker.polygon(star(6001));
  EXPECT_NE(refusal(maker).find("face 0 (from 0), of 'grey surface', with 6001 corners crosses itself"),
            std::string::npos);
}

TEST(Crowded, PolygonsThatCrossThemselvesHaveOneBudget) {
  SceneMaker maker;
  maker.polygon({{0, 0, 1}, {3, 0, 1}, {3, 3, 1}});
  for (int k = 0; k < 3000; ++k) {
    std::vector<Vec3> corners = star(101);
    for (Vec3& p : corners) p += Vec3{3.0 * (k % 50), 3.0 * (k / 50), 0};
    maker.polygon(corners);
  }
  EXPECT_NE(refusal(maker).find("polygons of the model cross themselves in more than"), std::string::npos);
}

TEST(Crowded, LongCombsAndSpiralsAreTriangulated) {
  constexpr int kTeeth = 40'000;
  std::vector<Vec3> comb{{0, 0, 0}};
  for (int k = 0; k < kTeeth; ++k) comb.insert(comb.end(), {{k * 1.0, 1000, 0}, {k + 0.5, 1, 0}});
  comb.push_back({kTeeth, 0, 0});
  EXPECT_EQ(triangulate_polygon(comb).triangles.size(), comb.size() - 2);
  std::vector<Vec3> spiral;
  for (const double wide : {0.0, 0.5})
    for (int k = 0; k < kTeeth; ++k) {
      const double phi = kPi / 180 * (wide == 0 ? k : kTeeth - 1 - k), r = 1 + phi / (2 * kPi) + wide;
      spiral.push_back({r * std::cos(phi), r * std::sin(phi), 0});
    }
  EXPECT_EQ(triangulate_polygon(spiral).triangles.size(), spiral.size() - 2);
}

TEST(Crowded, RowsOfPointsAreDrawnInTimeThatGoesByTheirNumber) {
  // Each row's first point sees all of the row before.
  constexpr int kPoints = 100'000;
  SceneMaker maker;
  std::vector<Vec3> zigzag;
  for (const double z : {0.0, 0.7})
    for (int k = 0; k < kPoints / 2; ++k) {
      const int i = z == 0 ? k : kPoints / 2 - 1 - k;
      zigzag.push_back({1e-3 * i, 0.5 * (i % 2) + z, 0});
    }
  maker.polygon(zigzag);
  EXPECT_EQ(triangulate_polygon(zigzag).triangles.size(), zigzag.size() - 2);
  const MeshedScene meshed = build_patches(maker.scene(), {.max_element = 100});
  EXPECT_NEAR(surface_area(meshed.patches), 0.7 * 1e-3 * (kPoints / 2 - 1), 1e-6)
      << "corners on a grid of 2^-32 x 60 m";
}

TEST(Crowded, CoincidentFacesOfManyMaterialsAreOneRegion) {
  constexpr int kFaces = 60'000;
  SceneMaker maker;
  for (int k = 0; k < kFaces; ++k) maker.polygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, maker.material("m"));
  const MeshedScene meshed = build_patches(maker.scene(), {.max_element = 100});
  EXPECT_EQ(meshed.report.planar_regions, 1u);
  EXPECT_EQ(meshed.report.overlapping_regions, 1u);
  EXPECT_NEAR(surface_area(meshed.patches), 0.5, 1e-8);
}

TEST(Crowded, FacesOfOnePlaneThatAllLieInEachOtherAreCutApart) {
  // Concentric squares: each lies in all that are larger, and no edges cross.
  constexpr int kFaces = 20'000;
  SceneMaker maker;
  const MaterialId white = maker.material("white");
  for (int k = 1; k <= kFaces; ++k) {
    const double r = k;
    maker.polygon({{-r, -r, 0}, {r, -r, 0}, {r, r, 0}, {-r, r, 0}}, k % 2 ? white : MaterialId{std::size_t{0}});
  }
  EXPECT_NE(refusal(maker).find("hand-made: of its 40000 faces more than "), std::string::npos);
}

TEST(Crowded, FacesThatAllCrossEachOtherAreRefused) {
  for (const std::uint64_t count : {1000u, 4000u}) {
    SceneMaker maker;
    for (std::uint64_t k = 0; k < count; ++k) {
      std::vector<Vec3> corners;
      for (std::uint64_t c = 0; c < 3; ++c) {
        const std::uint64_t n = 9 * k + 3 * c;
        corners.push_back({random(n), random(n + 1), random(n + 2)});
      }
      maker.polygon(corners);
    }
    const std::string said = refusal(maker);
    EXPECT_NE(said.find("the most for a model of that size"), std::string::npos) << said;
  }
}

TEST(Crowded, FacesThatAlmostCoincideAreRefused) {
  SceneMaker maker;
  for (std::uint64_t k = 0; k < 12'000; ++k) {
    const auto z = [&](std::uint64_t c) { return 1e-4 * random(3 * k + c); };
    maker.polygon({{0, 0, z(0)}, {1, 0, z(1)}, {0, 1, z(2)}});
  }
  const std::string said = refusal(maker);
  EXPECT_NE(said.find("pairs of faces touch by their boxes"), std::string::npos) << said;
}

TEST(Crowded, SquaresAlongADiagonalAreRefused) {
  SceneMaker maker;  // all their diagonals lie on one line, with all their corners
  for (int k = 0; k < 30'000; ++k) {
    const double a = k * 1e-4, b = 1 + a;
    maker.polygon({{a, a, 0}, {b, a, 0}, {b, b, 0}, {a, b, 0}});
  }
  const std::string said = refusal(maker);
  EXPECT_NE(said.find("the most for a model of that size"), std::string::npos) << said;
}

TEST(Crowded, AFanOfAThousandFacesAroundACornerIsMeshed) {
  constexpr int kFaces = 1000;
  SceneMaker maker;
  const auto rim = [](int k) { return Vec3{std::cos(2 * kPi * k / kFaces), std::sin(2 * kPi * k / kFaces), 0}; };
  for (int k = 0; k < kFaces; ++k) {
    maker.polygon({{0, 0, 0}, rim(k), rim(k + 1)});
    maker.polygon({{0, 0, 1}, rim(k + 1), rim(k)});
  }
  const MeshedScene meshed = build_patches(maker.scene(), {.max_element = 100});
  // Regular polygon of n corners, and a cone over it whose faces are sqrt(1 + cos2(pi/n)) high.
  const double base = kFaces / 2.0 * std::sin(2 * kPi / kFaces);
  const double cone = kFaces * std::sin(kPi / kFaces) * std::hypot(1, std::cos(kPi / kFaces));
  EXPECT_NEAR(surface_area(meshed.patches), base + cone, 1e-6) << "corners on a grid of 2^-32, 1000 needles";
}

TEST(Crowded, BoxesOnOneFloorCostWhatTheirNumberDoes) {
  constexpr int kSide = 70;
  SceneMaker maker;
  maker.polygon({{-1, -1, 0}, {2 * kSide, -1, 0}, {2 * kSide, 2 * kSide, 0}, {-1, 2 * kSide, 0}});
  for (int k = 0; k < kSide * kSide; ++k) {
    const double x = 2.0 * (k % kSide), y = 2.0 * (k / kSide);
    maker.box({x, y, 0}, {x + 1, y + 1, 1});
  }
  const MeshedScene meshed = build_patches(maker.scene(), {.max_element = 100});
  const double floor = (2.0 * kSide + 1) * (2.0 * kSide + 1);
  EXPECT_NEAR(surface_area(meshed.patches), floor + 5.0 * kSide * kSide, 1e-6 * floor);
}

TEST(Crowded, ASmallModelBesideAStrayFaceFarAwayCostsWhatItWouldAlone) {
  constexpr int kSide = 120;
  SceneMaker maker;
  maker.polygon({{1e9, 0, 0}, {1e9, 1, 0}, {1e9, 0, 1}});
  for (int k = 0; k < kSide * kSide; ++k) {
    const int place = k * 7919 % (kSide * kSide);  // in no order
    const double x = 2.0 * (place % kSide), y = 2.0 * (place / kSide);
    maker.box({x, y, 0}, {x + 1, y + 1, 1});
  }
  // The grid of 2^-32 is 0.2 m then: nothing is promised of the boxes but an end.
  EXPECT_GT(build_patches(maker.scene(), {.max_element = 1e9}).patches.triangle_count(), 0u);
}

}  // namespace
}  // namespace clerestory
