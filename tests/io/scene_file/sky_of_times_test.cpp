// A scene read for several times: each has the light that a scene of that time alone has.

#include <gtest/gtest.h>

#include "io/moment.h"
#include "solver/model/light_of_times.h"
#include "tests/io/reading.h"
#include "tests/io/weather_text.h"

namespace clerestory {
namespace {

class SkyOfTimes : public ::testing::Test {
 protected:
  SkyOfTimes() {
    folder_.write("room.obj", kRoomObj);
    folder_.write("city.epw", joined(weather_lines()));
  }
  std::string scene(const std::string& members) {
    return folder_.write("s.json", R"({ "geometry": [{ "file": "room.obj" }], )" + members + " }");
  }
  Scene read_at(const std::string& members, const std::string& times) {
    return read_scene(scene(members), {.times = read_times(times, "--times")});
  }
  std::string refusal_at(const std::string& members, const std::string& times) {
    return refusal(scene(members), {.times = read_times(times, "--times")});
  }

  TempFolder folder_;
};

const std::string kGolden = R"("location": { "latitude": 39.742476, "longitude": -105.1786, "timezone": -7 })";
const std::string kDay = "2003-10-17T05:00/17:00/PT4H";  // night, 9:00, 13:00, 17:00

void expect_same_light(const LightSpec& light, const LightSpec& alone) {
  ASSERT_EQ(light.suns.size(), alone.suns.size());
  for (std::size_t k = 0; k < alone.suns.size(); ++k) {
    EXPECT_EQ(light.suns[k].direction, alone.suns[k].direction);
    EXPECT_NEAR(light.suns[k].normal_irradiance[0], alone.suns[k].normal_irradiance[0], 1e-9);
  }
  ASSERT_EQ(light.sky.has_value(), alone.sky.has_value());
  if (!alone.sky) return;
  EXPECT_EQ(light.sky->model, alone.sky->model);
  EXPECT_EQ(light.sky->horizontal_irradiance, alone.sky->horizontal_irradiance);
  EXPECT_EQ(light.sky->sun, alone.sky->sun);
}

TEST_F(SkyOfTimes, EachTimeHasTheLightOfASceneOfThatTime) {
  for (const std::string sky : {R"("sky": { "weather": "city.epw" })", R"("sky": { "model": "cie-clear" }, )",
                                R"("sky": { "model": "cie-overcast" }, "sun": { "normal_illuminance": 50000 }, )",
                                R"("sun": { "normal_illuminance": 50000 }, )"}) {
    const std::string members = sky + (sky.ends_with(", ") ? kGolden : "");
    const Scene series = read_at(members, kDay);
    ASSERT_EQ(series.times.size(), 4u);
    EXPECT_EQ(series.lights.times, 4u);
    for (std::size_t t = 0; t < 4; ++t) {
      const std::string time = moment_text(series.times[t].moment);
      const Scene alone = read_scene(scene(members + R"(, "time": ")" + time + "\""));
      SCOPED_TRACE(members + " at " + time);
      expect_same_light(light_at(series.lights, t), alone.lights);
      ASSERT_TRUE(alone.daylight);
      EXPECT_EQ(series.times[t].daylight.sun.azimuth_deg, alone.daylight->sun.azimuth_deg);
    }
  }
}

TEST_F(SkyOfTimes, NightsAreSaidOnceAndTheSceneFilesOwnTimeIsNotUsed) {
  const Scene series = read_at(R"("time": "2003-10-17T14:00", "sky": { "weather": "city.epw" })", kDay);
  const std::string warnings = all_warnings(series);
  EXPECT_NE(warnings.find("--times: no light of sky or sun at 1 of 4 times: 2003-10-17T05:00\n"), std::string::npos)
      << warnings;
  EXPECT_EQ(warnings.find("below the horizon"), std::string::npos) << warnings;
}

TEST_F(SkyOfTimes, ASkyThatKnowsNoNightIsSaidSo) {
  const Scene series = read_at(R"("sky": { "model": "cie-clear" }, )" + kGolden, kDay);
  EXPECT_NE(all_warnings(series).find("it is as bright as by day when the sun is down"), std::string::npos);
}

TEST_F(SkyOfTimes, WhatCannotGoByTheTimeIsRefused) {
  const std::string overcast = R"("sky": { "model": "cie-overcast" })", sun = R"("sun": { "normal_illuminance": 1 })";
  EXPECT_EQ(
      refusal_at(kGolden, kDay),
      "s.json: --times: there is no sky and no sun, whose light would change; give \"sky\" or \"sun\", or leave out "
      "--times");
  EXPECT_EQ(refusal_at(overcast + ", " + sun, kDay),
            "s.json: --times: the sun's way is not known; give \"location\" with latitude, longitude and timezone");
  EXPECT_EQ(
      refusal_at(overcast + ", " + kGolden, kDay),
      "s.json: --times: the sky is the same at all times, and there is no sun; give \"sun\" a normal_illuminance, or "
      "a sky that goes by the sun or a weather file");
  EXPECT_EQ(
      refusal_at(R"("sun": { "direction": [0, 0, 1], "normal_illuminance": 1 }, )" + kGolden, kDay),
      "s.json: --times: sun.direction makes the sun stand still; leave it out, \"location\" and the times say where "
      "it stands");
  EXPECT_EQ(
      refusal_at(R"("sky": { "weather": "city.epw" })", "2003-10-17T01:00/04:00/PT1H"),
      "s.json: --times: all of it is night, 2003-10-17T01:00 to 2003-10-17T04:00: no light of sky or sun; take times "
      "of day");
  EXPECT_EQ(refusal(folder_.write("room2.obj", kRoomObj), {.times = read_times(kDay, "--times")}),
            "room2.obj: --times is for a scene file, which says where on earth the model stands; write one with "
            "\"location\" and \"sky\" or \"sun\"");
  const std::string missing = refusal_at(R"("sky": { "weather": "city.epw" })", "2003-10-17T13:00/15:00/PT1H");
  EXPECT_NE(missing.find("direct normal radiation of this hour is missing"), std::string::npos) << missing;
  EXPECT_NE(missing.find("(--times, at 2003-10-17T15:00)"), std::string::npos) << missing;
}

}  // namespace
}  // namespace clerestory
