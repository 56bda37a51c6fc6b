#include "solver/lights/luminaire_view.h"

#include <cmath>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/illumination/direct.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/model/random_stream.h"
#include "tests/support/luminaires.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

using test::PatchBuilder;
constexpr double kPi = std::numbers::pi;

/// 4/3, 1 and 5/6 of `size` [m], seen from inside.
PatchSet room(double size, std::size_t cells) {
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {size * 4 / 3, 0, 0}, {0, size, 0}, {0, 0, size * 5 / 6}, {cells, cells, cells}, true);
  return b.build();
}

PlacedLuminaire web_lamp(const Vec3& position, const Vec3& aim, const Vec3& opening) {
  PhotometricWeb web;
  for (double v = 0; v <= 90; v += 2.5) web.vertical.push_back(v);
  web.horizontal = {0};
  for (const double v : web.vertical) web.candela.push_back(static_cast<float>(std::cos(v * kPi / 180)));
  web.opening.size = opening;
  web.flux = luminous_flux(web);
  return {{"lamp",
           position,
           {},
           WebLuminaire{std::make_shared<const PhotometricWeb>(std::move(web)), aimed(WebType::C, aim, 20),
                        Spectrum(1.0)}}};
}

/// Flux from q to all patches that do not stand behind each other.
double flux_to_all(const PatchSet& patches, const Luminaire& luminaire, const Vec3& q) {
  const Beam beam = beam_of(luminaire);
  double sum = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const auto corners = patches.corner_positions(PatchId{i});
    sum += LuminaireView(luminaire, beam, corners, patches.normal[i]).look_from(q);
  }
  return sum;
}

TEST(LuminaireView, AnEvenLampSendsItsWholeFluxToAClosedRoomHoweverNearItsWalls) {
  for (const double size : {1.0, 1e3})
    for (const double d : {1e-6, 1e-3, 0.1, 0.5})
      for (const Vec3& q : {Vec3{0.43 * size, d, 0.31 * size}, Vec3{d, d, d}, Vec3{0.5, 0.5, 0.5 * d}}) {
        const Luminaire lamp = test::point_lamp(q, 70);
        // Solid angles of triangles that are all but planes through q: 1e-16 / 1e-9 at worst.
        EXPECT_NEAR(flux_to_all(room(size, 3), lamp, q) / 70, 1, 1e-6) << size << " " << d;
      }
}

TEST(LuminaireView, BeamsOfAnyWidthSendTheirWholeFluxToFewLargeTriangles) {
  const Vec3 q{300, 0.01, 400};
  for (const Vec3& aim : {Vec3{0, -1, 0}, Vec3{1, 0, 0}, normalized({0.3, 1, -0.4})}) {
    for (const double half_angle : {0.02, 0.3, 1.2}) {
      const Luminaire spot = test::spot_lamp(q, aim, 10, 0.9 * half_angle, half_angle);
      EXPECT_NEAR(flux_to_all(room(1e3, 1), spot, q) / power(spot)[0], 1, 2e-3) << half_angle;
    }
    const Luminaire web = web_lamp(q, aim, {});
    EXPECT_NEAR(flux_to_all(room(1e3, 1), web, q) / power(web)[0], 1, 1e-3);
  }
}

TEST(LuminaireView, PointsLieWhereTheLightFalls) {
  // An even lamp 1 um above a triangle of metres: half of the light below it falls within a cone of 60 degrees.
  const std::array<Vec3, 3> floor{Vec3{-2, -2, 0}, {3, -2, 0}, {-2, 3, 0}};
  const double h = 1e-6;
  const Luminaire lamp = test::point_lamp({0.1, 0.2, h}, 1);
  const Beam beam = beam_of(lamp);
  LuminaireView view(lamp, beam, floor, {0, 0, 1});
  EXPECT_NEAR(view.look_from(lamp.position), 0.5, 1e-5);
  int within = 0;
  constexpr int kPoints = 4096;
  for (std::uint32_t k = 0; k < kPoints; ++k) {
    const auto u = sobol4(k, 5);
    const Vec3 p = view.lit_point(u[0], u[1]);
    EXPECT_EQ(p.z, 0);
    within += length(p - Vec3{0.1, 0.2, 0}) < h * std::sqrt(3.0);
  }
  EXPECT_NEAR(within / double{kPoints}, 0.5, 0.02);  // stratified: better than 1 / sqrt(4096)
}

/// Flux that arrives of the lamp's, by direct_light().
double arrived(const PatchSet& patches, PlacedLuminaire lamp) {
  const double flux = power(lamp)[0];
  const RayScene rays(patches);
  Lights lights;
  lights.luminaires.push_back(std::move(lamp));
  find_near_planes(lights, patches, rays);
  const DirectLight direct = direct_light(Illumination({patches, rays, lights}), {});
  EXPECT_NEAR(direct.energy.absorbed + direct.energy.escaped, 0, 1e-9);
  double sum = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) sum += patches.area[i] * direct.E[i][0];
  return sum / flux;
}

TEST(DirectLight, OfALampIsItsWholeFluxFromAMicrometreOffTheWallOn) {
  for (const double size : {1.0, 30.0, 1e3})
    for (const double d : {1e-6, 1e-4, 1e-2, 0.3})
      for (const Vec3& q : {Vec3{0.43 * size, d, 0.31 * size}, Vec3{d, d, d}}) {
        SCOPED_TRACE(testing::Message() << size << " m, " << d << " off, x = " << q.x);
        const PatchSet patches = room(size, 12);
        EXPECT_NEAR(arrived(patches, test::point_lamp(q, 70)), 1, 1e-3);  // 16 points on each patch farther off
        if (q.x > d) {
          EXPECT_NEAR(arrived(patches, web_lamp(q, {0, -1, 0}, {})), 1, 1e-3);
          EXPECT_NEAR(arrived(patches, web_lamp(q, {0, 1, 0}, {0.3, 0.2, 0})), 1, 2e-3);  // 256 points of an opening
        }
      }
}

TEST(DirectLight, OfALampCloseAboveATableIsCutOffByIt) {
  // 1 cm above a table in a hall of 1 km: what goes down stays on the table, half of the light.
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {1e3, 0, 0}, {0, 1e3, 0}, {0, 0, 300}, {20, 20, 6}, true);
  b.rectangle({400, 400, 0.75}, {2, 0, 0}, {0, 2, 0}).rectangle({400, 400, 0.75}, {0, 2, 0}, {2, 0, 0});
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({401, 401, 0.76}, 70));
  find_near_planes(lights, patches, rays);
  const DirectLight direct = direct_light(Illumination({patches, rays, lights}), {});
  double table = 0, all = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double flux = patches.area[i] * direct.E[i][0];
    all += flux;
    if (patches.corner_positions(PatchId{i})[0].z == 0.75) table += flux;
  }
  // The square of 100 heights to each side leaves less than 1 % of the half-space below.
  EXPECT_NEAR(table / 70, 0.5, 0.01);
  EXPECT_NEAR(all / 70, 1, 2e-3);
}

TEST(NearPlanes, ARecessedLampShinesToEitherSideAndGivesItsPlaneNothing) {
  PatchBuilder b(0.5);
  b.rectangle({0, 0, 3}, {0, 4, 0}, {4, 0, 0}, 4, 4).rectangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, 4, 4);
  b.rectangle({0, 0, 5}, {0, 4, 0}, {4, 0, 0}, 4, 4);
  const PatchSet patches = b.build();
  const RayScene rays(patches);
  Lights lights;
  lights.luminaires.push_back(test::point_lamp({2.1, 2.2, 3}, 70));
  find_near_planes(lights, patches, rays);
  ASSERT_EQ(lights.luminaires[0].near_planes.size(), 1u);
  EXPECT_TRUE(lights.luminaires[0].near_planes[0].is_mount);
  const DirectLight direct = direct_light(Illumination({patches, rays, lights}), {});
  double ceiling = 0, floor = 0, roof = 0;
  for (std::size_t i = 0; i < patches.patch_count(); ++i) {
    const double z = patches.corner_positions(PatchId{i})[0].z;
    (z == 3 ? ceiling : z == 0 ? floor : roof) += patches.area[i] * direct.E[i][0];
  }
  EXPECT_EQ(ceiling, 0);
  // Solid angles of squares of 4 m: 4 asin(4 / 13) below the lamp and 4 asin(1 / 2) above it, nearly in the middle.
  EXPECT_NEAR(floor, 70 * std::asin(4.0 / 13) / kPi, 0.1);
  EXPECT_NEAR(roof, 70 * std::asin(0.5) / kPi, 0.1);
}

TEST(NearPlanes, RoundingOfAModelsFloatsLeavesADownlightInItsCeiling) {
  // The ceiling of a file with floats is at 2.8f, 5e-8 below the lamp at 2.8: the lamp still lights the room.
  PatchBuilder b(0.5);
  b.box({0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, double{2.8f}}, {8, 8, 6}, true);
  ASSERT_LT(double{2.8f}, 2.8);
  EXPECT_NEAR(arrived(b.build(), web_lamp({2, 2, 2.8}, {0, 0, -1}, {})), 1, 2e-3);
}

}  // namespace
}  // namespace clerestory
