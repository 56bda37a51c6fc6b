#include "apps/solve_report.h"

#include <numbers>

#include <gtest/gtest.h>

#include "pipeline/collect_around.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

TEST(SensorTable, HasOneAlignedLineASetAndSaysWhatWasAskedFor) {
  SensorSummary plane{.name = "B\xc3\xbcro", .points = 1200, .mean = 512, .min = 301, .max = 731, .median = 520};
  plane.uniformity = 0.588;
  plane.threshold = {500, 0.625};
  SensorSummary faces{.name = "faces", .kind = SensorKind::cylindrical, .points = 6, .mean = 1.5, .min = 0.5, .max = 2};
  faces.daylight_factor = {4.123, 3.5, 0.61};
  EXPECT_EQ(
      sensor_table({plane, faces}),
      (std::vector<std::string>{"lux at sensors         points  mean    min   max  median    U0",
                                "  B\xc3\xbcro                  1,200   512    301   731     520  0.59  62.5 % at "
                                "500 lx or more",
                                "  faces (cylindrical)       6  1.50  0.500  2.00       0     0  daylight factor "
                                "4.12 % (median 3.50 %), 61.0 % at 2 % or more"}));
}

TEST(SensorTable, SaysBothWhenBothAreAskedFor) {
  SensorSummary s{.name = "desk", .points = 1};
  s.threshold = {300, 1};
  s.daylight_factor = {1, 1, 0};
  EXPECT_NE(sensor_table({s})[1].find("100 % at 300 lx or more; daylight factor 1.00 %"), std::string::npos);
}

TEST(LuminairesByFile, AddUpTheFluxOfEachFileAndGroup) {
  PhotometricWeb web;
  web.name = "lamp.ldt";
  web.vertical = {0, 180};
  web.horizontal = {0};
  web.candela = {100, 100};
  web.flux = luminous_flux(web);  // 4 pi 100 lm
  web.declared_flux = 1250;
  web.lamp_flux = 2500;
  const auto shared = std::make_shared<const PhotometricWeb>(web), other = std::make_shared<const PhotometricWeb>(web);
  LightSpec lights;
  const auto lamp = [&](const auto& of, double dimming, const std::string& group) {
    lights.luminaires.push_back({"lamp", {}, group, WebLuminaire{of, {}, Spectrum(dimming / kWhiteEfficacy)}});
  };
  for (const double flux : {800, 200})
    lights.luminaires.push_back({"bulb", {}, "a", PointLuminaire{Spectrum(flux / kWhiteEfficacy)}});
  lamp(shared, 1, "a");
  lamp(shared, 0.5, "b");
  lamp(other, 1, "a");  // a file of the same name in another folder
  lamp(shared, 0.5, "a");

  const auto rows = luminaires_by_file(lights);
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].type, "point");
  EXPECT_EQ(rows[0].count, 2u);
  EXPECT_NEAR(rows[0].luminous_flux, 1000, 1e-9);
  EXPECT_EQ(rows[1].file, "lamp.ldt");
  EXPECT_EQ(rows[1].group, "a");
  EXPECT_EQ(rows[1].count, 2u);
  const double flux = 400 * std::numbers::pi;
  EXPECT_NEAR(rows[1].luminous_flux, 1.5 * flux, 1e-3);
  EXPECT_NEAR(rows[1].file_flux, flux, 1e-3);
  EXPECT_EQ(rows[1].declared_flux, 1250);
  EXPECT_EQ(rows[1].lamp_flux, 2500);
  EXPECT_EQ(rows[2].group, "b");
  EXPECT_NEAR(rows[2].luminous_flux, 0.5 * flux, 1e-3);
  EXPECT_EQ(rows[3].count, 1u);
}

TEST(DaylightReference, IsTheSkyAloneOnOpenGround) {
  LightSpec lights;
  EXPECT_FALSE(daylight_reference(lights));
  lights.sky = Sky{};
  EXPECT_FALSE(daylight_reference(lights)) << "a black sky is no reference";
  lights.sky->horizontal_irradiance = Spectrum(10'000 / kWhiteEfficacy);
  EXPECT_NEAR(daylight_reference(lights).value(), 10'000, 1e-9);
  lights.suns.push_back({{0, 0, 1}, Spectrum(1.0)});
  EXPECT_FALSE(daylight_reference(lights));
}

}  // namespace
}  // namespace clerestory
