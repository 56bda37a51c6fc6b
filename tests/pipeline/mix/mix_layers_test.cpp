#include "pipeline/mix/mix_layers.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "solver/model/error.h"
#include "tests/support/flat_result.h"

namespace clerestory {
namespace {

/// A floor of reflectance 0.5 under a lamp, E = 1 + x, and a sky, E = 2 (W/m2); a sensor gets 3 and 4 of them.
WrittenResult lamp_and_sky() {
  WrittenResult r = empty_result();
  add_rectangle(r, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, [](const Vec3& p) { return 3 + p.x; });
  r.of_cells["irradiance"].value = r.of_cells["radiosity"].value = {3.25, 3.75};
  for (auto* arrays : {&r.of_points, &r.of_cells}) {
    WrittenArray &lamp = (*arrays)["irradiance:lamp"], &sky = (*arrays)["irradiance:sky"];
    for (const float E : (*arrays)["irradiance"].value) lamp.value.push_back(E - 2), sky.value.push_back(2);
    (*arrays)["daylight_factor"].value.assign(lamp.value.size(), 1);
  }
  r.around.daylight_reference = 1790;  // 10 W/m2
  r.around.sky.radiance = Field(SkyTable::kRows * SkyTable::kColumns, 1);
  std::ranges::fill(r.around.sky.radiance.value, 7.0);
  r.around.layers = {{"lamp", {10, 8, 2}, {}, 1}, {"sky", {20, 15, 5}, r.around.sky, 1}};
  r.around.luminaires = {{{0, 0, 2}, "a", "lamp", 500}, {{1, 0, 2}, "b", "", 300}};
  Field lanes(1, 2);
  lanes.value = {3, 4};
  r.around.sensors = {{{"desk", {{{0, 0, 1}, {0, 0, 1}}}}, {7 * 179.0}, lanes}};
  return r;
}

TEST(MixLayers, LightIsTheSumOfLayersTimesTheirFactors) {
  WrittenResult r = lamp_and_sky();
  mix_layers(r, std::vector<double>{0.5, 2});
  for (std::size_t i = 0; i < r.points.size(); ++i) {
    const double E = 0.5 * (1 + r.points[i].x) + 2 * 2;
    EXPECT_FLOAT_EQ(r.of_points["irradiance"].value[i], static_cast<float>(E));
    EXPECT_FLOAT_EQ(r.of_points["illuminance"].value[i], static_cast<float>(179 * E));
    EXPECT_FLOAT_EQ(r.of_points["radiosity"].value[i], static_cast<float>(0.5 * E)) << "B = rho E";
    EXPECT_FLOAT_EQ(r.of_points["luminance"].value[i], static_cast<float>(179 * 0.5 * E / M_PI));
    EXPECT_FLOAT_EQ(r.of_points["irradiance:sky"].value[i], 4) << "layers end as they were scaled";
  }
  EXPECT_FLOAT_EQ(r.of_cells["irradiance"].value[0], 0.5f * 1.25f + 4);
  EXPECT_EQ(r.around.layers[0].energy.absorbed, 4);
  EXPECT_EQ(r.around.layers[1].luminous_flux(), 179 * 40.0);
  EXPECT_EQ(r.around.sky.radiance.value[5], 14);
  EXPECT_EQ(r.around.luminaires[0].luminous_flux, 250);
  EXPECT_EQ(r.around.luminaires[1].luminous_flux, 300) << "of no layer that was dimmed";
  EXPECT_DOUBLE_EQ(r.around.sensors[0].illuminance[0], 179 * (0.5 * 3 + 2 * 4));
  const SensorLight at_sensors = sensor_light(r);
  EXPECT_DOUBLE_EQ(at_sensors.E.value[0], 9.5);
  EXPECT_EQ(at_sensors.layers.value, (std::vector<double>{1.5, 8}));
}

TEST(MixLayers, MixingAgainStartsFromWhatThereIs) {
  WrittenResult twice = lamp_and_sky(), once = lamp_and_sky();
  mix_layers(twice, std::vector<double>{0.5, 2});
  mix_layers(twice, std::vector<double>{4, 0.5});
  mix_layers(once, std::vector<double>{2, 1});
  EXPECT_EQ(twice.of_points["irradiance"].value, once.of_points["irradiance"].value);
  EXPECT_EQ(twice.around.layers[0].factor, 2);
  EXPECT_EQ(twice.around.layers[1].factor, 1);
  mix_layers(twice, std::vector<double>{0, 0});
  for (const float E : twice.of_points["irradiance"].value) EXPECT_EQ(E, 0);
  mix_layers(twice, std::vector<double>{1, 3});
  for (const float E : twice.of_points["radiosity"].value) EXPECT_EQ(E, 0) << "what is off stays off, and is a number";
}

TEST(MixLayers, WhereSurfacesGlowTheirOwnRadiosityIsDimmedToo) {
  WrittenResult r = lamp_and_sky();  // M = 10 of the lamp's layer, rho = 0.5
  for (auto* arrays : {&r.of_points, &r.of_cells}) {
    for (float& B : (*arrays)["radiosity"].value) B += 10;
    for (const float E : (*arrays)["irradiance:lamp"].value) (*arrays)["radiosity:lamp"].value.push_back(10 + 0.5f * E);
    for (const float E : (*arrays)["irradiance:sky"].value) (*arrays)["radiosity:sky"].value.push_back(0.5f * E);
  }
  mix_layers(r, std::vector<double>{0.25, 1});
  for (std::size_t i = 0; i < r.points.size(); ++i)
    EXPECT_FLOAT_EQ(r.of_points["radiosity"].value[i],
                    static_cast<float>(2.5 + 0.5 * (0.25 * (1 + r.points[i].x) + 2)));
}

TEST(MixLayers, RadiosityThatOnlySomeLayersHaveIsLeftAsItIs) {
  WrittenResult r = lamp_and_sky();
  const std::vector<float> before = r.of_points["radiosity:lamp"].value = r.of_points["radiosity"].value;
  mix_layers(r, std::vector<double>{0.5, 2});
  EXPECT_EQ(r.of_points["radiosity:lamp"].value, before);
  EXPECT_FLOAT_EQ(r.of_points["radiosity"].value[0], 0.5f * r.of_points["irradiance"].value[0]) << "B = rho E";
}

TEST(MixLayers, DaylightFactorsStayOnlyWhereTheSkyIsTheOnlyLight) {
  WrittenResult off = lamp_and_sky(), dimmed = lamp_and_sky(), same = lamp_and_sky();
  mix_layers(off, std::vector<double>{0, 0.5});
  ASSERT_TRUE(off.of_points.contains("daylight_factor"));
  EXPECT_FLOAT_EQ(off.of_points["daylight_factor"].value[0], 20) << "2 of 10 W/m2, at half of both";
  EXPECT_EQ(off.around.daylight_reference, 895);
  mix_layers(dimmed, std::vector<double>{0.5, 1});
  EXPECT_FALSE(dimmed.of_points.contains("daylight_factor"));
  EXPECT_FALSE(dimmed.around.daylight_reference);
  mix_layers(same, std::vector<double>{1, 1});
  EXPECT_EQ(same.of_points["daylight_factor"].value[0], 1);
}

TEST(MixLayers, TheReportIsOfTheLightOfNow) {
  WrittenResult r = lamp_and_sky();
  RunReport before;
  before.energy = {30, 23, 7};
  before.error.emplace().rms_relative = 0.01;
  before.luminaires.resize(1);
  before.luminaires[0].group = "lamp", before.luminaires[0].luminous_flux = 500;
  const std::vector<double> ones{1, 1}, factors{0.5, 2};
  EXPECT_EQ(report_of_mix(before, r, ones).error->rms_relative, 0.01);
  mix_layers(r, factors);
  const RunReport report = report_of_mix(before, r, factors);
  EXPECT_EQ(report.energy.emitted, 45);
  EXPECT_EQ(report.energy.absorbed, 34);
  EXPECT_EQ(report.energy.escaped, 11);
  EXPECT_EQ(report.luminaires[0].luminous_flux, 250);
  EXPECT_FALSE(report.error) << "it was measured of another light";
  ASSERT_EQ(report.sensors.size(), 1u);
  EXPECT_DOUBLE_EQ(report.sensors[0].mean, 179 * 9.5);
}

std::string refusal(const WrittenResult& r, const std::vector<LayerFactor>& set) {
  try {
    factors_of(r, set);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(MixLayers, WhatCannotBeMixedIsSaidInOneMessage) {
  const WrittenResult r = lamp_and_sky();
  EXPECT_EQ(factors_of(r, std::vector<LayerFactor>{{"sky", 0}}), (std::vector<double>{1, 0}));
  EXPECT_NE(refusal(r, {{"lamb", 1}}).find("did you mean 'lamp'?"), std::string::npos);
  for (const double bad : {-1.0, 1001.0, std::nan(""), std::numeric_limits<double>::infinity()})
    EXPECT_NE(refusal(r, {{"sky", bad}}).find("outside [0, 1000]"), std::string::npos) << bad;
  EXPECT_NE(refusal(empty_result(), {{"sky", 1}}).find("solve the scene again with --layers"), std::string::npos);
}

}  // namespace
}  // namespace clerestory
