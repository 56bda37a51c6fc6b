#include "solver/hierarchy/sky_views.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/hierarchy/build_tree.h"
#include "solver/hierarchy/trace_links.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/packed_direction.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

TEST(PackedDirection, IsWithinItsGridAndKeepsAxesAndHorizon) {
  for (std::uint32_t k = 0; k < 1000; ++k) {
    const auto u = sobol4(k, 1);
    const Vec3 d = sphere_direction(u[0], u[1]);
    const Vec3 packed = unpack_direction(pack_direction(d));
    EXPECT_LT(length(packed - d), 1.5e-4);  // half a cell's diagonal is 1 / (2^14 - 1), folded out up to 1.5 times
    EXPECT_GE(packed.z * d.z, 0) << "the ground is no sky";
    EXPECT_EQ(unpack_direction(pack_direction(packed)), packed);
  }
  for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}})
    EXPECT_EQ(unpack_direction(pack_direction(d)), d);
}

Lights uniform_sky(double E, double ground) {
  Lights lights;
  lights.sky = Sky{.model = SkyModel::uniform, .horizontal_irradiance = Spectrum(E), .ground_reflectance = ground};
  return lights;
}

/// A court, open above, with a pane over half of it and gravel that receives as one.
PatchSet court(bool mirrored) {
  test::PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, 2, 2).rectangle({0, 2, 0}, {2, 0, 0}, {0, 0, 1}, 2, 1);
  for (int k = 0; k < 12; ++k)
    b.box({0.9 + 0.02 * (k % 4), 0.9 + 0.02 * (k / 4), 0.5}, {0.006, 0, 0}, {0, 0.006, 0}, {0, 0, 0.006}, {1, 1, 1},
          false);
  b.glass(0.7).rectangle({0, 0, 1.5}, {1, 0, 0}, {0, 2, 0});
  if (mirrored) b.mirror(0.9).rectangle({0, 0, 0}, {0, 2, 0}, {0, 0, 1});
  return b.build();
}

struct Court {
  PatchSet patches;
  RayScene rays{patches};
  Lights lights = uniform_sky(100, 1);
  Problem problem{patches, rays, lights};
  Illumination light{problem};
  ElementTree tree = build_tree(patches, patches.M);
  Transport transport;

  explicit Court(bool mirrored) : patches(court(mirrored)) {
    DirectLight none;
    none.E = Field(patches.patch_count(), 1);
    transport = trace_links(light, tree, {}, none, {.bundle_rays = 256, .bright_rays = 0, .cluster_diameter = 0.1});
  }
  Field under(const std::vector<const SkyRadiance*>& skies) const {
    return sky_irradiance(patches, tree, transport, skies);
  }
};

class SkyViews : public testing::TestWithParam<bool> {};

TEST_P(SkyViews, OfASkyThatIsAlikeEverywhereBringWhatEscapes) {
  const Court c(GetParam());
  ASSERT_LT(c.transport.receiver_count(), c.patches.patch_count()) << "clusters receive";
  const Field E = c.under({&c.light.sky});
  for (const LinkBlock& block : c.transport.blocks)
    for (const Receiver& r : block.receivers)
      for (std::uint32_t l = r.first_leaf; l < r.leaf_end; ++l) {
        const std::uint32_t i = c.tree.patch[l];
        // Steps of a view's transmittance; members' shares of 256 rays do not sum to one but on average.
        EXPECT_NEAR(E[i][0], 100 * double{c.transport.escapes[i]}, r.hands_down ? 5 : 100 * 2.5e-4) << i;
      }
}

TEST_P(SkyViews, OfSeveralSkiesAreTheSumOfEach) {
  const Court c(GetParam());
  Lights other = c.lights;
  other.sky->model = SkyModel::cie_overcast;
  const SkyRadiance overcast(other);
  const Field both = c.under({&c.light.sky, &overcast}), even = c.under({&c.light.sky}), cloudy = c.under({&overcast});
  for (std::size_t i = 0; i < even.size(); ++i) {
    EXPECT_EQ(both.at(i, 0), even.at(i, 0));
    EXPECT_EQ(both.at(i, 1), cloudy.at(i, 0));
  }
}

INSTANTIATE_TEST_SUITE_P(Courts, SkyViews, testing::Bool(),
                         [](const auto& mirrored) { return mirrored.param ? "WithAMirror" : "WithoutMirrors"; });

}  // namespace
}  // namespace clerestory
