#include "pipeline/mix/find_factors.h"

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

/// A grid of two sensors, "desk", and layers that give it these illuminances [lx], each of 1,000 lm.
WrittenResult lit_desk(const std::vector<std::pair<std::string, std::array<double, 2>>>& layers) {
  WrittenResult r;
  r.file = "office.vtp";
  MeasuredSensors desk;
  desk.set.name = "desk";
  desk.set.points.resize(2);
  desk.illuminance.resize(2);
  desk.layers = Field(2, static_cast<int>(layers.size()));
  for (std::size_t k = 0; k < layers.size(); ++k) {
    r.around.layers.push_back({.name = layers[k].first, .energy = {.emitted = 1000 / kWhiteEfficacy}});
    for (std::size_t s = 0; s < 2; ++s) {
      desk.layers.at(s, static_cast<int>(k)) = layers[k].second[s] / kWhiteEfficacy;
      desk.illuminance[s] += layers[k].second[s];
    }
  }
  r.around.sensors = {desk};
  return r;
}

std::string refusal(const WrittenResult& r, const DimRequest& request, const std::vector<LayerFactor>& given = {}) {
  try {
    find_factors(r, given, request);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

double factor_on(const FoundFactors& found, const std::string& layer) {
  return std::ranges::find(found.factors, layer, &LayerFactor::layer)->factor;
}

const DimRequest kDesk500{.targets = {{"desk", 500}}};

TEST(FindFactors, DimsGroupsAndLeavesTheSkyAsItIs) {
  // 200 lx of the sky, so the lamp, with 400, has 300 to give; what adds nothing is off.
  const WrittenResult r = lit_desk({{"lamp", {400, 400}}, {"picture", {0, 0}}, {"sky", {100, 300}}});
  const FoundFactors found = find_factors(r, {}, kDesk500);
  ASSERT_EQ(found.factors.size(), 2u);
  EXPECT_NEAR(factor_on(found, "lamp"), 0.75, 1e-6);
  EXPECT_EQ(factor_on(found, "picture"), 0);
  EXPECT_NEAR(found.luminous_flux, 750, 1e-3);
  EXPECT_NEAR(found.full_flux, 2000, 1e-9);
}

TEST(FindFactors, WhatIsGivenStaysSo) {
  const WrittenResult r = lit_desk({{"lamp", {400, 400}}, {"ceiling", {300, 300}}, {"sky", {200, 200}}});
  // 0.5 x 300 + 0.25 x 200 are there: 300 left for 400.
  const FoundFactors found = find_factors(r, std::vector<LayerFactor>{{"ceiling", 0.5}, {"sky", 0.25}}, kDesk500);
  ASSERT_EQ(found.factors.size(), 1u);
  EXPECT_NEAR(factor_on(found, "lamp"), 0.75, 1e-6);
}

TEST(FindFactors, OneFactorForAllCommissionsThem) {
  const WrittenResult r = lit_desk({{"a", {500, 300}}, {"sky", {100, 100}}, {"b", {100, 300}}});
  DimRequest request = kDesk500;
  request.commission = true;
  const FoundFactors found = find_factors(r, {}, request);  // 600 lx of both, 100 of the sky
  ASSERT_EQ(found.factors.size(), 2u);
  EXPECT_NEAR(factor_on(found, "a"), 400.0 / 600, 1e-6);
  EXPECT_EQ(factor_on(found, "a"), factor_on(found, "b"));
  EXPECT_NEAR(found.luminous_flux, 2000 * 400.0 / 600, 1e-3);
}

TEST(FindFactors, SkyAloneAboveTheTargetLeavesLampsOff) {
  const FoundFactors found = find_factors(lit_desk({{"lamp", {400, 400}}, {"sky", {600, 600}}}), {}, kDesk500);
  EXPECT_EQ(factor_on(found, "lamp"), 0);
  EXPECT_EQ(found.luminous_flux, 0);
}

TEST(FindFactors, SaysTheBestThatCanBeHad) {
  const WrittenResult r = lit_desk({{"lamp", {300, 500}}, {"sky", {0, 24}}});
  EXPECT_EQ(refusal(r, kDesk500),
            "office.vtp: --target 'desk'=500 cannot be reached: 'lamp' at 1 gives a mean of 412.0 lx; ask for less, or "
            "allow more "
            "with --max.");
  EXPECT_EQ(refusal(r, {.targets = {{"desk", 500}}, .most = 1.3}), "");
  EXPECT_NE(refusal(r, {.targets = {{"desk", 350, true}}}).find("'lamp' at 1 gives at least 300.0 lx"),
            std::string::npos)
      << refusal(r, {.targets = {{"desk", 350, true}}});
  // The sky helps the brighter sensor only, so the more of the lamp the better: 300 / 412 in full.
  const std::string uneven = refusal(r, {.targets = {{"desk", 200}}, .uniformity = 0.8});
  EXPECT_NE(uneven.find("--uniformity 0.8 cannot be reached"), std::string::npos) << uneven;
  EXPECT_NE(uneven.find("is 0.728 (at factors 'lamp'="), std::string::npos) << uneven;
}

TEST(FindFactors, RefusesWhatIsNotThere) {
  const WrittenResult r = lit_desk({{"lamp", {400, 400}}, {"sky", {100, 100}}});
  EXPECT_NE(refusal(r, {.targets = {{"dessk", 500}}}).find("did you mean 'desk'?"), std::string::npos);
  EXPECT_NE(refusal(r, kDesk500, {{"lamp", 1}}).find("no layer to dim"), std::string::npos);
  EXPECT_NE(refusal(lit_desk({{"sky", {400, 400}}, {"sun", {1, 1}}}), kDesk500).find("sky and sun cannot be dimmed"),
            std::string::npos);
  WrittenResult bare = r;
  bare.around.sensors.push_back(bare.around.sensors[0]);
  bare.around.sensors[1].set.name = "front, rear";
  EXPECT_NE(refusal(bare, {.targets = {{"window", 500}}}).find("known are 'desk', 'front, rear'."), std::string::npos)
      << "names that have a comma can be told apart";
  bare.around.sensors.clear();
  EXPECT_NE(refusal(bare, kDesk500).find("has no sensors"), std::string::npos);
  bare.around.layers.clear();
  EXPECT_NE(refusal(bare, kDesk500).find("--layers"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
