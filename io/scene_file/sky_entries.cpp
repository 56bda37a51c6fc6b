#include "io/scene_file/sky_entries.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include "io/formats/read_sky_image.h"
#include "io/formats/weather_light.h"
#include "io/input_file.h"
#include "io/odd_place.h"
#include "io/scene_file/nearest_name.h"
#include "io/scene_file/place_and_time.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/perez.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kDefaultSkyLux = 10'000;  // a usual overcast sky; the daylight factor does not depend on it

struct NamedModel {
  std::string_view name;
  SkyModel model;
};
constexpr NamedModel kModels[] = {{"uniform", SkyModel::uniform},     {"cie-overcast", SkyModel::cie_overcast},
                                  {"cie-clear", SkyModel::cie_clear}, {"cie-general", SkyModel::cie_general},
                                  {"perez", SkyModel::perez},         {"image", SkyModel::image}};
constexpr std::string_view kNames[] = {"uniform", "cie-overcast", "cie-clear", "cie-general", "perez", "image"};

/// place   "office.json: sky.model", or "--sky".
SkyModel sky_model(const std::string& name, const std::string& place) {
  for (const NamedModel& known : kModels)
    if (name == known.name) return known.model;
  throw InputError(text(place, " '", quotable(name), "' is not known; ", suggestion(name, kNames)));
}

std::string_view name_of(SkyModel model) {
  return std::find_if(std::begin(kModels), std::end(kModels), [&](const NamedModel& m) { return m.model == model; })
      ->name;
}

constexpr Range kLux{
    .low = 0, .high = kMostLight, .advice = "a sky gives no less than no light and no more than a result can hold"};
constexpr Range kSunLux{
    .low = 0, .high = kMostLight, .advice = "a sun gives no less than no light and no more than a result can hold"};
constexpr Range kIrradiance{.low = 0, .high = 10'000, .advice = "it is in W/m2; the sun outside the air gives 1367"};

std::optional<int> whole_number(const JsonObject& object, std::string_view key, const Range& range) {
  const std::optional<double> x = object.number(key, range);
  if (x && *x != std::floor(*x)) throw InputError(text(object.place(key), " = ", *x, " is not a whole number"));
  return x ? std::optional(static_cast<int>(*x)) : std::nullopt;
}

/// What "sky", "sun", "location" and "time" say, each key checked by itself.
struct SkyEntries {
  std::optional<JsonObject> sky, sun;
  bool no_sun = false;  ///< "sun": false
  PlaceAndTime where_and_when;
  std::optional<Vec3> sun_direction;
  std::optional<Spectrum> sun_irradiance;
};

/// One hour of light, and where it comes from.
struct ChosenHour {
  HourOfDaylight light;
  std::optional<int> line;                ///< of the weather file
  std::optional<Daylight::Hour> weather;  ///< which hour of which file
};

std::optional<JsonObject> sky_object(const JsonObject& root, const std::string& file_name) {
  if (!root.has("sky")) return {};
  return JsonObject(
      root.at("sky"), file_name + ": sky",
      {"model", "horizontal_illuminance", "type", "ground_reflectance", "direct_normal", "diffuse_horizontal",
       "dew_point", "precipitable_water", "weather", "day_of_year", "hour", "image", "rotation"});
}

double ground_of(const JsonObject& sky) {
  constexpr Range kGround{.low = 0, .high = 1, .advice = "the ground cannot reflect more than it receives"};
  return sky.number("ground_reflectance", kGround).value_or(Sky{}.ground_reflectance);
}

SkyEntries read_entries(const JsonObject& root, const std::string& file_name, const TimeOfSeries* series,
                        ChannelCount& channels) {
  SkyEntries read;
  read.where_and_when = read_place_and_time(root, file_name, series ? std::optional(series->moment) : std::nullopt);
  read.sky = sky_object(root, file_name);
  if (!root.has("sun")) return read;
  if (root.at("sun") == false) {
    read.no_sun = true;
    return read;
  }
  read.sun.emplace(root.at("sun"), file_name + ": sun",
                   std::initializer_list<std::string_view>{"direction", "normal_illuminance"});
  read.sun_direction = read.sun->unit_vector("direction");
  if (const auto lux = read.sun->colour("normal_illuminance", kSunLux)) {
    channels.note(*lux, read.sun->place("normal_illuminance"));
    read.sun_irradiance = lux->value / kWhiteEfficacy;
  }
  return read;
}

/// The model that is named, or that the other keys mean.
SkyModel model_of(const JsonObject& sky, std::vector<std::string>& warnings) {
  if (const auto name = sky.word("model")) return sky_model(*name, sky.place("model"));
  if (sky.has("image")) return SkyModel::image;
  if (sky.has("weather") || sky.has("direct_normal") || sky.has("diffuse_horizontal")) return SkyModel::perez;
  warnings.push_back(text(sky.place("model"), " is not given; cie-overcast is taken"));
  return SkyModel::cie_overcast;
}

/// Keys that the model has no use for are named, not refused: people switch models back and forth.
void warn_of_idle_keys(const JsonObject& sky, SkyModel model, std::vector<std::string>& warnings) {
  const auto idle = [&](std::initializer_list<std::string_view> keys, std::string_view why) {
    for (const std::string_view key : keys)
      if (sky.has(key)) warnings.push_back(text(sky.place(key), " is not used ", why));
  };
  const std::string by_model = text("by the sky ", name_of(model));
  if (model != SkyModel::cie_general) idle({"type"}, by_model);
  if (model != SkyModel::perez)
    idle({"direct_normal", "diffuse_horizontal", "dew_point", "precipitable_water"}, by_model);
  if (model == SkyModel::perez)
    idle({"horizontal_illuminance"}, by_model + ": its light comes from diffuse_horizontal");
  if (model != SkyModel::image) idle({"image", "rotation"}, by_model);
  if (sky.has("weather")) idle({"dew_point", "precipitable_water"}, "beside \"weather\", which has its own");
  if (!sky.has("weather")) idle({"day_of_year", "hour"}, "without \"weather\"");
}

void refuse_pair(const JsonObject& sky, std::string_view a, std::string_view b, std::string_view why) {
  if (sky.has(a) && sky.has(b))
    throw InputError(text(sky.where(), ": ", a, " and ", b, " ", why, "; keep one of them"));
}

/// Checks types and ranges of what only some models use, and pairs that contradict each other.
void check_sky(const JsonObject& sky) {
  whole_number(sky, "type", {.low = 1, .high = 16, .advice = "the CIE numbers its general skies 1 to 16"});
  whole_number(sky, "day_of_year", {.low = 1, .high = 365, .advice = "weather files have years of 365 days"});
  whole_number(sky, "hour", {.low = 1, .high = 24, .advice = "12 is the hour from 11:00 to 12:00"});
  sky.number("direct_normal", kIrradiance);
  sky.number("diffuse_horizontal", kIrradiance);
  sky.number("dew_point", {.low = -100, .high = 60, .advice = "it is in degrees Celsius"});
  sky.number("precipitable_water", {.low = 0, .high = 20, .advice = "it is in cm"});
  sky.number("rotation", {.low = -360, .high = 360, .advice = "it is in degrees clockwise"});
  sky.word("image");
  sky.word("weather");
  refuse_pair(sky, "dew_point", "precipitable_water", "both say how much water is in the air");
  refuse_pair(sky, "weather", "horizontal_illuminance", "both say how bright the sky is");
  refuse_pair(sky, "weather", "direct_normal", "both say how bright the sun is");
  refuse_pair(sky, "weather", "diffuse_horizontal", "both say how bright the sky is");
  refuse_pair(sky, "weather", "image", "both say how bright the sky is");
}

/// Finds the hour of the weather file; place and time of the scene become those of the file where it says none.
ChosenHour hour_of_weather(const JsonObject& root, const JsonObject& sky, const std::filesystem::path& folder,
                           TimeOfSeries* series, PlaceAndTime& at, std::vector<std::string>& warnings) {
  const std::string named = *sky.word("weather");
  require_file(folder / named, sky.place("weather"), named);
  const bool by_day = sky.has("day_of_year") || sky.has("hour");
  if (by_day && at.time) {
    throw InputError(
        text(root.place("time"), " and ", sky.where(), ".day_of_year both choose an hour; keep one of them"));
  }
  if (!by_day && !at.time) {
    throw InputError(text(root.place("time"), " is missing; which hour of the weather file? Write \"time\": ",
                          "\"2026-03-21T12:00\", or day_of_year and hour into the sky"));
  }
  std::optional<Weather> of_one_time;
  std::optional<Weather>& kept = series ? series->weather : of_one_time;
  if (!kept) {
    kept = read_epw(folder / named);
    warnings.insert(warnings.end(), kept->warnings.begin(), kept->warnings.end());
  }
  const Weather& weather = *kept;
  if (!at.place) {
    at.place = weather.place;
    warn_of_place(weather.file, *at.place, warnings);
  }

  // Hours are counted by their end: 12:00 is the end of hour 12, 12:10 lies in hour 13.
  Moment moment;
  int hour = 0;
  if (by_day) {
    for (const std::string_view key : {"day_of_year", "hour"}) sky.at(key);
    using namespace std::chrono;
    const year_month_day date =
        sys_days(year_month_day(year(2001), January, day(1))) + days(*whole_number(sky, "day_of_year", {}) - 1);
    moment.month = static_cast<int>(static_cast<unsigned>(date.month()));
    moment.day = static_cast<int>(static_cast<unsigned>(date.day()));
    hour = *whole_number(sky, "hour", {});
  } else {
    moment = *at.time;
    hour = static_cast<int>(std::ceil(moment.hour));
    if (hour == 0) {
      using namespace std::chrono;
      const year_month_day date = sys_days(year_month_day(year(moment.year), month(static_cast<unsigned>(moment.month)),
                                                          day(static_cast<unsigned>(moment.day)))) -
                                  days(1);
      moment.year = static_cast<int>(date.year());
      moment.month = static_cast<int>(static_cast<unsigned>(date.month()));
      moment.day = static_cast<int>(static_cast<unsigned>(date.day()));
      hour = 24;
    }
  }
  const WeatherHour& found = weather.at(moment.month, moment.day, hour, moment.year);
  if (by_day) moment.year = found.year;
  if (by_day || at.on_the_hour) moment.hour = middle_of_daylight(*at.place, moment, hour);
  at.time = moment;

  const bool is_night = sun_position(*at.place, moment).elevation_deg <= 0;
  if (const std::string missing = missing_radiation(found, is_night); !missing.empty()) {
    throw InputError(text(weather.file, ":", found.line, ": ", missing,
                          "; choose another hour, or give direct_normal and diffuse_horizontal in the scene file"));
  }
  return {daylight_of(found), found.line, Daylight::Hour{weather.file, moment.month, moment.day, hour}};
}

HourOfDaylight hour_of_keys(const JsonObject& sky) {
  for (const std::string_view key : {"direct_normal", "diffuse_horizontal"}) {
    if (sky.has(key)) continue;
    throw InputError(text(sky.place(key), " is missing; the sky perez needs direct_normal and diffuse_horizontal in ",
                          "W/m2, or a \"weather\" file"));
  }
  HourOfDaylight light;
  light.direct_normal = *sky.number("direct_normal", kIrradiance);
  light.diffuse_horizontal = *sky.number("diffuse_horizontal", kIrradiance);
  if (const auto dew_point = sky.number("dew_point")) light.precipitable_water = precipitable_water(*dew_point);
  light.precipitable_water = sky.number("precipitable_water").value_or(light.precipitable_water);
  return light;
}

/// Direction to the sun, from "sun" or from place and time.
std::optional<Vec3> direction_of_sun(const SkyEntries& entries, bool& computed) {
  computed = false;
  if (entries.sun_direction) return entries.sun_direction;
  const PlaceAndTime& at = entries.where_and_when;
  if (!at.place || !at.time) return std::nullopt;
  computed = true;
  return scene_direction(sun_position(*at.place, *at.time), at.north_deg);
}

std::string how_to_place_the_sun(const PlaceAndTime& at) {
  if (at.place) return "give \"time\": \"2026-03-21T12:00\", or \"sun\": { \"direction\": [0.3, -0.5, 0.8] }";
  return text("give \"location\" with latitude, longitude and timezone", at.time ? "" : ", and \"time\"",
              ", or \"sun\": { \"direction\": [0.3, -0.5, 0.8] }");
}

void set_image(const JsonObject& object, const std::filesystem::path& folder, double north_deg, Sky& sky,
               ChannelCount& channels, std::vector<std::string>& warnings) {
  if (!object.has("image"))
    throw InputError(text(object.place("image"), " is missing; the sky image needs the name of an .hdr or .exr file"));
  const std::string named = *object.word("image");
  require_file(folder / named, object.place("image"), named);
  SkyImage image = read_sky_image(folder / named, warnings);
  image.middle_deg = north_deg + object.number("rotation").value_or(0);
  sky.horizontal_irradiance = horizontal_irradiance(image);
  if (const auto lux = object.colour("horizontal_illuminance", kLux)) {
    channels.note(*lux, object.place("horizontal_illuminance"));
    const double shown = luminous_mean(sky.horizontal_irradiance);
    if (!(shown > 0)) {
      throw InputError(text(object.place("horizontal_illuminance"),
                            ": the image is black above the horizon and cannot ", "be scaled"));
    }
    const double scale = luminous_mean(lux->value) / kWhiteEfficacy / shown;
    for (float& L : image.value) L = static_cast<float>(L * scale);
    sky.horizontal_irradiance *= scale;
  }
  const auto brightest = *std::max_element(image.value.begin(), image.value.end());
  // Around the sun a clear sky has up to 5 times E_h per steradian, the sun 15,000 times.
  if (brightest > 100 * luminous_mean(sky.horizontal_irradiance)) {
    warnings.push_back(text(object.place("image"), " '", quotable(named),
                            "' seems to show the sun: such a small bright ",
                            "spot is found by chance and makes noise; paint it over and give \"sun\""));
  }
  sky.image_has_ground = !object.has("ground_reflectance");
  sky.image = std::make_shared<const SkyImage>(std::move(image));
}

void set_illuminance(const JsonObject& object, Sky& sky, ChannelCount& channels, std::vector<std::string>& warnings) {
  if (const auto lux = object.colour("horizontal_illuminance", kLux)) {
    channels.note(*lux, object.place("horizontal_illuminance"));
    sky.horizontal_irradiance = lux->value / kWhiteEfficacy;
  } else {
    sky.horizontal_irradiance = Spectrum(kDefaultSkyLux / kWhiteEfficacy);
    warnings.push_back(text(object.place("horizontal_illuminance"), " is not given; ", kDefaultSkyLux, " lx is taken"));
  }
}

/// Type 16 is the overcast sky under its own name.
void set_general_type(int type, Sky& sky) {
  if (type == 16) {
    sky.model = SkyModel::cie_overcast;
  } else {
    sky.model = SkyModel::cie_general;
    sky.shape = cie_general_shape(type);
  }
}

/// A sun that has set gives no light: the ground is in its way.
void add_sun(const SkyEntries& entries, const Spectrum& irradiance, const Vec3& direction, bool computed,
             bool of_series, const std::string& file_name, LightSpec& lights, std::vector<std::string>& warnings) {
  if (direction.z <= 0 && computed) {
    if (of_series) return;
    const Place& place = *entries.where_and_when.place;
    warnings.push_back(text(file_name, ": at this place and time the sun stands ",
                            -std::asin(direction.z) * 180 / std::numbers::pi,
                            " degrees below the horizon and gives no light",
                            is_odd(place) ? "; longitude and timezone do not fit each other, which may be why" : ""));
  } else if (direction.z <= 0) {
    warnings.push_back(text(entries.sun->place("direction"),
                            " has z <= 0: the sun is not above the horizon and gives no ",
                            "light; it is the direction to the sun, with z up"));
  } else if (!irradiance.is_black()) {
    lights.suns.push_back({direction, irradiance});
  }
}

}  // namespace

std::optional<Daylight> read_sky_entries(const JsonObject& root, const std::string& file_name,
                                         const std::filesystem::path& folder, ChannelCount& channels, LightSpec& lights,
                                         std::vector<std::string>& warnings, TimeOfSeries* series) {
  SkyEntries entries = read_entries(root, file_name, series, channels);
  PlaceAndTime& at = entries.where_and_when;
  if (at.place) warn_of_place(root.place("location"), *at.place, warnings);
  const std::optional<JsonObject>& object = entries.sky;
  Sky sky;
  std::optional<ChosenHour> hour;
  if (object) {
    check_sky(*object);
    sky.model = model_of(*object, warnings);
    warn_of_idle_keys(*object, sky.model, warnings);
    sky.ground_reflectance = ground_of(*object);
    if (object->has("weather"))
      hour = hour_of_weather(root, *object, folder, series, at, warnings);
    else if (sky.model == SkyModel::perez)
      hour = ChosenHour{hour_of_keys(*object), {}, {}};
  }

  bool computed = false;
  const std::optional<Vec3> to_sun = direction_of_sun(entries, computed);
  const auto needs_sun = [&](const std::string& who) {
    if (!to_sun) throw InputError(text(who, " needs to know where the sun stands; ", how_to_place_the_sun(at)));
  };
  bool sun_used = false;

  if (hour) {
    needs_sun(object->place("model") + (object->has("weather") ? " of a weather file" : " 'perez'"));
    const SkyMeasurement measured =
        measurement_of(hour->light, *to_sun, at.time ? std::optional(day_of_year(*at.time)) : std::nullopt);
    const std::string why = add_illuminances(hour->light, measured);
    if (!why.empty() && hour->line)
      warnings.push_back(
          text(short_name(*object->word("weather")), ":", *hour->line, ": ", why, kDerivedFromRadiation));
    sky.horizontal_irradiance = Spectrum(*hour->light.diffuse_horizontal_lux / kWhiteEfficacy);
    if (sky.model == SkyModel::perez) sky.shape = perez_shape(measured);
  }
  if (object && sky.model == SkyModel::image) {
    if (series && series->image)
      sky = *series->image;
    else
      set_image(*object, folder, at.north_deg, sky, channels, warnings);
    if (series) series->image = sky;
  } else if (object && !hour) {
    set_illuminance(*object, sky, channels, warnings);
  }
  if (sky.model == SkyModel::cie_clear) sky.shape = cie_clear_shape();
  if (sky.model == SkyModel::cie_general) {
    if (!object->has("type"))
      throw InputError(text(object->place("type"), " is missing; the sky cie-general has types 1 to 16"));
    set_general_type(*whole_number(*object, "type", {}), sky);
  }
  if (sky.shape.needs_sun()) {
    needs_sun(text(object->place("model"), " '", name_of(sky.model), "'"));
    sky.sun = *to_sun;
    sun_used = true;
  }
  if (object) lights.sky = sky;

  if ((entries.sun || hour) && !entries.no_sun) {
    if (!to_sun) throw InputError(text(entries.sun->place("direction"), " is missing; ", how_to_place_the_sun(at)));
    if (!entries.sun_irradiance && !hour) {
      throw InputError(text(entries.sun->place("normal_illuminance"),
                            " is missing; a clear sun gives up to 100000 lx, ",
                            "0 only shows the sky where the sun stands"));
    }
    add_sun(entries,
            entries.sun_irradiance.value_or(Spectrum(hour ? *hour->light.direct_normal_lux / kWhiteEfficacy : 0)),
            *to_sun, computed, series != nullptr, file_name, lights, warnings);
    sun_used = true;
  }
  if ((at.time || root.has("location")) && !hour && !(sun_used && computed) && !(sky.image && at.north_deg != 0)) {
    warnings.push_back(file_name + ": location and time are not used: sky and sun are given as they are");
  }
  if (!sun_used && !hour) return std::nullopt;
  return Daylight{compass_direction(*to_sun, at.north_deg), computed ? at.time : std::nullopt,
                  hour ? hour->weather : std::nullopt};
}

Sky sky_of_option(std::string_view option) {
  const std::size_t colon = option.find(':');
  const std::string name(option.substr(0, colon));
  Sky sky;
  constexpr std::string_view kGeneral = "cie-general-";
  if (name.starts_with(kGeneral)) {
    const double type = to_number(std::string_view(name).substr(kGeneral.size())).value_or(0);
    if (type != 1 && type != 3 && type != 5 && type != 16) {
      throw InputError(
          text("--sky '", quotable(name), "': without a sun there are the types 1, 3, 5 and 16; for others ",
               "write a scene file with \"sky\": { \"model\": \"cie-general\", \"type\": 12 } and \"sun\""));
    }
    set_general_type(static_cast<int>(type), sky);
  } else {
    sky.model = sky_model(name, "--sky");
    std::string scene;
    if (sky.model == SkyModel::cie_clear)
      scene = "\"sky\": { \"model\": \"cie-clear\" } and \"sun\", or \"location\" and \"time\"";
    if (sky.model == SkyModel::cie_general)
      scene =
          "\"sky\": { \"model\": \"cie-general\", \"type\": 12 } and \"sun\", or write cie-general-1, -3, -5 or -16";
    if (sky.model == SkyModel::perez)
      scene =
          "\"sky\": { \"model\": \"perez\", \"direct_normal\": 600, \"diffuse_horizontal\": 120 }, \"location\" and "
          "\"time\"";
    if (sky.model == SkyModel::image) scene = "\"sky\": { \"model\": \"image\", \"image\": \"sky.hdr\" }";
    if (!scene.empty())
      throw InputError(text("--sky '", name, "' needs more than a name; write a scene file with ", scene));
  }
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

double read_ground(const JsonObject& root, const std::string& file_name) {
  const std::optional<JsonObject> sky = sky_object(root, file_name);
  return sky ? ground_of(*sky) : Sky{}.ground_reflectance;
}

}  // namespace clerestory
