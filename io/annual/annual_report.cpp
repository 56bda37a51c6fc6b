#include "io/annual/annual_report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "io/text.h"
#include "solver/model/version.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

/// "sDA", "sDA_low", "sDA_high"
void add_share(Json& json, const std::string& name, const ShareWithin& share) {
  json[name] = share.value;
  json[name + "_low"] = share.low;
  json[name + "_high"] = share.high;
}

/// Shares of the level that is met, or of the lowest where none is, and of each.
Json en17037(const AreaYear& year) {
  const std::size_t shown = std::max<std::size_t>(static_cast<std::size_t>(year.level), 1) - 1;
  Json json = {{"level", kEn17037LevelNames[static_cast<std::size_t>(year.level)]},
               {"target_share", year.target_share[shown]},
               {"minimum_share", year.minimum_share[shown]}};
  for (std::size_t k = 0; k < 3; ++k)
    json["levels"][kEn17037LevelNames[k + 1]] = {{"target_share", year.target_share[k]},
                                                 {"minimum_share", year.minimum_share[k]}};
  return json;
}

Json leed(const AreaYear& year) {
  return {{"points", leed_points(year.sDA.value)},
          {"points_low", leed_points(year.sDA.low)},
          {"points_high", leed_points(year.sDA.high)},
          {"ASE_to_be_explained", year.ASE_more_than.value > kLeedAse}};
}

Json json_of(const AreaOfYear& area, bool is_300_lux) {
  const AreaYear& year = area.year;
  Json json = {{"name", area.name}, {"area", area.has_area ? Json(year.area) : Json()}, {"points", area.points}};
  add_share(json, "sDA", year.sDA);
  add_share(json, "ASE", year.ASE_more_than);
  json["ASE_at_least"] = {
      {"value", year.ASE_at_least.value}, {"low", year.ASE_at_least.low}, {"high", year.ASE_at_least.high}};
  json["EN17037"] = en17037(year);
  if (is_300_lux) json["LEED_v4_1"] = leed(year);
  json["mean_illuminance"] = year.mean;
  json["hours_blinds_closed"] = area.blinds.hours_closed;
  json["hours_not_complying"] = area.blinds.hours_not_complying;
  return json;
}

Json json_of(const YearError& error) { return {{"total", error.total}, {"direct", error.direct}}; }

Json rules_of(const AnnualReport& report) {
  const std::string blinds = report.blinds_operated ? "; blinds operated" : "";
  return {
      {"DA", text("share of the occupied hours with E >= ", report.threshold, " lx; hours of darkness count", blinds)},
      {"cDA", text("mean of min(1, E / ", report.threshold, " lx) over the occupied hours", blinds)},
      {"UDI", "share of the occupied hours with 100 <= E <= 3000 lx; lower: below, darkness included; upper: above"},
      {"sDA", text("share of the area with DA ", report.threshold, " >= 50 %", blinds)},
      {"ASE", "share of the area with more than 1000 lx of direct sun in more than 250 occupied hours; blinds open"},
      {"ASE_at_least", "the same in 250 occupied hours or more"},
      {"EN17037",
       "of the 4380 hours of most diffuse light outdoors: target E on >= 50 % and minimum E on >= 95 % of the area, "
       "each in >= 50 % of these hours; 300/100 lx minimum, 500/300 medium, 750/500 high"},
      {"blinds",
       "each hour the least set of window groups closed so that at most 2 % of the points get 1000 lx or more of "
       "direct "
       "sun (IES LM-83)"},
      {"low and high", "the figure if all illuminances were wrong by illuminance_error, down or up"}};
}

}  // namespace

std::string annual_json(const AnnualReport& report) {
  Json json = {{"version", kVersion},
               {"scene", report.scene},
               {"weather",
                {{"file", report.weather},
                 {"city", report.city},
                 {"latitude", report.latitude_deg},
                 {"longitude", report.longitude_deg},
                 {"timezone", report.timezone},
                 {"hours_with_light", report.lit_hours},
                 {"hours_missing", report.missing_hours}}},
               {"schedule", {{"name", report.schedule}, {"occupied_hours", report.occupied_hours}}},
               {"threshold", report.threshold},
               {"illuminance_error", {{"rooms", json_of(report.error_rooms)}, {"grids", json_of(report.error_grids)}}},
               {"rules", rules_of(report)},
               {"rooms", Json::array()},
               {"grids", Json::array()}};
  const bool is_300_lux = report.threshold == 300;
  for (const AreaOfYear& room : report.rooms) json["rooms"].push_back(json_of(room, is_300_lux));
  for (const AreaOfYear& grid : report.grids) json["grids"].push_back(json_of(grid, is_300_lux));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace clerestory
