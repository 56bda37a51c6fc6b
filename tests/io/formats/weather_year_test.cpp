// A whole year of a weather file: its hours, what is missing or too much, and the light on open ground.

#include "io/formats/weather_year.h"

#include <algorithm>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "io/input_file.h"
#include "io/read_scene.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "tests/io/reading.h"
#include "tests/io/weather_text.h"

namespace clerestory {
namespace {

namespace fs = std::filesystem;

fs::path weather_folder() { return fs::path(CLERESTORY_SOURCE_DIR) / "../shared/data/weather"; }
const char* const kFiles[] = {"USA_CO_Denver.Intl.AP.725650_TMY3.epw", "USA_HI_Honolulu.Intl.AP.911820_TMY3.epw"};

DaylightYear year_of(const Weather& weather) { return daylight_year(weather, weather.place, 0, 0.2); }

/// Golden, with 100 W/m2 of the sky from 6 to 18 h of each day, and 500 of the sun while it is up the whole year, from
/// 8 to 16 h.
Weather even_year() {
  Weather weather{"even.epw", "Golden", {39.742476, -105.1786, -7}, {}, {}};
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  for (int month = 1; month <= 12; ++month)
    for (int day = 1; day <= kDays[month - 1]; ++day)
      for (int hour = 1; hour <= 24; ++hour) {
        WeatherHour h;
        h.year = 1990 + month, h.month = month, h.day = day, h.hour = hour;
        h.line = 9 + static_cast<int>(weather.hours.size());
        const bool day_time = hour > 6 && hour <= 18, sunny = hour > 8 && hour <= 16;
        h.direct_normal = sunny ? 500 : 0;
        h.diffuse_horizontal = day_time ? 100 : 0;
        h.direct_normal_lux = sunny ? 50'000 : 0;
        h.diffuse_horizontal_lux = day_time ? 12'000 : 0;
        weather.hours.push_back(h);
      }
  return weather;
}

std::string refusal_of(const Weather& weather) {
  try {
    year_of(weather);
    return "(it was taken)";
  } catch (const InputError& error) {
    return error.what();
  }
}

bool warns(const DaylightYear& year, const std::string& words) {
  return std::ranges::any_of(year.warnings, [&](const std::string& w) { return w.find(words) != w.npos; });
}

TEST(DaylightYear, HasTheHoursWithLightInTheirOrder) {
  Weather weather = even_year();
  weather.hours[6].direct_normal = 500, weather.hours[6].direct_normal_lux = 50'000;
  const DaylightYear year = year_of(weather);
  ASSERT_EQ(year.hours.size(), 12u * 365);
  EXPECT_TRUE(year.warnings.empty()) << year.warnings.front();
  EXPECT_EQ(year.hours.front().hour, 6);
  EXPECT_EQ(year.hours.back().hour, 8759 - 6);
  const DaylightHour& noon = year.hours[12 * 59 + 6];  // 1 March, 12:00 to 13:00
  EXPECT_EQ(noon.hour, 59 * 24 + 12);
  EXPECT_EQ(noon.moment.year, 1993) << "that of the row";
  EXPECT_EQ(noon.moment.month, 3);
  EXPECT_EQ(noon.moment.day, 1);
  EXPECT_DOUBLE_EQ(noon.moment.hour, 12.5);
  EXPECT_TRUE(noon.sun_up);
  EXPECT_DOUBLE_EQ(noon.direct_normal_lux(), 50'000);
  EXPECT_EQ(noon.diffuse_horizontal_lux, 12'000);
  EXPECT_DOUBLE_EQ(noon.sky.horizontal_irradiance[0], 12'000 / 179.0);
  // In winter the sun rises at 7:20: from 6 to 7 the sky alone gives light.
  EXPECT_FALSE(year.hours.front().sun_up);
  EXPECT_EQ(year.hours.front().sun_normal_irradiance, 0);
  EXPECT_LT(year.hours.front().sun.z, 0);
}

TEST(DaylightYear, TheSceneTurnsTheSun) {
  const Weather weather = even_year();
  const DaylightHour plain = year_of(weather).hours[6];
  const DaylightHour turned = daylight_year(weather, weather.place, 90, 0.4).hours[6];
  EXPECT_NEAR(turned.sun.x, plain.sun.y, 1e-12);  // north is +x
  EXPECT_NEAR(turned.sun.y, -plain.sun.x, 1e-12);
  EXPECT_EQ(turned.sky.ground_reflectance, 0.4);
  EXPECT_EQ(turned.sky.sun.x, turned.sun.x);
}

TEST(DaylightYear, EveryHourIsTheOneThatASceneFileTakesOfTheWeatherFile) {
  if (!fs::exists(weather_folder())) GTEST_SKIP() << "no " << weather_folder();
  TempFolder folder;
  folder.write("room.obj", kRoomObj);
  const Weather weather = read_epw(folder.write("city.epw", read_input_file(weather_folder() / kFiles[0], 1 << 24)));
  const DaylightYear year = daylight_year(weather, weather.place, 30, 0.3);
  for (std::size_t i = 0; i < year.hours.size(); i += 487) {
    const DaylightHour& h = year.hours[i];
    const Scene scene = read_scene(folder.write(
        "s.json",
        text(R"({ "geometry": [{ "file": "room.obj" }], "location": { "north": 30 }, "sky": { "weather": "city.epw",
                       "ground_reflectance": 0.3, "day_of_year": )",
             h.hour / 24 + 1, R"(, "hour": )", h.hour % 24 + 1, " } }")));
    ASSERT_TRUE(scene.lights.sky);
    EXPECT_EQ(scene.lights.sky->horizontal_irradiance[0], h.sky.horizontal_irradiance[0]) << h.hour;
    EXPECT_EQ(scene.lights.sky->shape.c, h.sky.shape.c) << h.hour;
    EXPECT_EQ(scene.lights.sky->sun.x, h.sky.sun.x) << h.hour;
    EXPECT_EQ(scene.lights.suns.empty() ? 0 : scene.lights.suns[0].normal_irradiance[0], h.sun_normal_irradiance)
        << h.hour;
  }
}

TEST(DaylightYear, WeatherOfElsewhereIsToldWithItsDistance) {
  const Weather weather = even_year();
  Place place = weather.place;
  place.latitude_deg -= 0.8;
  EXPECT_TRUE(daylight_year(weather, place, 0, 0.2).warnings.empty()) << "89 km";
  place.latitude_deg -= 0.2;  // a degree: 111 km
  EXPECT_TRUE(warns(daylight_year(weather, place, 0, 0.2), "even.epw: is of Golden, 111 km from the scene's location"));
}

TEST(DaylightYear, DirectLightWithoutASunIsToldWhereItIsMuch) {
  const Weather weather = even_year();
  Place place = weather.place;
  place.timezone += 6;  // the sun rises at 10:42 to 13:21
  EXPECT_TRUE(warns(daylight_year(weather, place, 0, 0.2), " hours have direct light while the sun is down, "));
}

TEST(DaylightYear, ALeapDayIsLeftOutAndNamed) {
  Weather weather = even_year();
  const auto march = weather.hours.begin() + 59 * 24;
  std::vector<WeatherHour> day(march, march + 24);
  for (WeatherHour& h : day) h.month = 2, h.day = 29, h.line = 5000;
  weather.hours.insert(march, day.begin(), day.end());
  const DaylightYear year = year_of(weather);
  EXPECT_EQ(year.hours.size(), 12u * 365);
  EXPECT_TRUE(warns(year, "even.epw:5000: 29 February is left out"));
}

TEST(DaylightYear, AFewHoursWithoutRadiationAreDarkAndMoreAreRefused) {
  Weather weather = even_year();
  const auto spoil = [&](std::size_t count) {
    for (std::size_t day = 0; day < count; ++day) weather.hours[day * 24 + 11].direct_normal = std::nullopt;
  };
  spoil(20);
  const DaylightYear year = year_of(weather);
  EXPECT_EQ(year.hours.size(), 12u * 365 - 20);
  EXPECT_EQ(year.missing_hours, 20);
  EXPECT_TRUE(warns(year, "even.epw: 20 of the ") && warns(year, "line 20, the direct normal radiation"))
      << year.warnings[0];
  spoil(60);
  EXPECT_NE(refusal_of(weather).find("even.epw: 60 of the "), std::string::npos) << refusal_of(weather);
  EXPECT_NE(refusal_of(weather).find("take another weather file"), std::string::npos);
}

TEST(DaylightYear, RowsThatAreNotThereCountAsMissing) {
  Weather weather = even_year();
  weather.hours.erase(weather.hours.begin() + 11);
  EXPECT_TRUE(warns(year_of(weather), "hour 12 of 1/1 (month/day) has no line"));
  weather.hours.resize(24 * 100);
  EXPECT_NE(refusal_of(weather).find("hours of the year with the sun up have no radiation"), std::string::npos);
}

TEST(DaylightYear, WeatherWithoutRadiationIsRefused) {
  Weather weather = even_year();
  for (WeatherHour& h : weather.hours) h.direct_normal = h.diffuse_horizontal = 0;
  EXPECT_EQ(refusal_of(weather), "even.epw: its radiation is 0 in all hours; take another weather file");
  for (WeatherHour& h : weather.hours) h.direct_normal = h.diffuse_horizontal = std::nullopt;
  EXPECT_NE(refusal_of(weather).find("have no radiation"), std::string::npos) << refusal_of(weather);
}

TEST(DaylightYear, TwoYearsInOneFileAreRefused) {
  Weather weather = even_year();
  weather.hours.push_back(weather.hours.front());
  weather.hours.back().line = 9000;
  EXPECT_EQ(
      refusal_of(weather),
      "even.epw:9000: has hour 1 of 1/1 (month/day) again, after line 9; figures of a year are of one year: cut the "
      "file to 8760 hours");
}

TEST(DaylightYear, IlluminancesThatAreDerivedAreToldOnce) {
  Weather weather = even_year();
  for (int k : {11, 12, 13}) weather.hours[static_cast<std::size_t>(k)].direct_normal_lux = std::nullopt;
  const DaylightYear year = year_of(weather);
  ASSERT_EQ(year.warnings.size(), 1u);
  EXPECT_EQ(year.warnings[0],
            "even.epw:20: has no illuminances for this hour; they are derived from its radiation by the efficacies of "
            "Perez (1990), as in 2 more hours");
}

}  // namespace
}  // namespace clerestory
