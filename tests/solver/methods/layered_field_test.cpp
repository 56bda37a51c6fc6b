#include "solver/methods/layered_field.h"

#include <cmath>

#include <gtest/gtest.h>

#include "solver/gather/gather.h"
#include "solver/gather/gather_point.h"
#include "solver/methods/hierarchical_field.h"
#include "solver/model/parallel.h"
#include "tests/support/gather_quality.h"
#include "tests/support/many_lights.h"

namespace clerestory {
namespace {

HierarchicalFieldOptions options_for(std::span<const Layer> layers) {
  HierarchicalFieldOptions options;
  options.elements.shortest_edge = 0.3;
  GatherQuality quality = test::gather_quality({16, 256, 256}, 32);
  quality.area = {.first = 1, .last = 3, .tolerance = 0.05, .most_rays = 256};  // more would only take longer
  options.vertices = {.tolerance = 0.1, .shortest_edge = 0.2, .quality = quality};
  options.layers = layers;
  return options;
}

void expect_sum(const Field& lanes, const Field& whole) {
  double level = 0;
  for (const double x : whole.value) level += x / static_cast<double>(whole.value.size());
  ASSERT_EQ(lanes.size(), whole.size());
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (int c = 0; c < whole.channels; ++c) {
      double sum = 0;
      for (int l = c; l < lanes.channels; l += whole.channels) sum += lanes.at(i, l);
      EXPECT_NEAR(sum, whole.at(i, c), 1e-6 * level) << i << ", channel " << c;
    }
}

const std::vector<SensorPoint> kSensors = {
    {{1, 1.5, 0.8}, {0, 0, 1}}, {{3, 1.5, 0.8}, {0, 0, 1}}, {{2, 1, 1.2}, {0, -1, 0}}, {{0.9, 2.6, 0.2}, {1, 0, 0}}};

PointIrradiance at_sensors(const Problem& problem, const Field& B, const RowLight* layers) {
  return gather_at(gather_illumination(problem, B), kSensors.size(),
                   sensor_points(kSensors, problem.patches.origin, problem.rays),
                   GatherPattern(test::gather_quality(), 1), "sensors", {}, layers);
}

class LayeredFieldOf : public testing::TestWithParam<int> {};

TEST_P(LayeredFieldOf, ManyLightsSumsToTheJointFieldWhichKeepsItsBits) {
  const test::ManyLights room(GetParam());
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  const HierarchicalField joint = hierarchical_field(room.problem, room.map, options_for({}));
  const HierarchicalField layered = hierarchical_field(room.problem, room.map, options_for(layers));
  EXPECT_EQ(layered.lightmap.E.value, joint.lightmap.E.value);
  EXPECT_EQ(layered.solution.B.value, joint.solution.B.value);
  EXPECT_EQ(layered.solution.rays, joint.solution.rays);
  EXPECT_TRUE(joint.layers.E.value.empty());
  expect_sum(layered.layers.E, layered.lightmap.E);
  expect_sum(layered.layers.E_elements, layered.solution.E);
  expect_sum(layered.layers.B, layered.solution.B);
  const Problem on_elements{layered.elements, room.rays, room.lights};
  const RowLight light(layers, GetParam(), layered.layers.B);
  const PointIrradiance at = at_sensors(on_elements, layered.solution.B, &light);
  EXPECT_EQ(at.E.value, at_sensors(on_elements, layered.solution.B, nullptr).E.value);
  expect_sum(at.layers, at.E);
}

TEST_P(LayeredFieldOf, ManyLightsGivesEachGroupWhatItGivesAlone) {
  const test::ManyLights room(GetParam());
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  const HierarchicalField layered = hierarchical_field(room.problem, room.map, options_for(layers));
  const Problem on_elements{layered.elements, room.rays, room.lights};
  const RowLight light(layers, GetParam(), layered.layers.B);
  const PointIrradiance at = at_sensors(on_elements, layered.solution.B, &light);
  for (std::size_t s = 0; s < 3; ++s) {
    PatchSet dark = room.patches;
    for (double& M : dark.M.value) M = 0;
    LightSpec alone = test::ManyLights::spec(GetParam());
    alone.sky = {}, alone.suns = {};
    std::erase_if(alone.luminaires, [&](const Luminaire& lamp) { return lamp.group != layers[s].name; });
    const Lights lights = place_lights(alone, dark, room.rays);
    const HierarchicalField fresh = hierarchical_field({dark, room.rays, lights}, room.map, options_for({}));
    const PointIrradiance expected = at_sensors({fresh.elements, room.rays, lights}, fresh.solution.B, nullptr);
    for (std::size_t i = 0; i < kSensors.size(); ++i)  // two solves of draft's rays; mostly within 2 %
      EXPECT_NEAR(one_layer(at.layers, s, GetParam())[i][0], expected.E[i][0], 0.06 * expected.E[i][0])
          << layers[s].name << ", sensor " << i;
  }
}

TEST_P(LayeredFieldOf, ManyLightsGivesTheSameBitsForAnyNumberOfThreads) {
  const test::ManyLights room(GetParam());
  const std::vector<Layer> layers = layers_by_group(room.lights, room.patches);
  std::vector<LayeredField> found;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    found.push_back(hierarchical_field(room.problem, room.map, options_for(layers)).layers);
  }
  set_thread_count(0);
  EXPECT_EQ(found[0].E.value, found[1].E.value);
  EXPECT_EQ(found[0].B.value, found[1].B.value);
}

TEST_P(LayeredFieldOf, RowsThatAreKeptTakeAnotherSkyAsAFreshGatherDoes) {
  const test::ManyLights room(GetParam());
  HierarchyOptions options;
  options.shortest_edge = 0.3;
  KeptTransport kept;
  options.keep = &kept;
  ElementMesh mesh(room.patches, room.map);
  const HierarchicalSolution joint = hierarchical(room.problem, mesh, options);
  const Problem on_elements{kept.elements, room.rays, room.lights};
  const GatherPattern pattern(test::gather_quality(), 1);
  const PointOf points = sensor_points(kSensors, kept.elements.origin, room.rays);
  const LightRows rows =
      gather_rows_at(gather_illumination(on_elements, joint.solution.B), kSensors.size(), points, pattern);
  Layer whole;
  whole.lights.assign(room.lights.luminaires.size() + room.lights.suns.size(), Spectrum(1.0));
  whole.materials.assign(room.patches.materials.size(), Spectrum(1.0));
  Layer other = whole;
  whole.sky = std::make_shared<const SkyRadiance>(room.lights);
  Lights even = room.lights;
  even.sky->model = SkyModel::uniform;
  other.sky = std::make_shared<const SkyRadiance>(even);

  // As it was: the rows are the gather, but for the directions in which they keep the sky.
  const PointIrradiance gathered = at_sensors(on_elements, joint.solution.B, nullptr);
  const Field again = irradiance(rows, RowLight({&whole, 1}, GetParam(), joint.solution.B));
  for (std::size_t k = 0; k < again.value.size(); ++k)
    EXPECT_NEAR(again.value[k], gathered.E.value[k], 2e-5 * gathered.E.value[k]);

  // Another sky: within what the rays of the fresh gather are uncertain by.
  const Balanced s = solve_for(kept, {&other, 1});
  const Field replaced = irradiance(rows, RowLight({&other, 1}, GetParam(), s.B));
  const Problem fresh_problem{kept.elements, room.rays, even};
  const Illumination fresh = gather_illumination(fresh_problem, s.B);
  for (std::size_t i = 0; i < kSensors.size(); ++i) {
    const ReceivingPoint at = points(i);
    unsigned long long rays = 0;
    const GatheredLight expected = gather_point(fresh, at.p, at.n, pattern, rays);
    EXPECT_NEAR(replaced[i][0], expected.E[0], std::max(4 * expected.std_error, 0.005 * expected.E[0])) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Channels, LayeredFieldOf, testing::Values(1, 3),
                         [](const auto& channels) { return channels.param == 1 ? "Grey" : "Coloured"; });

}  // namespace
}  // namespace clerestory
