#include "pipeline/panel_hints.h"

#include <array>

#include <gtest/gtest.h>

#include "pipeline/prepare.h"

namespace clerestory {
namespace {

/// A room of 4 x 4 x 3 m of one-sheet walls that face inwards, in which things hang.
class Panels : public ::testing::Test {
 protected:
  Panels() {
    scene_.file = "room";
    scene_.materials.resize(2);
    scene_.materials[0].name = "wall";
    scene_.materials[1].name = "panel";
    scene_.materials[1].exitance = Spectrum(50.0);
    scene_.surfaces = {"all"};
    box({0, 0, 0}, {4, 4, 3}, 0, true);
  }
  void face(std::array<Vec3, 4> corners, std::size_t material) {
    for (const Vec3& p : corners) {
      scene_.polygons.add_corner(static_cast<std::uint32_t>(scene_.polygons.vertices.size()));
      scene_.polygons.add_vertex(p);
    }
    scene_.polygons.end_face(MaterialId{material}, SurfaceId{std::size_t{0}});
  }
  void box(const Vec3& a, const Vec3& b, std::size_t material, bool inwards) {
    const auto at = [&](int i) { return Vec3{i & 1 ? b.x : a.x, i & 2 ? b.y : a.y, i & 4 ? b.z : a.z}; };
    for (const auto& f :
         {std::array{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}) {
      if (inwards)
        face({at(f[0]), at(f[1]), at(f[2]), at(f[3])}, material);
      else
        face({at(f[3]), at(f[2]), at(f[1]), at(f[0])}, material);
    }
  }
  /// A square of 0.6 m at height z.
  void panel(double z, bool faces_down) {
    const Vec3 a{1.5, 1.5, z}, b{2.1, 1.5, z}, c{2.1, 2.1, z}, d{1.5, 2.1, z};
    if (faces_down)
      face({a, d, c, b}, 1);
    else
      face({a, b, c, d}, 1);
  }
  std::vector<std::string> hints(int sides) {
    scene_.materials[1].sides = sides;
    StageSeconds seconds;
    const auto prepared = prepare(scene_, {}, {}, seconds);
    return hints_about_panels(prepared->problem());
  }

  Scene scene_;
};

TEST_F(Panels, OfOneSideUnderTheCeilingMustFaceTheRoom) {
  panel(2.99, false);
  const std::vector<std::string> wrong = hints(1);
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_EQ(wrong[0],
            "material 'panel' shines away from the room behind it: its lit side sees 'wall', 10.0 mm "
            "away. Turn its faces round, or leave out \"sides\": 1.");
}

TEST_F(Panels, OfOneSideThatFaceTheRoomAreRight) {
  panel(2.99, true);
  EXPECT_TRUE(hints(1).empty());
}

TEST_F(Panels, OfTwoSidesUnderTheCeilingSpendHalfOfTheirLightThere) {
  panel(2.995, true);
  const std::vector<std::string> wrong = hints(2);
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_TRUE(
      wrong[0].starts_with("material 'panel' shines from both sides, and one of them sees 'wall', 5.0 mm away: "
                           "half of its light is spent there."))
      << wrong[0];
}

TEST_F(Panels, InARoomThatIsWoundOutwardsAreToldByWhatIsClose) {
  scene_.polygons = {};
  box({0, 0, 0}, {4, 4, 3}, 0, false);
  panel(2.99, false);
  EXPECT_EQ(hints(1).size(), 1u);
  EXPECT_EQ(hints(2).size(), 1u);
}

TEST_F(Panels, BehindADiffuserAreRight) {
  scene_.materials.push_back(scene_.materials[0]);
  scene_.materials[2].name = "opal", scene_.materials[2].kind = MaterialKind::diffuser;
  scene_.materials[2].transmittance = Spectrum(0.4);
  panel(2.2, true);
  face({Vec3{1.4, 1.4, 2.17}, {1.4, 2.2, 2.17}, {2.2, 2.2, 2.17}, {2.2, 1.4, 2.17}}, 2);
  EXPECT_TRUE(hints(1).empty());
}

TEST_F(Panels, OfWhichSomeAreWrongAreNamedWithTheirShare) {
  panel(2.99, false);
  for (const double y : {0.2, 1.0, 2.9})
    face({Vec3{0.3, y, 2.99}, {0.3, y + 0.6, 2.99}, {0.9, y + 0.6, 2.99}, {0.9, y, 2.99}}, 1);
  const std::vector<std::string> wrong = hints(1);
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_TRUE(wrong[0].starts_with("material 'panel', in some 25 % of its area, shines away")) << wrong[0];
}

TEST_F(Panels, ThatHangFreeAreRightHoweverTheyShine) {
  panel(2.6, false);  // at the ceiling on purpose
  EXPECT_TRUE(hints(1).empty());
  EXPECT_TRUE(hints(2).empty());
}

TEST_F(Panels, InTheFaceOfASolidMustNotShineIntoIt) {
  box({0.5, 0.5, 2.5}, {3.5, 3.5, 2.9}, 0, false);  // a suspended ceiling of 40 cm
  panel(2.5, false);                                // in the plane of its lower face
  EXPECT_EQ(hints(1).size(), 1u);
}

TEST_F(Panels, ThatAreTheClosedBodyOfALampAreRight) {
  box({1.5, 1.5, 2.0}, {1.9, 1.9, 2.03}, 1, false);
  EXPECT_TRUE(hints(1).empty());
  EXPECT_TRUE(hints(2).empty());
}

TEST_F(Panels, ThatShineOutOfTheRoomAreNamed) {
  scene_.polygons.material[1] = MaterialId{std::size_t{1}};  // the whole ceiling glows
  EXPECT_TRUE(hints(1).empty());
  std::swap(scene_.polygons.corner[4], scene_.polygons.corner[7]);  // and now upwards
  std::swap(scene_.polygons.corner[5], scene_.polygons.corner[6]);
  const std::vector<std::string> wrong = hints(1);
  ASSERT_EQ(wrong.size(), 1u);
  EXPECT_TRUE(wrong[0].starts_with("material 'panel' shines away from the room behind it. Turn")) << wrong[0];
}

}  // namespace
}  // namespace clerestory
