// Skies against formulas and the reference rows, and against their own quadrature.

#include "solver/lights/sky.h"

#include <array>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>

#include "solver/lights/sun.h"
#include "solver/model/perez.h"
#include "solver/model/random_stream.h"
#include "solver/model/solar_position.h"
#include "solver/sampling/unit_square.h"
#include "tests/support/sky_irradiance.h"
#include "tests/support/sky_rows.h"

namespace clerestory {
namespace {

using test::sky_irradiance;

constexpr double kPi = std::numbers::pi;

Vec3 direction(double elevation_deg, double azimuth_deg = 180) { return scene_direction({elevation_deg, azimuth_deg}); }

/// A sky of horizontal irradiance 1.
Lights with_shape(const SkyShape& shape, const Vec3& sun) {
  Lights lights;
  lights.sky = Sky{.model = SkyModel::cie_general,
                   .horizontal_irradiance = Spectrum(1),
                   .ground_reflectance = 0,
                   .shape = shape,
                   .sun = sun};
  return lights;
}

Lights with_model(SkyModel model) {
  Lights lights;
  lights.sky = Sky{.model = model, .horizontal_irradiance = Spectrum(1), .ground_reflectance = 0};
  return lights;
}

SkyMeasurement measurement(const std::string& config) {
  return {.direct_normal = test::number_behind(config, "DNI="),
          .diffuse_horizontal = test::number_behind(config, "DHI="),
          .zenith_angle = (90 - test::number_behind(config, "sun elevation ")) * kPi / 180,
          .day_of_year = static_cast<int>(test::number_behind(config, "day of year ")),
          .precipitable_water = test::number_behind(config, "precipitable water ")};
}

Vec3 facing(char letter) {
  return letter == 'S'   ? Vec3{0, -1, 0}
         : letter == 'N' ? Vec3{0, 1, 0}
         : letter == 'E' ? Vec3{1, 0, 0}
                         : Vec3{-1, 0, 0};
}

TEST(SkyReference, CieSkiesHaveTheIntegralsFacadesAndLuminancesOfTheirRows) {
  const auto rows = test::sky_rows("cie_general");
  double worst_integral = 0, worst_facade = 0, worst_luminance = 0;
  for (const test::SkyRow& row : rows) {
    const bool has_sun = row.config.starts_with("sun");
    const double elevation = has_sun ? test::number_behind(row.config, "elevation ") : 45;
    const Vec3 sun = direction(elevation);
    const bool overcast = row.model.find("type ") == std::string::npos;
    const SkyRadiance sky(
        overcast ? with_model(SkyModel::cie_overcast)
                 : with_shape(cie_general_shape(static_cast<int>(test::number_behind(row.model, "type "))), sun));
    const double zenith = sky({0, 0, 1})[0];
    double value = 0;
    double* worst = &worst_luminance;
    if (row.quantity == "E_h/L_z") {
      value = 1 / zenith, worst = &worst_integral;
    } else if (row.quantity.starts_with("E_v(")) {
      value = sky_irradiance(sky, facing(row.quantity[4])), worst = &worst_facade;
    } else if (row.quantity == "L/L_z at sun position") {
      // Without a sun the rows take the elevation of 60 degrees.
      value = sky(direction(has_sun ? elevation : 60))[0] / zenith;
    } else {
      const double Z = test::number_behind(row.quantity, "zenith angle ");
      value = sky(direction(90 - Z, test::number_behind(row.quantity, "azimuth ")))[0] / zenith;
    }
    *worst = std::max(*worst, std::abs(value / row.value - 1));
    EXPECT_NEAR(value, row.value, 1e-4 * row.value) << row.model << ", " << row.config << ": " << row.quantity;
  }
  std::printf("cie_general, %zu rows: worst relative error of E_h/L_z %.1e, of E_v %.1e, of L/L_z %.1e\n", rows.size(),
              worst_integral, worst_facade, worst_luminance);
}

TEST(SkyReference, ClearOvercastAndUniformSkiesHaveTheValuesOfTheirRows) {
  const auto clear = test::sky_rows("cie_clear");
  double worst = 0;
  for (const test::SkyRow& row : clear) {
    const double elevation = test::number_behind(row.config, "elevation ");
    const double value = 1 / SkyRadiance(with_shape(cie_clear_shape(), direction(elevation)))({0, 0, 1})[0];
    worst = std::max(worst, std::abs(value / row.value - 1));
    EXPECT_NEAR(value, row.value, 1e-5 * row.value) << row.config;
  }
  for (const char* group : {"uniform", "cie_overcast"}) {
    const SkyRadiance sky(with_model(group[0] == 'u' ? SkyModel::uniform : SkyModel::cie_overcast));
    const double zenith = sky({0, 0, 1})[0];
    for (const test::SkyRow& row : test::sky_rows(group)) {
      const bool integral = row.quantity == "E_h/L_z", facade = row.quantity.starts_with("E_v");
      const double value = integral ? 1 / zenith : facade ? sky_irradiance(sky, {1, 0, 0}) : 10000 * zenith;
      worst = std::max(worst, std::abs(value / row.value - 1));
      EXPECT_NEAR(value, row.value, 1e-5 * row.value) << group << ": " << row.quantity;
    }
  }
  std::printf("uniform, cie_overcast, cie_clear: worst relative error %.1e\n", worst);
}

TEST(SkyReference, PerezSkiesHaveTheValuesOfTheirRows) {
  const auto rows = test::sky_rows("perez");
  double worst_formula = 0, worst_sky = 0;
  for (const test::SkyRow& row : rows) {
    const SkyMeasurement m = measurement(row.config);
    const SkyCondition condition = sky_condition(m);
    const SkyShape shape = perez_shape(m);
    const Vec3 sun = direction(90 - m.zenith_angle * 180 / kPi);
    const double diffuse = m.diffuse_horizontal * diffuse_efficacy(m), direct = m.direct_normal * direct_efficacy(m);
    const std::string& q = row.quantity;
    double value = 0;
    bool of_sky = false;
    if (q == "air mass")
      value = condition.air_mass;
    else if (q.starts_with("epsilon"))
      value = condition.clearness;
    else if (q.starts_with("Delta"))
      value = condition.brightness;
    else if (q.starts_with("clearness bin"))
      value = condition.bin + 1;
    else if (q == "a")
      value = shape.a;
    else if (q == "b")
      value = shape.b;
    else if (q == "c")
      value = shape.c;
    else if (q == "d")
      value = shape.d;
    else if (q == "e")
      value = shape.e;
    else if (q == "diffuse luminous efficacy")
      value = diffuse_efficacy(m);
    else if (q == "direct luminous efficacy")
      value = direct_efficacy(m);
    else if (q == "diffuse horizontal illuminance")
      value = diffuse;
    else if (q == "direct normal illuminance")
      value = direct;
    else if (q == "global horizontal illuminance")
      value = diffuse + direct * std::cos(m.zenith_angle);
    else if (q.starts_with("int L_rel"))
      value = horizontal_integral(shape, kPi / 2 - m.zenith_angle), of_sky = true;
    else if (q == "zenith luminance")
      value = diffuse * SkyRadiance(with_shape(shape, sun))({0, 0, 1})[0], of_sky = true;
    else if (q.starts_with("diffuse E_v(")) {
      value = sky_irradiance(SkyRadiance(with_shape(shape, sun)), facing(q[12])), of_sky = true;
    } else {
      FAIL() << "no test for " << q;
    }
    const double error = std::abs(value - row.value) / std::max(1e-9, std::abs(row.value));
    double& worst = of_sky ? worst_sky : worst_formula;
    if (row.value != 0) worst = std::max(worst, error);
    EXPECT_NEAR(value, row.value, (of_sky ? 1e-4 : 1e-8) * std::abs(row.value) + 1e-12) << row.config << ": " << q;
  }
  std::printf("perez, %zu rows: worst relative error of formulas %.1e, of integrals and luminances %.1e\n", rows.size(),
              worst_formula, worst_sky);
}

/// x1 + x2 Z + Delta (x3 + x4 Z) and the like: the row of perez_coefficients.csv.
std::array<double, 4> perez_row(const std::string& table, int bin, const std::string& parameter = "") {
  for (test::CsvRow& row : test::reference_table("perez_coefficients.csv"))
    if (row["table"] == table && row["bin"] == std::to_string(bin) && row["parameter"] == parameter)
      return {std::stod(row["x1"]), std::stod(row["x2"]), std::stod(row["x3"]), std::stod(row["x4"])};
  throw std::runtime_error("no row " + table + " " + parameter);
}

TEST(SkyReference, PerezModelHasThePublishedCoefficientsInEveryBinOfClearness) {
  // A sun at 40 degrees from the zenith and 150 W/m2 of sky; the sun's own light in the middle of the bin. There no
  // value is at the rim of its range (Delta = 0.145 in bins 1, 6, 7 and 8, 0.2 in bins 2 to 5; b below -0.01).
  const std::array<double, 9> edge = {1, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2, 12.01};
  const double Z = 40 * kPi / 180, cube = 1.041 * Z * Z * Z;
  for (int bin = 1; bin <= 8; ++bin) {
    SCOPED_TRACE(bin);
    const auto k = static_cast<std::size_t>(bin);
    const double clearness = (edge[k - 1] + edge[k]) / 2;
    const SkyMeasurement m{150 * (clearness - 1) * (1 + cube), 150, Z, 172, 1.5};
    const SkyCondition sky = sky_condition(m);
    ASSERT_EQ(sky.bin + 1, bin);
    const double Delta = bin >= 2 && bin <= 5 ? std::max(0.2, sky.brightness) : sky.brightness;
    const auto value = [&](const char* parameter) {
      const auto x = perez_row("luminance", bin, parameter);
      return x[0] + x[1] * Z + Delta * (x[2] + x[3] * Z);
    };
    const SkyShape shape = perez_shape(m);
    EXPECT_DOUBLE_EQ(shape.a, value("a"));
    EXPECT_DOUBLE_EQ(shape.b, value("b"));
    EXPECT_DOUBLE_EQ(shape.e, value("e"));
    if (bin > 1) {
      EXPECT_DOUBLE_EQ(shape.c, value("c"));
      EXPECT_DOUBLE_EQ(shape.d, value("d"));
    } else {
      const auto c = perez_row("luminance", 1, "c"), d = perez_row("luminance", 1, "d");
      EXPECT_DOUBLE_EQ(shape.c, std::exp(std::pow(Delta * (c[0] + c[1] * Z), c[2])) - c[3]);
      EXPECT_DOUBLE_EQ(shape.d, -std::exp(Delta * (d[0] + d[1] * Z)) + d[2] + Delta * d[3]);
    }
    const auto f = perez_row("diffuse_efficacy", bin), g = perez_row("direct_efficacy", bin);
    EXPECT_DOUBLE_EQ(diffuse_efficacy(m), f[0] + f[1] * 1.5 + f[2] * std::cos(Z) + f[3] * std::log(sky.brightness));
    EXPECT_DOUBLE_EQ(direct_efficacy(m), g[0] + g[1] * 1.5 + g[2] * std::exp(5.73 * Z - 5) + g[3] * sky.brightness);
  }
}

TEST(SkyRadiance, OfAShapeGivesItsHorizontalIrradianceWhereverTheSunStands) {
  for (const double elevation : {-5.0, 0.0, 0.5, 20.0, 65.0, 89.9, 90.0}) {
    for (int type = 1; type <= 15; ++type) {
      const SkyRadiance sky(with_shape(cie_general_shape(type), direction(elevation, 77)));
      EXPECT_NEAR(sky_irradiance(sky, {0, 0, 1}), 1, 3e-5) << "type " << type << ", sun at " << elevation;
    }
    for (const auto& [direct, diffuse] : {std::pair{0.0, 100.0}, {50.0, 150.0}, {600.0, 120.0}, {900.0, 60.0}}) {
      const SkyMeasurement m{direct, diffuse, (90 - elevation) * kPi / 180, 100, 2};
      const SkyRadiance sky(with_shape(perez_shape(m), direction(elevation, 77)));
      EXPECT_NEAR(sky_irradiance(sky, {0, 0, 1}), 1, 2e-4) << direct << ", " << diffuse << ", sun at " << elevation;
    }
  }
}

TEST(SkyRadiance, OfPerezIsFiniteAndHasLightForAnyMeasurement) {
  for (const double Z : {0.0, 0.1, 0.4, 0.8, 1.2, 1.4, 1.55, 1.6, 2.0})
    for (const double direct : {0.0, 1.0, 10.0, 50.0, 100.0, 200.0, 300.0, 500.0, 700.0, 900.0, 1367.0, 10000.0})
      for (const double diffuse : {0.0, 0.5, 5.0, 20.0, 60.0, 120.0, 250.0, 500.0, 10000.0}) {
        const SkyMeasurement m{direct, diffuse, Z, 100, 2};
        const double integral = horizontal_integral(perez_shape(m), kPi / 2 - Z);
        EXPECT_TRUE(integral > 1e-4 && integral < 1e4) << Z << ", " << direct << ", " << diffuse << ": " << integral;
        EXPECT_TRUE(std::isfinite(diffuse_efficacy(m)) && std::isfinite(direct_efficacy(m)));
      }
}

/// Largest relative error of the table at random directions and close to the sun.
double table_error(const SkyShape& shape, const Vec3& sun) {
  const SkyShapeTable table(shape, sun);
  double worst = 0;
  for (std::uint32_t k = 0; k < 20000; ++k) {
    const auto u = sobol4(k, 7);
    Vec3 d = sphere_direction(u[0], u[1]);
    if (k % 2) d = normalized(sun + d * (0.1 * u[2]));
    if (k % 5 == 0) d.z *= 0.01;
    d = normalized({d.x, d.y, std::abs(d.z)});
    const double cos_chi = dot(d, sun), chi = std::atan2(length(cross(d, sun)), cos_chi);
    const double exact = shape.gradation(d.z) * shape.indicatrix(chi, cos_chi);
    if (exact > 1e-3) worst = std::max(worst, std::abs(table(d) / exact - 1));
  }
  return worst;
}

TEST(SkyShapeTable, IsWithinATenThousandthOfItsFormula) {
  double cie = 0, perez = 0;
  for (int type = 1; type <= 15; ++type) cie = std::max(cie, table_error(cie_general_shape(type), direction(35, 200)));
  cie = std::max(cie, table_error(cie_clear_shape(), direction(10, 30)));
  for (double Z = 0.05; Z < 1.5; Z += 0.2)
    for (const double direct : {0.0, 20.0, 100.0, 200.0, 400.0, 600.0, 900.0})
      for (const double diffuse : {20.0, 60.0, 120.0, 250.0}) {
        const SkyMeasurement m{direct, diffuse, Z, 100, 2};
        perez = std::max(perez, table_error(perez_shape(m), direction(90 - Z * 180 / kPi)));
      }
  std::printf("tables: worst relative error of CIE skies %.1e, of Perez' %.1e\n", cie, perez);
  EXPECT_LT(cie, 1e-6);
  EXPECT_LT(perez, 5e-5);
}

TEST(SkyRadiance, StaysFiniteAndPositiveForDirectionsThatAreNotQuiteUnit) {
  const SkyRadiance sky(with_shape(cie_general_shape(12), direction(90)));
  for (const double scale : {1 - 1e-7, 1.0, 1 + 1e-7})
    for (const Vec3& d : {Vec3{0, 0, 1}, Vec3{0, 0, -0.0}, Vec3{1, 0, 0}, Vec3{0, 1, 1e-300}, direction(90)}) {
      EXPECT_GE(sky(d * scale)[0], 0);
      EXPECT_LT(sky(d * scale)[0], 1e3);
    }
}

TEST(SkyImage, OfOneValueIsTheUniformSkyAndTurnsWithItsMiddle) {
  auto image = std::make_shared<SkyImage>();
  image->width = 8, image->height = 4;
  image->value.assign(3 * 8 * 4, 2.0f);
  EXPECT_NEAR(horizontal_irradiance(*image)[0], 2 * kPi, 1e-12);
  // A bright pixel above the horizon right of the middle: north-north-east when the middle is north.
  for (std::size_t k = 0; k < 3; ++k) image->value[3 * (1 * 8 + 4) + k] = 50;
  EXPECT_EQ(image->radiance(direction(30, 22.5))[0], 50);
  EXPECT_EQ(image->radiance(direction(30, -22.5))[0], 2);
  image->middle_deg = 90;
  EXPECT_EQ(image->radiance(direction(30, 112.5))[0], 50);
  EXPECT_EQ(image->radiance(direction(30, 22.5))[0], 2);
  // Its pixel covers 45 to 90 degrees from the zenith, an eighth of the circle.
  EXPECT_NEAR(horizontal_irradiance(*image)[0], 2 * kPi + 48 * kPi / 8 * 0.5, 1e-12);
}

TEST(SkyImage, LightsTheGroundOrBringsItsOwn) {
  auto image = std::make_shared<SkyImage>();
  image->width = 4, image->height = 2;
  image->value.assign(3 * 4 * 2, 1.0f);
  for (std::size_t i = 12; i < 24; ++i) image->value[i] = 0.25f;
  Lights lights;
  lights.sky = Sky{.model = SkyModel::image,
                   .horizontal_irradiance = horizontal_irradiance(*image),
                   .ground_reflectance = 0.5,
                   .image = image};
  EXPECT_NEAR(SkyRadiance(lights)(direction(-40))[0], 0.5, 1e-12);
  lights.sky->image_has_ground = true;
  EXPECT_NEAR(SkyRadiance(lights)(direction(-40))[0], 0.25, 1e-12);
  EXPECT_NEAR(SkyRadiance(lights)(direction(40))[0], 1, 1e-12);
}

TEST(SunReference, HasTheSolidAngleOfItsRow) {
  const auto rows = test::sky_rows("sun");
  const double half = kSunDiameterDeg / 2 * kPi / 180, solid_angle = 4 * kPi * std::pow(std::sin(half / 2), 2);
  for (const test::SkyRow& row : rows) {
    if (row.quantity == "luminance") {
      EXPECT_NEAR(100000 / solid_angle, row.value, 1e-8 * row.value);
    } else if (row.model.find("0.533") != std::string::npos) {
      EXPECT_NEAR(solid_angle, row.value, 1e-9 * row.value);
    }
  }
}

}  // namespace
}  // namespace clerestory
