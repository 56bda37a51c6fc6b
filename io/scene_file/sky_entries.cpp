#include "io/scene_file/sky_entries.h"

#include <algorithm>
#include <chrono>

#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kDefaultSkyLux = 10'000;  // a usual overcast sky; the daylight factor does not depend on it

constexpr std::string_view kSkies[] = {"uniform", "cie-overcast"};
constexpr std::string_view kLaterSkies[] = {"cie-clear", "cie-general", "perez"};

/// place   "office.json: sky.model", or "--sky".
SkyModel sky_model(const std::string& name, const std::string& place) {
  if (name == "uniform") return SkyModel::uniform;
  if (name == "cie-overcast") return SkyModel::cie_overcast;
  if (std::find(std::begin(kLaterSkies), std::end(kLaterSkies), name) == std::end(kLaterSkies)) {
    throw InputError(text(place, " '", quotable(name), "' is not known; ", suggestion(name, kSkies)));
  }
  throw InputError(text(place, " '", name,
                        "' is not available in this version; use 'uniform' or 'cie-overcast', and \"sun\" ",
                        "for direct light"));
}

Sky read_sky(const JsonObject& object, ChannelCount& channels, std::vector<std::string>& warnings) {
  if (object.has("weather")) {
    throw InputError(text(object.place("weather"), " '", quotable(object.word("weather").value_or("")),
                          "': weather files are not available in this version; use \"model\": \"cie-overcast\" with ",
                          "its horizontal_illuminance, and \"sun\" for direct light"));
  }
  Sky sky;
  const std::string name = object.word("model").value_or("cie-overcast");
  sky.model = sky_model(name, object.place("model"));
  if (!object.has("model")) warnings.push_back(text(object.place("model"), " is not given; cie-overcast is taken"));
  constexpr Range kLux{
      .low = 0, .high = kMostLight, .advice = "a sky gives no less than no light and no more than a result can hold"};
  if (const auto lux = object.colour("horizontal_illuminance", kLux)) {
    channels.note(*lux, object.place("horizontal_illuminance"));
    sky.horizontal_irradiance = lux->value / kWhiteEfficacy;
  } else {
    sky.horizontal_irradiance = Spectrum(kDefaultSkyLux / kWhiteEfficacy);
    warnings.push_back(text(object.place("horizontal_illuminance"), " is not given; ", kDefaultSkyLux, " lx is taken"));
  }
  constexpr Range kGround{.low = 0, .high = 1, .advice = "the ground cannot reflect more than it receives"};
  sky.ground_reflectance = object.number("ground_reflectance", kGround).value_or(sky.ground_reflectance);

  object.number("type", {.low = 1, .high = 15, .advice = "the CIE numbers its general skies 1 to 15"});
  object.number("direct_normal", kLux);
  object.number("diffuse_horizontal", kLux);
  for (const std::string_view key : {"type", "direct_normal", "diffuse_horizontal"}) {
    if (object.has(key)) warnings.push_back(text(object.place(key), " is not used by the sky ", name));
  }
  return sky;
}

/// Nothing, with a warning, when the sun has set: the ground is in its way.
std::optional<Sun> read_sun(const JsonObject& object, ChannelCount& channels, std::vector<std::string>& warnings) {
  if (!object.has("direction")) {
    throw InputError(text(object.place("direction"),
                          " is missing; the sun of a place and time is not available in this ",
                          "version, so give the direction to the sun, [0.3, -0.5, 0.8]"));
  }
  Sun sun;
  sun.direction = *object.unit_vector("direction");
  constexpr Range kLux{
      .low = 0, .high = kMostLight, .advice = "a sun gives no less than no light and no more than a result can hold"};
  object.at("normal_illuminance");
  const JsonColour lux = *object.colour("normal_illuminance", kLux);
  channels.note(lux, object.place("normal_illuminance"));
  sun.normal_irradiance = lux.value / kWhiteEfficacy;
  if (sun.direction.z <= 0) {
    warnings.push_back(text(object.place("direction"), " has z <= 0: the sun is not above the horizon and gives no ",
                            "light; it is the direction to the sun, with z up"));
    return std::nullopt;
  }
  return sun;
}

/// Place and time are checked; nothing in this version computes from them.
void check_place_and_time(const JsonObject& root, const std::string& file_name, std::vector<std::string>& warnings) {
  if (root.has("location")) {
    const JsonObject location(root.at("location"), file_name + ": location",
                              {"latitude", "longitude", "timezone", "north"});
    location.number("latitude", {.low = -90, .high = 90, .advice = "it is in degrees, north positive"});
    location.number("longitude", {.low = -180, .high = 180, .advice = "it is in degrees, east positive"});
    location.number("timezone", {.low = -14, .high = 14, .advice = "it is in hours ahead of UTC"});
    location.number("north", {.low = -360, .high = 360, .advice = "it is in degrees clockwise from +y"});
  }
  const auto time = root.word("time");
  if (time) {
    // 2026-06-21T12:00, seconds allowed.
    constexpr std::string_view kShape = "dddd-dd-ddTdd:dd:dd";
    bool fits = time->size() == 16 || time->size() == 19;
    for (std::size_t i = 0; fits && i < time->size(); ++i) {
      const char c = (*time)[i];
      fits = kShape[i] == 'd' ? c >= '0' && c <= '9' : c == kShape[i];
    }
    if (!fits) {
      throw InputError(
          text(root.place("time"), " '", quotable(*time), "' is not a time; write it as 2026-06-21T12:00"));
    }
    const auto part = [&](std::size_t begin, std::size_t n) {
      return n == 0 ? 0 : static_cast<unsigned>(*to_number(std::string_view(*time).substr(begin, n)));
    };
    using namespace std::chrono;
    const year_month_day date(year(static_cast<int>(part(0, 4))), month(part(5, 2)), day(part(8, 2)));
    if (!date.ok() || part(11, 2) > 23 || part(14, 2) > 59 || part(17, time->size() == 19 ? 2 : 0) > 59) {
      throw InputError(text(root.place("time"), " '", *time, "' does not exist; months are 01 to 12, days those of ",
                            "the month, hours 00 to 23, minutes and seconds 00 to 59"));
    }
  }
  if (time || root.has("location")) {
    warnings.push_back(file_name + ": location and time are not used: sky and sun are given as they are");
  }
}

}  // namespace

void read_sky_entries(const JsonObject& root, const std::string& file_name, ChannelCount& channels, Lights& lights,
                      std::vector<std::string>& warnings) {
  if (root.has("sky")) {
    const JsonObject object(root.at("sky"), file_name + ": sky",
                            {"model", "horizontal_illuminance", "type", "ground_reflectance", "direct_normal",
                             "diffuse_horizontal", "weather"});
    lights.sky = read_sky(object, channels, warnings);
  }
  if (root.has("sun")) {
    const JsonObject object(root.at("sun"), file_name + ": sun", {"direction", "normal_illuminance"});
    if (const std::optional<Sun> sun = read_sun(object, channels, warnings)) lights.suns.push_back(*sun);
  }
  check_place_and_time(root, file_name, warnings);
}

Sky sky_of_option(std::string_view option) {
  const std::size_t colon = option.find(':');
  Sky sky;
  sky.model = sky_model(std::string(option.substr(0, colon)), "--sky");
  double lux = kDefaultSkyLux;
  if (colon != option.npos) {
    const std::string_view number = option.substr(colon + 1);
    lux = to_number(number).value_or(-1);
    if (!(lux >= 0 && lux <= kMostLight)) {
      throw InputError(
          text("--sky: '", quotable(number), "' is not an illuminance in lux, [0, 1e15]; write cie-overcast:10000"));
    }
  }
  sky.horizontal_irradiance = Spectrum(lux / kWhiteEfficacy);
  return sky;
}

}  // namespace clerestory
