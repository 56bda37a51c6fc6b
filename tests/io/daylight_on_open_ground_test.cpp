// Skies and suns of a year on an open plane, against what the weather file says of the light.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include "io/formats/weather_light.h"
#include "io/formats/weather_year.h"
#include "tests/support/sky_irradiance.h"

namespace clerestory {
namespace {

TEST(DaylightYear, SkyAndSunOnOpenGroundAddUpToWhatTheWeatherFileSays) {
  const std::filesystem::path folder = std::filesystem::path(CLERESTORY_SOURCE_DIR) / "../shared/data/weather";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no " << folder;
  constexpr std::size_t kStride = 97;  // with 1, all 9,206 hours: 3 min; off by 9e-6 at most
  for (const char* file : {"USA_CO_Denver.Intl.AP.725650_TMY3.epw", "USA_HI_Honolulu.Intl.AP.911820_TMY3.epw"}) {
    const Weather weather = read_epw(folder / file);
    const DaylightYear year = daylight_year(weather, weather.place, 0, 0.2);
    ASSERT_EQ(weather.hours.size(), 8760u);
    ASSERT_GT(year.hours.size(), 4400u);
    for (std::size_t i = 0; i < year.hours.size(); i += kStride) {
      const DaylightHour& h = year.hours[i];
      const WeatherHour& row = weather.hours[static_cast<std::size_t>(h.hour)];
      const double up = std::sin(sun_position(weather.place, h.moment).elevation_deg * std::numbers::pi / 180);
      HourOfDaylight light = daylight_of(row);
      add_illuminances(light, measurement_of(light, {0, 0, up}, day_of_year(h.moment)));
      const double expected = *light.diffuse_horizontal_lux + (up > 0 ? *light.direct_normal_lux * up : 0);

      Lights lights;
      lights.sky = h.sky;
      const double total =
          179 * test::sky_irradiance(SkyRadiance(lights), {0, 0, 1}) + h.direct_normal_lux() * std::max(0.0, h.sun.z);
      EXPECT_NEAR(total, expected, 1e-3 * expected) << file << ", line " << row.line;
    }
  }
}

}  // namespace
}  // namespace clerestory
