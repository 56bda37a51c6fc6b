#include "solver/hierarchy/trace_links.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "solver/hierarchy/build_tree.h"
#include "solver/hierarchy/gather_links.h"
#include "tests/support/room_with_blocks.h"

namespace clerestory {
namespace {

struct Linked {
  PatchSet patches;
  RayScene rays{patches};
  Lights lights;
  Problem problem{patches, rays, lights};
  Field glow;
  ElementTree tree;
  Transport transport;

  Linked(PatchSet p, const LinkOptions& options)
      : patches(std::move(p)), glow(patches.M), tree(build_tree(patches, glow)) {
    DirectLight none;
    none.E = Field(patches.patch_count(), 1);
    transport = trace_links(Illumination(problem, glow), tree, {}, none, options);
  }
  Field gather(const Field& B) const {
    Field nodes, E(patches.patch_count(), 1);
    pull(tree, B, nodes);
    gather_and_push(transport, tree, nodes, E);
    return E;
  }
};

PatchSet room_with_lamp() {
  test::PatchBuilder b(0.5);
  b.box({0, 0, 0}, {5, 0, 0}, {0, 4, 0}, {0, 0, 3}, {6, 5, 4}, true);
  b.material(0.5, 100).rectangle({2, 2, 2.5}, {0, 0.4, 0}, {0.5, 0, 0}, 2, 2);
  b.material(0.5).rectangle({2, 2, 2.502}, {0.5, 0, 0}, {0, 0.4, 0}, 2, 2);
  return b.build();
}

TEST(TraceLinks, RowsSumToTheClosedShareWithPairsAndWithout) {
  for (const int bright_rays : {0, 64}) {
    const Linked l(room_with_lamp(), {.bundle_rays = 64, .bright_rays = bright_rays});
    Field one(l.patches.patch_count(), 1);
    for (double& x : one.value) x = 1;
    const Field E = l.gather(one);
    for (std::size_t i = 0; i < E.size(); ++i) {
      EXPECT_NEAR(E[i][0], double{l.transport.arrives[i]}, 1e-6) << "patch " << i;  // floats of weights
      EXPECT_EQ(l.transport.escapes[i], 0.0f) << "nothing leaves a closed room";
    }
  }
}

TEST(TraceLinks, AnOpenPatchKnowsWhatEscapes) {
  // A floor below a parallel ceiling of the same size, 1 x 1 at distance 1: F = 0.199824896 (Howell C-11).
  test::PatchBuilder b(0.5);
  b.rectangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}).rectangle({0, 0, 1}, {0, 1, 0}, {1, 0, 0});
  const Linked l(b.build(), {.bundle_rays = 4096, .bright_rays = 0});
  double arrives = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(double{l.transport.arrives[i]} + double{l.transport.escapes[i]}, 1, 1e-6);
    arrives += double{l.transport.arrives[i]} / 4;
  }
  // Four rows of 4096 rays: a standard error of at most sqrt(0.2 * 0.8 / 16384) = 0.0031.
  EXPECT_NEAR(arrives, 0.199824896, 4 * 0.0031);
}

TEST(TraceLinks, ASmallLampIsFoundByPairsWhereABundleMissesIt) {
  // A lamp of 1 cm2, 2 m above the floor: E = M A / (pi h2) under it. A bundle of 64 rays would hit it once in 2,000.
  test::PatchBuilder b(0.5);
  b.rectangle({-0.005, -0.005, 0}, {0.01, 0, 0}, {0, 0.01, 0});
  b.material(0, 1e6).rectangle({-0.005, -0.005, 2}, {0, 0.01, 0}, {0.01, 0, 0});
  const Linked l(b.build(), {.bundle_rays = 64, .bright_rays = 64});
  const Field E = l.gather(l.patches.M);
  const double exact = 1e6 * 1e-4 / (std::numbers::pi * 4);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(E[i][0], exact, 1e-4 * exact);  // (size / distance)^2 = 2.5e-5
}

/// Many small faces of all orientations within one cluster's size, in a glowing room.
PatchSet room_with_gravel() {
  test::PatchBuilder b(0.5);
  b.material(0.5, 3).box({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}, true);
  b.material(0.5);
  for (int k = 0; k < 12; ++k) {
    const double t = 0.4 * k;
    const Vec3 o{0.9 + 0.02 * (k % 4), 0.9 + 0.02 * (k / 4), 1};
    b.box(o, {0.006 * std::cos(t), 0.006 * std::sin(t), 0}, {-0.006 * std::sin(t), 0.006 * std::cos(t), 0},
          {0, 0, 0.006}, {1, 1, 1}, false);
  }
  return b.build();
}

TEST(TraceLinks, AClusterHandsDownExactlyTheFluxItReceives) {
  const Linked l(room_with_gravel(), {.bundle_rays = 64, .bright_rays = 64, .cluster_diameter = 0.05});
  EXPECT_LT(l.transport.receiver_count(), l.patches.patch_count() / 2) << "clusters receive";
  Field B(l.patches.patch_count(), 1);
  for (std::size_t i = 0; i < B.size(); ++i) B.at(i, 0) = 1 + static_cast<double>(i % 5);
  const Field E = l.gather(B);
  Field nodes;
  pull(l.tree, B, nodes);
  std::size_t clusters = 0;
  for (const LinkBlock& block : l.transport.blocks) {
    std::size_t link = 0, row = 0;
    for (const Receiver& r : block.receivers) {
      double rows = 0, area = 0, flux = 0;
      for (std::uint32_t k = 0; k < r.rows; ++k, ++row)
        for (; link < block.row_end[row]; ++link)
          rows += double{block.links[link].weight} * nodes[block.links[link].source][0];
      for (std::uint32_t i = r.first_leaf; i < r.leaf_end; ++i) {
        const std::uint32_t p = l.tree.patch[i];
        area += l.patches.area[p], flux += l.patches.area[p] * E[p][0];
      }
      clusters += r.hands_down;
      EXPECT_NEAR(flux, rows * area, 1e-6 * flux);  // floats of shares
    }
  }
  EXPECT_GT(clusters, 2u);
}

TEST(TraceLinks, MembersOfAClusterReceiveByTheirOrientation) {
  // Light from above only: faces that look up get all of it, those that look down what the dark floor sends, none.
  test::PatchBuilder b(0);
  b.box({-5, -5, -5}, {10, 0, 0}, {0, 10, 0}, {0, 0, 10}, {1, 1, 1}, true);
  b.box({-0.01, -0.01, -0.01}, {0.02, 0, 0}, {0, 0.02, 0}, {0, 0, 0.02}, {1, 1, 1}, false);
  const Linked l(b.build(), {.bundle_rays = 1024, .bright_rays = 0, .cluster_diameter = 0.1});
  Field B(l.patches.patch_count(), 1);
  for (std::size_t i = 0; i < B.size(); ++i) B.at(i, 0) = l.patches.normal[i].z < -0.5 && i < 12 ? 1 : 0;
  const Field E = l.gather(B);
  for (std::size_t i = 12; i < B.size(); ++i) {
    // From the centre of a cube: 0.5541 to the face ahead, the rest in equal parts to the four around it.
    const double z = l.patches.normal[i].z, exact = z > 0.5 ? 0.5541 : z < -0.5 ? 0 : 0.1115;
    EXPECT_NEAR(E[i][0], exact, 0.03) << "z " << z;  // the parts of the sphere are 0.17 sr wide
  }
}

}  // namespace
}  // namespace clerestory
