#include "io/scene_file/sky_of_times.h"

#include <map>
#include <vector>

#include "io/moment.h"
#include "io/scene_file/sky_entries.h"
#include "io/some_of.h"
#include "io/text.h"
#include "solver/model/error.h"
#include "solver/model/light_of_times.h"

namespace clerestory {
namespace {

/// What stands in the way of light that goes by the time; a scene that has all of it may still give the sun's
/// direction.
void require_daylight_by_time(const JsonObject& root, const std::string& file_name) {
  const auto refuse = [&](const std::string& why) { throw InputError(text(file_name, ": --times: ", why)); };
  if (!root.has("sky") && !root.has("sun"))
    refuse("there is no sky and no sun, whose light would change; give \"sky\" or \"sun\", or leave out --times");
  if (root.has("sun") && root.at("sun").is_object() && root.at("sun").contains("direction"))
    refuse("sun.direction makes the sun stand still; leave it out, \"location\" and the times say where it stands");
  const bool has_weather = root.has("sky") && root.at("sky").is_object() && root.at("sky").contains("weather");
  const bool has_place =
      root.has("location") && root.at("location").is_object() && root.at("location").contains("latitude");
  if (!has_weather && !has_place)
    refuse("the sun's way is not known; give \"location\" with latitude, longitude and timezone");
}

bool is_dark(const LightSpec& light) {
  return light.suns.empty() && (!light.sky || light.sky->horizontal_irradiance.is_black());
}

/// Those of all times: what many say, and what only some do.
class WarningsOfTimes {
 public:
  void add(const std::vector<std::string>& warnings, const Moment& at) {
    for (const std::string& warning : warnings) {
      auto [found, is_new] = times_.try_emplace(warning, 0);
      if (is_new) order_.push_back({warning, at});
      ++found->second;
    }
  }
  std::vector<std::string> in_short(std::size_t times) const {
    constexpr std::size_t kMost = 3;
    std::vector<std::string> out;
    std::size_t of_some = 0;
    for (const auto& [warning, at] : order_) {
      // What files say of themselves is said when they are read, for the first time.
      const bool is_of_all = times_.at(warning) == times || moment_text(at) == moment_text(order_.front().at);
      if (is_of_all || ++of_some <= kMost) out.push_back(warning);
    }
    if (of_some > kMost)
      out.push_back(text("--times: ", of_some - kMost, " more warnings like the last, of other times"));
    return out;
  }

 private:
  struct First {
    std::string warning;
    Moment at;
  };
  std::map<std::string, std::size_t> times_;
  std::vector<First> order_;
};

}  // namespace

void read_sky_of_times(const JsonObject& root, const std::string& file_name, const std::filesystem::path& folder,
                       std::span<const Moment> times, ChannelCount& channels, Scene& scene) {
  require_daylight_by_time(root, file_name);
  std::vector<LightSpec> lights;
  WarningsOfTimes warnings;
  std::vector<Moment> night;
  bool sky_at_night = false;
  TimeOfSeries series;
  for (const Moment& moment : times) {
    series.moment = moment;
    std::vector<std::string> of_time;
    LightSpec& light = lights.emplace_back();
    std::optional<Daylight> daylight;
    try {
      daylight = read_sky_entries(root, file_name, folder, channels, light, of_time, &series);
    } catch (const InputError& e) {
      throw InputError(text(e.what(), " (--times, at ", moment_text(moment), ")"));
    }
    warnings.add(of_time, moment);
    if (!daylight)
      throw InputError(text(file_name,
                            ": --times: the sky is the same at all times, and there is no sun; give \"sun\" ",
                            "a normal_illuminance, or a sky that goes by the sun or a weather file"));
    scene.times.push_back({moment, *daylight});
    if (is_dark(light))
      night.push_back(moment);
    else if (daylight->sun.elevation_deg <= 0)
      sky_at_night = true;
  }
  const std::string all =
      times.size() == 1 ? moment_text(times.front()) : moment_text(times.front()) + " to " + moment_text(times.back());
  if (night.size() == times.size())
    throw InputError(
        text(file_name, ": --times: all of it is night, ", all, ": no light of sky or sun; take times of day"));
  const std::vector<std::string> said = warnings.in_short(times.size());
  scene.warnings.insert(scene.warnings.end(), said.begin(), said.end());
  if (!night.empty())
    scene.warnings.push_back(text("--times: no light of sky or sun at ", night.size(), " of ", times.size(),
                                  " times: ", some_of(night, 4, moment_text)));
  if (sky_at_night)
    scene.warnings.push_back(
        text(file_name, ": sky: it is as bright as by day when the sun is down; a \"weather\" file ", "knows night"));
  scene.lights = mean_over_times(std::move(scene.lights), lights);
}

}  // namespace clerestory
