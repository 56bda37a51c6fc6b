#include "solver/methods/kept_transport.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "solver/methods/hierarchical.h"
#include "solver/model/parallel.h"
#include "tests/support/many_lights.h"

namespace clerestory {
namespace {

constexpr double kResidual = 1e-9;

struct Kept {
  KeptTransport transport;
  HierarchicalSolution joint;
};

Kept keep(const Problem& problem, const VertexLightmap& map, HierarchyOptions options = {}) {
  Kept kept;
  ElementMesh mesh(problem.patches, map);
  options.shortest_edge = 0.3, options.residual = kResidual, options.keep = &kept.transport;
  kept.joint = hierarchical(problem, mesh, options);
  return kept;
}

double mean(const Field& x) {
  double sum = 0;
  for (const double value : x.value) sum += value;
  return sum / static_cast<double>(x.value.size());
}

Field sum_of_layers(const Field& lanes, int channels) {
  Field sum(lanes.size(), channels);
  for (std::size_t i = 0; i < sum.size(); ++i)
    for (int l = 0; l < lanes.channels; ++l) sum.at(i, l % channels) += lanes.at(i, l);
  return sum;
}

void expect_near(const Field& a, const Field& b, double share) {
  ASSERT_EQ(a.value.size(), b.value.size());
  const double level = mean(b);
  for (std::size_t k = 0; k < a.value.size(); ++k)
    EXPECT_NEAR(a.value[k], b.value[k], share * std::max(level, b.value[k])) << k;
}

class KeptTransportOf : public testing::TestWithParam<int> {};

TEST_P(KeptTransportOf, ManyLightsSumsToTheJointSolve) {
  const test::ManyLights room(GetParam());
  ASSERT_FALSE(room.lights.openings.empty());
  ASSERT_GT(room.lights.luminaires.size(), 6u) << "the mirror shows images";
  const Kept kept = keep(room.problem, room.map);
  ASSERT_TRUE(kept.transport.complete);
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  ASSERT_EQ(layers.size(), 6u);
  const Balanced s = solve_for(kept.transport, layers, kResidual);
  expect_near(sum_of_layers(s.E, GetParam()), kept.joint.solution.E, 1e-6);
  expect_near(sum_of_layers(s.B, GetParam()), kept.joint.solution.B, 1e-6);
  EnergyBalance energy;
  for (const EnergyBalance& of_one : s.energy) energy += of_one;
  EXPECT_NEAR(energy.emitted, kept.joint.solution.energy.emitted, 1e-6 * energy.emitted);
  EXPECT_NEAR(energy.absorbed, kept.joint.solution.energy.absorbed, 1e-6 * energy.emitted);
  EXPECT_NEAR(energy.escaped, kept.joint.solution.energy.escaped, 1e-6 * energy.emitted);
  for (const EnergyBalance& of_one : s.energy) EXPECT_NEAR(of_one.imbalance(), 0, 0.02);  // rays of the joint light
}

TEST_P(KeptTransportOf, ManyLightsGivesTheSameBitsForAnyNumberOfThreads) {
  const test::ManyLights room(GetParam());
  std::vector<Field> E;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const Kept kept = keep(room.problem, room.map);
    E.push_back(solve_for(kept.transport, layers_by_group(room.lights, room.patches)).E);
  }
  set_thread_count(0);
  EXPECT_EQ(E[0].value, E[1].value);
}

TEST_P(KeptTransportOf, ManyLightsIsSwitchedAndDimmedWithoutRays) {
  // Lamps that change their group: what they give goes with them.
  test::ManyLights room(GetParam());
  const Kept kept = keep(room.problem, room.map);
  const std::size_t all = room.lights.luminaires.size() + room.lights.suns.size();
  std::vector<Layer> layers(2);
  layers[0].lights.resize(all), layers[1].lights.resize(all);
  layers[0].lights[0] = Spectrum(1.0), layers[0].lights[2] = Spectrum(0.5);
  layers[1].lights[2] = Spectrum(0.5), layers[1].lights[0] = Spectrum(1.0);
  const Balanced s = solve_for(kept.transport, layers, kResidual);
  expect_near(one_layer(s.E, 0, GetParam()), one_layer(s.E, 1, GetParam()), 1e-12);
  // Halved and doubled: twice the light, four times the half of it.
  for (Spectrum& factor : layers[1].lights) factor *= 4;
  const Balanced again = solve_for(kept.transport, layers, kResidual);
  Field four = one_layer(again.E, 0, GetParam());
  for (double& x : four.value) x *= 4;
  expect_near(one_layer(again.E, 1, GetParam()), four, 1e-6);
}

TEST_P(KeptTransportOf, ManyLightsTakesAnotherSkyAsAFreshSolveDoes) {
  const test::ManyLights room(GetParam());
  const Kept kept = keep(room.problem, room.map);
  Lights other = room.lights;
  other.sky->model = SkyModel::uniform;
  other.sky->horizontal_irradiance = GetParam() == 1 ? Spectrum(200) : Spectrum(200, 150, 100);
  Layer light;
  light.lights.assign(other.luminaires.size() + other.suns.size(), Spectrum(1.0));
  light.materials.assign(room.patches.materials.size(), Spectrum(1.0));
  light.sky = std::make_shared<const SkyRadiance>(other);
  const Balanced replaced = solve_for(kept.transport, {&light, 1});
  // Fresh solves halve other elements: fluxes are compared. Their own seeds tell how far these may lie apart.
  const auto flux = [](const PatchSet& patches, const Field& E) {
    double sum = 0;
    for (std::size_t i = 0; i < E.size(); ++i) sum += patches.area[i] * E[i][0];
    return sum;
  };
  std::vector<double> fresh;
  double sum = 0, squares = 0;
  constexpr int kSeeds = 5;
  for (std::uint64_t seed = 11; seed < 11 + kSeeds; ++seed) {
    const Kept one = keep({room.patches, room.rays, other}, room.map, {.seed = seed});
    const double found = flux(one.joint.elements, one.joint.solution.E);
    sum += found, squares += found * found;
  }
  const double expected = sum / kSeeds,
               spread = std::sqrt((squares / kSeeds - expected * expected) * kSeeds / (kSeeds - 1));
  EXPECT_NEAR(flux(kept.transport.elements, replaced.E), expected, 4 * spread);
  EXPECT_LT(spread, 0.01 * expected);
}

TEST_P(KeptTransportOf, ManyLightsTakesLampsThatStandElsewhereByTheirOwnRays) {
  const test::ManyLights room(GetParam());
  Kept kept = keep(room.problem, room.map);
  LightSpec moved;
  moved.luminaires.push_back({"moved", {2.5, 0.5, 1.9}, "", PointLuminaire{Spectrum(50)}});
  const Lights lights = place_lights(moved, room.patches, room.rays);
  const Problem of_moved{kept.transport.elements, room.rays, lights};
  DirectRows rows;
  const DirectOptions options{.shadow_rays = 64, .edge_rays = 256, .sky_rays = 0};
  const DirectLight direct = direct_light(Illumination(of_moved), options, {}, &rows);
  const std::size_t before = kept.transport.direct.sources.size();
  kept.transport.direct.append(rows);
  Layer light;
  light.lights.resize(before + lights.luminaires.size());
  for (std::size_t k = before; k < light.lights.size(); ++k) light.lights[k] = Spectrum(1.0);
  const DirectLayers layers = direct_layers(kept.transport.elements, kept.transport.direct, {&light, 1});
  expect_near(layers.delta_light, direct.E, 1e-6);
  const Balanced s = solve_for(kept.transport, {&light, 1});
  EXPECT_NEAR(s.energy[0].imbalance(), 0, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Channels, KeptTransportOf, testing::Values(1, 3),
                         [](const auto& channels) { return channels.param == 1 ? "Grey" : "Coloured"; });

TEST(KeptTransport, OfAFurnaceStaysAFurnace) {
  test::RoomWithBlocks glowing = test::room_of_2160_patches();
  glowing.exitance = 3;
  const PatchSet patches = glowing.build();
  const RayScene rays(patches);
  const Lights none;
  const Kept kept = keep({patches, rays, none}, test::unjoined_lightmap(patches));
  std::vector<Layer> layers(9);
  for (std::size_t s = 0; s < layers.size(); ++s)
    layers[s].materials.assign(patches.materials.size(), Spectrum(static_cast<double>(s)));
  const Balanced s = solve_for(kept.transport, layers);
  for (std::size_t i = 0; i < s.B.size(); ++i)
    for (int l = 0; l < s.B.channels; ++l) EXPECT_NEAR(s.B.at(i, l), 6.0 * l, 6e-5 * l);  // B = M / (1 - rho)
}

TEST(KeptTransport, IsNotKeptWhenTheSolveWasStopped) {
  const test::ManyLights room(1);
  KeptTransport kept;
  ElementMesh mesh(room.patches, room.map);
  HierarchyOptions options;
  options.keep = &kept;
  Monitor monitor;
  monitor.deadline = {};
  hierarchical(room.problem, mesh, options, monitor);
  EXPECT_FALSE(kept.complete);
}

}  // namespace
}  // namespace clerestory
