// "sky", "sun", "location" and "time": what they become, and how they are refused.

#include <numbers>

#include <gtest/gtest.h>

#include "io/text.h"
#include "solver/model/perez.h"
#include "solver/model/solar_position.h"
#include "tests/io/reading.h"
#include "tests/io/weather_text.h"

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

class SkyEntries : public ::testing::Test {
 protected:
  SkyEntries() {
    folder_.write("room.obj", kRoomObj);
    folder_.write("city.epw", joined(weather_lines()));
  }
  static std::string with(const std::string& members) {
    return R"({ "geometry": [{ "file": "room.obj" }], )" + members + " }";
  }
  Scene read_with(const std::string& members) { return read_scene(folder_.write("s.json", with(members))); }
  std::string refusal_with(const std::string& members) { return refusal(folder_.write("s.json", with(members))); }

  TempFolder folder_;
};

const std::string kGolden = R"("location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7 })";
const std::string kExample = kGolden + R"(, "time": "2003-10-17T12:30:30")";

Vec3 sun_of_example(double north_deg = 0) {
  return scene_direction(sun_position({39.742476, -105.1786, -7}, {2003, 10, 17, 12 + 30.5 / 60}), north_deg);
}

TEST_F(SkyEntries, TheSunStandsWherePlaceAndTimeSay) {
  const Scene scene = read_with(R"("sun": { "normal_illuminance": 17900 }, )" + kExample);
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  EXPECT_NEAR(length(scene.lights.suns[0].direction - sun_of_example()), 0, 1e-12);
  EXPECT_NEAR(std::acos(scene.lights.suns[0].direction.z) * 180 / kPi, 50.11162, 0.01);
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].normal_irradiance[0], 100);
  EXPECT_EQ(all_warnings(scene).find("location"), std::string::npos) << all_warnings(scene);
}

TEST_F(SkyEntries, ASceneKeepsItsPlaceAndItsNorth) {
  const Scene scene =
      read_with(R"("location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7, "north": 120 })");
  ASSERT_TRUE(scene.place);
  EXPECT_EQ(scene.place->longitude_deg, -105.1786);
  EXPECT_EQ(scene.north_deg, 120);
  EXPECT_FALSE(read_with(R"("location": { "north": 30 })").place);
}

TEST_F(SkyEntries, TheSunInForceIsToldByTheCompass) {
  const std::string north = R"("time": "2003-10-17T12:30:30",
      "location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7, "north": 120 })";
  const Scene computed = read_with(R"("sun": { "normal_illuminance": 1 }, )" + north);
  ASSERT_TRUE(computed.daylight);
  // Reda & Andreas, 2004: zenith angle 50.11162, azimuth 194.34024 degrees; north of the scene does not change them.
  EXPECT_NEAR(computed.daylight->sun.elevation_deg, 90 - 50.11162, 0.01);
  EXPECT_NEAR(computed.daylight->sun.azimuth_deg, 194.34024, 0.01);
  ASSERT_TRUE(computed.daylight->time);
  EXPECT_NEAR(computed.daylight->time->hour, 12 + 30.5 / 60, 1e-9);
  EXPECT_FALSE(computed.daylight->weather);

  const Scene given = read_with(R"("sun": { "direction": [-3, 0, 4], "normal_illuminance": 1 })");
  ASSERT_TRUE(given.daylight);
  EXPECT_NEAR(given.daylight->sun.elevation_deg, std::asin(0.8) * 180 / kPi, 1e-9);
  EXPECT_NEAR(given.daylight->sun.azimuth_deg, 270, 1e-9);
  EXPECT_FALSE(given.daylight->time);

  EXPECT_FALSE(read_with(R"("sky": { "model": "cie-overcast", "horizontal_illuminance": 1 }, )" + kExample).daylight)
      << "an overcast sky goes by no sun";
}

TEST_F(SkyEntries, TheHourOfAWeatherFileIsTold) {
  const Scene scene = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T13:00")");
  ASSERT_TRUE(scene.daylight && scene.daylight->weather);
  EXPECT_EQ(scene.daylight->weather->file, "city.epw");
  EXPECT_EQ(scene.daylight->weather->month, 10);
  EXPECT_EQ(scene.daylight->weather->day, 17);
  EXPECT_EQ(scene.daylight->weather->hour, 13);
  EXPECT_NEAR(scene.daylight->time->hour, 12.5, 1e-9);
  EXPECT_NEAR(scene.daylight->sun.azimuth_deg, 194.2, 0.3);
  // By its number, and with the sun left out of the light.
  const Scene by_day = read_with(R"("sky": { "weather": "city.epw", "day_of_year": 290, "hour": 13 }, "sun": false)");
  EXPECT_EQ(by_day.daylight->weather->hour, 13);
  EXPECT_NEAR(by_day.daylight->sun.elevation_deg, scene.daylight->sun.elevation_deg, 1e-9);
}

TEST_F(SkyEntries, NorthTurnsTheSunClockwise) {
  const Scene scene = read_with(R"("sun": { "normal_illuminance": 1 }, "time": "2003-10-17T12:30:30",
      "location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7, "north": 90 })");
  // The sun in the south stands at -x when north is +x.
  EXPECT_LT(scene.lights.suns[0].direction.x, -0.7);
  EXPECT_NEAR(length(scene.lights.suns[0].direction - sun_of_example(90)), 0, 1e-12);
}

TEST_F(SkyEntries, ADirectionGivenWinsOverPlaceAndTime) {
  const Scene scene = read_with(R"("sun": { "direction": [0, 3, 4], "normal_illuminance": 1 }, )" + kExample);
  EXPECT_DOUBLE_EQ(scene.lights.suns[0].direction.y, 0.6);
  EXPECT_NE(all_warnings(scene).find("location and time are not used"), std::string::npos);
}

TEST_F(SkyEntries, ClearAndGeneralSkiesTakeTheSunFromEither) {
  const Scene clear = read_with(R"("sky": { "model": "cie-clear", "horizontal_illuminance": 17900 }, )" + kExample);
  EXPECT_EQ(clear.lights.sky->model, SkyModel::cie_clear);
  EXPECT_DOUBLE_EQ(clear.lights.sky->horizontal_irradiance[0], 100);
  EXPECT_NEAR(length(clear.lights.sky->sun - sun_of_example()), 0, 1e-12);
  EXPECT_TRUE(clear.lights.suns.empty());  // the sky without the sun's disc
  const Scene general = read_with(R"("sky": { "model": "cie-general", "type": 12, "horizontal_illuminance": 1 },
                                     "sun": { "direction": [0, 3, 4], "normal_illuminance": 0 })");
  EXPECT_EQ(general.lights.sky->shape.c, 10);
  EXPECT_DOUBLE_EQ(general.lights.sky->sun.z, 0.8);
  EXPECT_TRUE(general.lights.suns.empty());
  const Scene five = read_with(R"("sky": { "model": "cie-general", "type": 5, "horizontal_illuminance": 1 })");
  EXPECT_EQ(five.lights.sky->model, SkyModel::cie_general);
  const Scene sixteen = read_with(R"("sky": { "model": "cie-general", "type": 16, "horizontal_illuminance": 1 })");
  EXPECT_EQ(sixteen.lights.sky->model, SkyModel::cie_overcast);
}

TEST_F(SkyEntries, PerezGivesSunAndSkyTheirIlluminance) {
  // The row of skies.csv for 600 and 120 W/m2, sun at 50 degrees, day 172, 2 cm of water, but for the day's distance
  // to the sun, which a direction alone does not tell: it changes ln Delta by 3 %.
  const double h = 50 * kPi / 180;
  const Scene scene = read_with(text(R"("sky": { "model": "perez", "direct_normal": 600, "diffuse_horizontal": 120 },
      "sun": { "direction": [0, )",
                                     -std::cos(h), ", ", std::sin(h), "] }"));
  EXPECT_EQ(scene.lights.sky->model, SkyModel::perez);
  EXPECT_NEAR(179 * scene.lights.sky->horizontal_irradiance[0], 16181.3, 60);
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  EXPECT_NEAR(179 * scene.lights.suns[0].normal_irradiance[0], 61651, 100);
  const SkyMeasurement measured{600, 120, 40 * kPi / 180, std::nullopt, 2};
  EXPECT_NEAR(179 * scene.lights.suns[0].normal_irradiance[0], 600 * direct_efficacy(measured), 1e-3);
  EXPECT_NEAR(scene.lights.sky->shape.c, perez_shape(measured).c, 1e-6);
  EXPECT_NEAR(scene.lights.sky->sun.z, std::sin(h), 1e-9);
}

TEST_F(SkyEntries, SunFalseLeavesTheSkyAlone) {
  const std::string sky = R"("sky": { "model": "perez", "direct_normal": 600, "diffuse_horizontal": 120 }, )";
  const Scene with_sun = read_with(sky + kExample), without = read_with(sky + R"("sun": false, )" + kExample);
  EXPECT_EQ(with_sun.lights.suns.size(), 1u);
  EXPECT_TRUE(without.lights.suns.empty());
  EXPECT_EQ(with_sun.lights.sky->horizontal_irradiance, without.lights.sky->horizontal_irradiance);
  EXPECT_EQ(with_sun.lights.sky->shape.c, without.lights.sky->shape.c);
}

TEST_F(SkyEntries, DewPointAndPrecipitableWaterMoveTheEfficacies) {
  const auto sun_lux = [&](const std::string& water) {
    return read_with(R"("sky": { "model": "perez", "direct_normal": 600, "diffuse_horizontal": 120)" + water + " }, " +
                     kExample)
        .lights.suns.at(0)
        .normal_irradiance[0];
  };
  EXPECT_DOUBLE_EQ(sun_lux(""), sun_lux(R"(, "precipitable_water": 2)"));
  EXPECT_LT(sun_lux(R"(, "precipitable_water": 4)"), sun_lux(""));
  EXPECT_NEAR(sun_lux(R"(, "dew_point": 10)"), sun_lux(text(R"(, "precipitable_water": )", std::exp(0.7 - 0.075))),
              1e-6);
}

TEST_F(SkyEntries, WeatherFilesGiveTheHourThatEndsAtTheTime) {
  const Scene scene = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T13:00")");
  EXPECT_EQ(scene.lights.sky->model, SkyModel::perez);
  EXPECT_DOUBLE_EQ(179 * scene.lights.sky->horizontal_irradiance[0], 16000);
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  EXPECT_DOUBLE_EQ(179 * scene.lights.suns[0].normal_irradiance[0], 62000);
  // The sun of the middle of the hour, at the place of the file.
  const Vec3 sun = scene_direction(sun_position({39.742476, -105.1786, -7}, {2003, 10, 17, 12.5}));
  EXPECT_NEAR(length(scene.lights.suns[0].direction - sun), 0, 1e-12);
  EXPECT_EQ(all_warnings(scene).find("s.json"), std::string::npos) << all_warnings(scene);
}

TEST_F(SkyEntries, MinutesMoveTheSunWithinTheHour) {
  const Scene scene = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T12:30:30")");
  EXPECT_DOUBLE_EQ(179 * scene.lights.sky->horizontal_irradiance[0], 16000);  // hour 13
  EXPECT_NEAR(length(scene.lights.suns[0].direction - sun_of_example()), 0, 1e-12);
}

TEST_F(SkyEntries, DayOfYearAndHourChooseTheSameHour) {
  const Scene by_time = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T13:00")");
  const Scene by_day = read_with(R"("sky": { "weather": "city.epw", "day_of_year": 290, "hour": 13 })");
  EXPECT_EQ(by_time.lights.suns.at(0).direction, by_day.lights.suns.at(0).direction);
  EXPECT_EQ(by_time.lights.sky->horizontal_irradiance, by_day.lights.sky->horizontal_irradiance);
}

TEST_F(SkyEntries, MissingIlluminancesAreDerivedAndSaidSo) {
  const Scene scene = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T12:00")");
  EXPECT_NE(all_warnings(scene).find("city.epw:20: has no illuminances for this hour; they are derived"),
            std::string::npos)
      << all_warnings(scene);
  const double Z = std::acos(scene.lights.suns.at(0).direction.z);
  const SkyMeasurement measured{500, 100, Z, 290, precipitable_water(2)};
  EXPECT_NEAR(179 * scene.lights.suns.at(0).normal_irradiance[0], 500 * direct_efficacy(measured), 1e-6);
  EXPECT_NEAR(179 * scene.lights.sky->horizontal_irradiance[0], 100 * diffuse_efficacy(measured), 1e-6);
}

TEST_F(SkyEntries, IlluminancesThatAreNoDaylightAreDerivedAsIfMissing) {
  // 600 and 120 W/m2 in hour 13: klux, hundredths, fillers, the sun's light for the sky's.
  const auto lines = [](const std::string& direct, const std::string& diffuse) {
    std::vector<std::string> all = weather_lines();
    std::string& row = all[20];
    row.replace(row.find("62000,16000"), 11, direct + "," + diffuse);
    return joined(all);
  };
  const auto light = [&](const std::string& direct, const std::string& diffuse) {
    folder_.write("city.epw", lines(direct, diffuse));
    return read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T13:00")");
  };
  const Scene missing = light("999999", "999999");
  for (const auto& [direct, diffuse] :
       {std::pair{"62", "16"}, {"620", "160"}, {"9999", "9999."}, {"99999", "99999"}, {"62000", "62000"}, {"", ""}}) {
    const Scene scene = light(direct, diffuse);
    EXPECT_EQ(scene.lights.sky->horizontal_irradiance, missing.lights.sky->horizontal_irradiance) << direct;
    EXPECT_EQ(scene.lights.suns.at(0).normal_irradiance, missing.lights.suns.at(0).normal_irradiance) << direct;
    EXPECT_NE(all_warnings(scene).find("derived from its radiation by the efficacies of Perez"), std::string::npos);
  }
  EXPECT_EQ(all_warnings(light("62", "16")).substr(0, 170),
            "city.epw:21: its direct normal illuminance, 62 lx for 600 W/m2, is no daylight, which has 30 to 250 lm/W; "
            "the illuminances of this hour are derived from its radiation by ");
  // What the instruments round to is no reason to doubt them.
  EXPECT_DOUBLE_EQ(179 * light("62000", "26000").lights.sky->horizontal_irradiance[0], 26000);
}

TEST_F(SkyEntries, ASunWithoutDiffuseLightHasTheEfficacyOfTheClearestSky) {
  // Perez et al. 1990, table 4, clearest bin: 101.18 + 1.58 W - 1.10 exp(5.73 Z - 5) - 8.29 Delta, Delta at its least.
  const double Z = 40 * kPi / 180;
  const double exact = 101.18 + 1.58 * 2 - 1.10 * std::exp(5.73 * Z - 5) - 8.29 * 0.01;
  EXPECT_NEAR(direct_efficacy({600, 0, Z, std::nullopt, 2}), exact, 1e-9);
  EXPECT_NEAR(direct_efficacy({600, 1e-9, Z, std::nullopt, 2}), exact, 1e-9);
  const Scene scene = read_with(R"("sky": { "model": "perez", "direct_normal": 600, "diffuse_horizontal": 0 },
                                    "sun": { "direction": [0, 0.6427876096865393, 0.766044443118978] })");
  EXPECT_NEAR(179 * scene.lights.suns.at(0).normal_irradiance[0], 600 * exact, 1e-6);
  EXPECT_TRUE(scene.lights.sky->horizontal_irradiance.is_black());
}

TEST_F(SkyEntries, OneBadHourIsNoReasonAgainstAnother) {
  std::vector<std::string> lines = weather_lines();
  const auto spoil = [&](int hour, const std::string& radiation) {
    std::string& row = lines[static_cast<std::size_t>(7 + hour)];
    const std::size_t begin = row.find(",300,") + 5;
    row.replace(begin, row.find(",200,") - begin, "400," + radiation + ",0,0,0,9999");
  };
  spoil(8, "broken,100"), spoil(9, "-9999,-9999"), spoil(10, ","), spoil(2, ","), spoil(1, "0,-1.3"),
      spoil(11, "500,7000");
  lines[19] = "2003,10,17,12,0,?9?9,11.0";
  folder_.write("city.epw", joined(lines));
  const auto at = [](const char* hour) {
    return R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T)" + std::string(hour) + ":00\"";
  };
  EXPECT_DOUBLE_EQ(179 * read_with(at("13")).lights.sky->horizontal_irradiance[0], 16000);
  EXPECT_TRUE(read_with(at("01")).lights.sky->horizontal_irradiance.is_black());
  EXPECT_TRUE(read_with(at("02")).lights.sky->horizontal_irradiance.is_black()) << "at night nothing is missed";
  const std::string advice = "; choose another hour, or give direct_normal and diffuse_horizontal in the scene file";
  EXPECT_EQ(refusal_with(at("08")), "city.epw:16: the direct normal radiation = 'broken' is not a number" + advice);
  EXPECT_EQ(refusal_with(at("09")), "city.epw:17: the direct normal radiation of this hour is missing" + advice);
  EXPECT_EQ(refusal_with(at("10")), "city.epw:18: the direct normal radiation of this hour is missing" + advice);
  EXPECT_EQ(refusal_with(at("11")),
            "city.epw:19: the diffuse horizontal radiation = 7000 is outside [0, 1500] W/m2" + advice);
  EXPECT_EQ(refusal_with(at("12")),
            "city.epw:20: has 7 values; an hour has 35. The file is damaged or cut short" + advice);
}

TEST_F(SkyEntries, ALongitudeThatDoesNotFitItsTimezoneIsWarnedOf) {
  const auto at = [](double longitude, double timezone) {
    return text(R"("sun": { "normal_illuminance": 1 }, "time": "2003-06-21T12:00", "location": { "latitude": 42,
                "longitude": )",
                longitude, R"(, "timezone": )", timezone, " }");
  };
  const std::string odd = "hours of the sun apart; longitude counts east positive";
  EXPECT_NE(
      all_warnings(read_with(at(87.92, -6))).find("s.json: location: longitude 87.92 and timezone -6 are 11.9 " + odd),
      std::string::npos);
  EXPECT_NE(all_warnings(read_with(at(87.92, -6)))
                .find("below the horizon and gives no light; longitude and timezone do not fit each other"),
            std::string::npos);
  EXPECT_NE(all_warnings(read_with(at(-151.21, 10))).find(odd), std::string::npos);  // Sydney, on the other side
  EXPECT_EQ(all_warnings(read_with(at(-87.92, -6))).find("longitude"), std::string::npos);
  EXPECT_EQ(all_warnings(read_with(at(-157.4, 14))).find("longitude"),
            std::string::npos);  // Kiritimati, across the date line
  EXPECT_EQ(all_warnings(read_with(at(75.99, 8))).find("longitude"),
            std::string::npos);  // Kashgar by the clock of Beijing
  std::vector<std::string> lines = weather_lines();
  lines[0].replace(lines[0].find("-105"), 4, "105");
  folder_.write("city.epw", joined(lines));
  EXPECT_NE(all_warnings(read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T13:00")"))
                .find("city.epw: longitude 105.1786 and timezone -7 are 10 hours"),
            std::string::npos);
}

TEST_F(SkyEntries, WeatherScalesTheOtherSkiesToo) {
  const Scene scene = read_with(R"("sky": { "model": "cie-overcast", "weather": "city.epw" }, "sun": false,
                                   "time": "2003-10-17T13:00")");
  EXPECT_EQ(scene.lights.sky->model, SkyModel::cie_overcast);
  EXPECT_DOUBLE_EQ(179 * scene.lights.sky->horizontal_irradiance[0], 16000);
  EXPECT_TRUE(scene.lights.suns.empty());
}

TEST_F(SkyEntries, AHourAtSunriseTakesTheSunWhileItIsUp) {
  // Sunrise is at 6:14: the values of hour 7 belong to 6:14 to 7:00, and so does the sun. Hour 6 is night.
  std::vector<std::string> lines = weather_lines();
  const Scene scene = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T07:00")");
  ASSERT_EQ(scene.lights.suns.size(), 1u);
  const Vec3 middle = scene_direction(sun_position({39.742476, -105.1786, -7}, {2003, 10, 17, 6.5}));
  EXPECT_GT(scene.lights.suns[0].direction.z, middle.z);
  const Scene night = read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T03:00")");
  EXPECT_TRUE(night.lights.suns.empty());
  EXPECT_EQ(night.lights.sky->horizontal_irradiance[0], 0);
  EXPECT_NE(all_warnings(night).find("degrees below the horizon and gives no light"), std::string::npos);
}

TEST_F(SkyEntries, MidnightIsTheLastHourOfTheDayBefore) {
  EXPECT_NO_THROW(read_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-18T00:00")"));
  EXPECT_EQ(refusal_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T00:00")"),
            "city.epw: has no hour 24 of 10/16 (month/day); it goes from 10/17 to 10/17");
}

TEST_F(SkyEntries, ASunBelowTheHorizonIsDarkWithAWarning) {
  const Scene scene = read_with(R"("sky": { "model": "cie-clear", "horizontal_illuminance": 100 },
      "sun": { "normal_illuminance": 80000 }, "time": "2003-10-17T00:00", )" +
                                kGolden);
  EXPECT_TRUE(scene.lights.suns.empty());
  EXPECT_NE(all_warnings(scene).find("degrees below the horizon and gives no light"), std::string::npos);
}

TEST_F(SkyEntries, KeysThatAModelHasNoUseForAreNamed) {
  const Scene scene = read_with(R"("sky": { "model": "uniform", "horizontal_illuminance": 1, "type": 3,
                                   "direct_normal": 5, "rotation": 20, "hour": 3 })");
  for (const char* key : {"type", "direct_normal", "rotation"})
    EXPECT_NE(all_warnings(scene).find(text("sky.", key, " is not used by the sky uniform")), std::string::npos);
  EXPECT_NE(all_warnings(scene).find("sky.hour is not used without \"weather\""), std::string::npos);
}

// What is refused.

TEST_F(SkyEntries, SkiesThatNeedTheSunSayHowToPlaceIt) {
  EXPECT_EQ(
      refusal_with(R"("sky": { "model": "cie-clear" })"),
      "s.json: sky.model 'cie-clear' needs to know where the sun stands; give \"location\" with latitude, longitude "
      "and timezone, and \"time\", or \"sun\": { \"direction\": [0.3, -0.5, 0.8] }");
  EXPECT_EQ(
      refusal_with(R"("sky": { "model": "cie-general", "type": 12 }, )" + kGolden),
      "s.json: sky.model 'cie-general' needs to know where the sun stands; give \"time\": \"2026-03-21T12:00\", or "
      "\"sun\": { \"direction\": [0.3, -0.5, 0.8] }");
  EXPECT_NE(refusal_with(R"("sky": { "model": "perez", "direct_normal": 1, "diffuse_horizontal": 1 })")
                .find("sky.model 'perez' needs to know where the sun stands"),
            std::string::npos);
  EXPECT_NE(refusal_with(R"("sun": { "normal_illuminance": 1 }, "time": "2003-10-17T12:00")")
                .find("s.json: sun.direction is missing; give \"location\""),
            std::string::npos);
}

TEST_F(SkyEntries, MissingKeysAreNamed) {
  EXPECT_EQ(refusal_with(R"("sky": { "model": "cie-general" })"),
            "s.json: sky.type is missing; the sky cie-general has types 1 to 16");
  EXPECT_EQ(
      refusal_with(R"("sky": { "model": "perez", "direct_normal": 1 }, )" + kExample),
      "s.json: sky.diffuse_horizontal is missing; the sky perez needs direct_normal and diffuse_horizontal in W/m2, "
      "or a \"weather\" file");
  EXPECT_EQ(refusal_with(R"("sun": { "direction": [0, 0, 1] })"),
            "s.json: sun.normal_illuminance is missing; a clear sun gives up to 100000 lx, 0 only shows the sky where "
            "the sun stands");
  EXPECT_EQ(refusal_with(R"("location": { "latitude": 48.8, "longitude": 2.3 })"),
            "s.json: location.timezone is missing; a place needs latitude and longitude in degrees and its timezone in "
            "hours ahead of UTC");
  EXPECT_EQ(refusal_with(R"("sky": { "weather": "city.epw" })"),
            "s.json: time is missing; which hour of the weather file? Write \"time\": \"2026-03-21T12:00\", or "
            "day_of_year and hour into the sky");
  EXPECT_EQ(refusal_with(R"("sky": { "weather": "city.epw", "day_of_year": 3 })"), "s.json: sky.hour is missing");
  EXPECT_NE(refusal_with(R"("sky": { "weather": "none.epw" }, "time": "2003-10-17T12:00")")
                .find("s.json: sky.weather 'none.epw': there is no file"),
            std::string::npos);
}

TEST_F(SkyEntries, UnknownModelsListTheKnownOnes) {
  EXPECT_EQ(
      refusal_with(R"("sky": { "model": "blue" })"),
      "s.json: sky.model 'blue' is not known; known are uniform, cie-overcast, cie-clear, cie-general, perez, image");
}

TEST_F(SkyEntries, ValuesOutOfRangeAreRefused) {
  EXPECT_EQ(refusal_with(R"("sky": { "model": "cie-general", "type": 17 })"),
            "s.json: sky.type = 17 is outside [1, 16]; the CIE numbers its general skies 1 to 16.");
  EXPECT_EQ(refusal_with(R"("sky": { "model": "cie-general", "type": 2.5 })"),
            "s.json: sky.type = 2.5 is not a whole number");
  EXPECT_EQ(refusal_with(R"("sky": { "model": "perez", "direct_normal": -1, "diffuse_horizontal": 1 })"),
            "s.json: sky.direct_normal = -1 is outside [0, 10000]; it is in W/m2; the sun outside the air gives 1367.");
  EXPECT_EQ(refusal_with(R"("sky": { "weather": "city.epw", "day_of_year": 366, "hour": 1 })"),
            "s.json: sky.day_of_year = 366 is outside [1, 365]; weather files have years of 365 days.");
  EXPECT_EQ(refusal_with(R"("sun": true)"), "s.json: sun must be an object, not true or false (true)");
}

TEST_F(SkyEntries, TwoKeysForOneThingAreRefused) {
  EXPECT_EQ(
      refusal_with(R"("sky": { "weather": "city.epw", "horizontal_illuminance": 1 }, "time": "2003-10-17T12:00")"),
      "s.json: sky: weather and horizontal_illuminance both say how bright the sky is; keep one of them");
  EXPECT_EQ(
      refusal_with(R"("sky": { "weather": "city.epw", "day_of_year": 290, "hour": 13 }, "time": "2003-10-17T12:00")"),
      "s.json: time and s.json: sky.day_of_year both choose an hour; keep one of them");
}

TEST_F(SkyEntries, AnHourMarkedAsMissingIsRefusedWithItsLine) {
  EXPECT_EQ(refusal_with(R"("sky": { "weather": "city.epw" }, "time": "2003-10-17T15:00")"),
            "city.epw:23: the direct normal radiation of this hour is missing; choose another hour, or give "
            "direct_normal and diffuse_horizontal in the scene file");
}

TEST_F(SkyEntries, TheOptionTakesSkiesThatNeedNoSun) {
  const std::string room = folder_ / "room.obj";
  const auto option = [&](const char* sky) { return ReadOptions{.unit = {}, .up = {}, .sky = sky}; };
  EXPECT_EQ(read_scene(room, option("cie-general-5:17900")).lights.sky->horizontal_irradiance, Spectrum(100));
  EXPECT_EQ(read_scene(room, option("cie-general-16")).lights.sky->model, SkyModel::cie_overcast);
  EXPECT_EQ(
      refusal(room, option("cie-clear:10000")),
      "--sky 'cie-clear' needs more than a name; write a scene file with \"sky\": { \"model\": \"cie-clear\" } and "
      "\"sun\", or \"location\" and \"time\"");
  for (const char* name : {"cie-general", "perez", "image"})
    EXPECT_NE(refusal(room, option(name)).find("needs more than a name; write a scene file with"), std::string::npos);
  EXPECT_NE(refusal(room, option("cie-general-12")).find("without a sun there are the types 1, 3, 5 and 16"),
            std::string::npos);
}

}  // namespace
}  // namespace clerestory
