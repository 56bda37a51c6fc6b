#include "io/annual/year_part_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "io/parse_json.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char *kPlace = "place", *kPoints = "hours_of_points", *kSensors = "hours_of_sensors";
constexpr double kMostNumber = std::numeric_limits<double>::max(), kLeastWeight = std::numeric_limits<double>::min();
constexpr int kColumns = 14 + static_cast<int>(kMostThresholds);

[[noreturn]] void refuse(const WrittenResult& result, const std::string& why) {
  throw InputError(text(result.file, ": the part of a year in it is damaged (", why, "); run this part again."));
}

/// Calls visit(member, column) for all that a point has.
template <class Point, class Visit>
void for_each_column(Point& p, const Visit& visit) {
  visit(p.DA), visit(p.DA_low), visit(p.DA_high), visit(p.UDI_lit), visit(p.UDI_upper);
  visit(p.ASE), visit(p.ASE_low), visit(p.ASE_high);
  for (auto& hours : p.EN17037) visit(hours);
  for (auto& hours : p.at_least) visit(hours);
  visit(p.cDA), visit(p.lux_hours);
}

template <class Number>
WrittenTable table(const std::vector<Number>& numbers) {
  return {1, {numbers.begin(), numbers.end()}};
}
WrittenTable table(const Field& field) { return {field.channels, field.value}; }
WrittenTable table(const std::vector<PointYear>& years) {
  WrittenTable to{kColumns, {}};
  for (const PointYear& year : years) for_each_column(year, [&](const auto& x) { to.value.push_back(x); });
  return to;
}
void add(const Vec3& v, WrittenTable& to) { to.value.insert(to.value.end(), {v.x, v.y, v.z}); }
WrittenTable table(const std::vector<Vec3>& vectors) {
  WrittenTable to{3, {}};
  for (const Vec3& v : vectors) add(v, to);
  return to;
}

/// Points with their weights, one area after the other.
WrittenTable table(const std::vector<AreaPoints>& areas) {
  WrittenTable to{2, {}};
  for (const AreaPoints& area : areas)
    for (std::size_t i = 0; i < area.points.size(); ++i)
      to.value.push_back(area.points[i]), to.value.push_back(area.weight[i]);
  return to;
}

Json json_of(const std::vector<AreaOfYear>& areas) {
  Json json = Json::array();
  for (const AreaOfYear& area : areas)
    json.push_back({{"name", area.name},
                    {"points", area.points},
                    {"has_area", area.has_area},
                    {"hours_closed", area.blinds.hours_closed},
                    {"hours_not_complying", area.blinds.hours_not_complying}});
  return json;
}

/// A whole number of [0, most].
std::size_t whole(const Json& json, const char* name, std::size_t most, const WrittenResult& result) {
  const Json& x = json.at(name);
  if (!x.is_number_unsigned() || x.get<std::uint64_t>() > most)
    refuse(result, text("its '", name, "' is no whole number of [0, ", most, "]"));
  return x.get<std::size_t>();
}
int hours(const Json& json, const char* name, const WrittenResult& result) {
  return static_cast<int>(whole(json, name, kHoursOfYear, result));
}

std::vector<AreaOfYear> areas_of(const Json& json, const WrittenResult& result) {
  std::vector<AreaOfYear> areas;
  for (const Json& a : json)
    areas.push_back({a.at("name").get<std::string>(),
                     whole(a, "points", std::numeric_limits<std::uint32_t>::max(), result),
                     {},
                     {hours(a, "hours_closed", result), hours(a, "hours_not_complying", result)},
                     a.at("has_area").get<bool>()});
  return areas;
}

Json json_of(const YearPart& part) {
  const AnnualReport& f = part.facts;
  Json files = Json::array();
  for (const FileOfRun& file : part.files) files.push_back({{"name", file.name}, {"digest", file.digest}});
  return {{"parts", part.parts},
          {"files", files},
          {"weather", f.weather},
          {"city", f.city},
          {"place", {f.latitude_deg, f.longitude_deg, f.timezone}},
          {"schedule", f.schedule},
          {"occupied_hours", f.occupied_hours},
          {"lit_hours", f.lit_hours},
          {"missing_hours", f.missing_hours},
          {"threshold", f.threshold},
          {"more_thresholds", part.more_thresholds},
          {"blinds_operated", f.blinds_operated},
          {"illuminance_error", {f.error_rooms.total, f.error_rooms.direct, f.error_grids.total, f.error_grids.direct}},
          {"rooms", json_of(f.rooms)},
          {"grids", json_of(f.grids)}};
}

void read_facts(const Json& json, const WrittenResult& result, YearPart& part) {
  AnnualReport& f = part.facts;
  part.parts = whole(json, "parts", kMostParts, result);
  for (const Json& file : json.at("files"))
    part.files.push_back({file.at("name").get<std::string>(), file.at("digest").get<std::string>()});
  f.weather = json.at("weather").get<std::string>();
  f.city = json.at("city").get<std::string>();
  f.latitude_deg = json.at("place").at(0).get<double>();
  f.longitude_deg = json.at("place").at(1).get<double>();
  f.timezone = json.at("place").at(2).get<double>();
  f.schedule = json.at("schedule").get<std::string>();
  f.occupied_hours = hours(json, "occupied_hours", result);
  f.lit_hours = hours(json, "lit_hours", result);
  f.missing_hours = hours(json, "missing_hours", result);
  f.threshold = json.at("threshold").get<double>();
  part.more_thresholds = json.at("more_thresholds").get<std::vector<double>>();
  f.blinds_operated = json.at("blinds_operated").get<bool>();
  double* const errors[] = {&f.error_rooms.total, &f.error_rooms.direct, &f.error_grids.total, &f.error_grids.direct};
  for (std::size_t k = 0; k < std::size(errors); ++k) *errors[k] = json.at("illuminance_error").at(k).get<double>();
  f.rooms = areas_of(json.at("rooms"), result);
  f.grids = areas_of(json.at("grids"), result);
}

/// The tables of a result, each checked for its size and the range of its numbers.
class Tables {
 public:
  explicit Tables(const WrittenResult& result) : result_(result) {}

  /// rows  how many; empty: any number.
  const std::vector<double>& numbers(const char* name, int components, std::optional<std::size_t> rows = {}) const {
    const auto at = result_.year_tables.find(name);
    if (at == result_.year_tables.end()) refuse(result_, text("it has no table '", name, "'"));
    const auto& [has, value] = at->second;
    const auto width = static_cast<std::size_t>(components);
    if ((has != components && !value.empty()) || value.size() % width != 0 || (rows && value.size() != *rows * width))
      refuse(result_, text("its table '", name, "' has another size than it has to have"));
    return value;
  }
  /// The same, each of [least, most].
  const std::vector<double>& within(double least, double most, const char* name, int components,
                                    std::optional<std::size_t> rows = {}) const {
    const std::vector<double>& all = numbers(name, components, rows);
    for (const double x : all) require_within(least, most, name, x);
    return all;
  }
  void require_within(double least, double most, const char* name, double x) const {
    if (!(x >= least && x <= most))
      refuse(result_, text("its table '", name, "' has the value ", x, ", outside [", least, ", ", most, "]"));
  }
  std::vector<std::uint32_t> indices(const char* name, std::size_t limit, std::optional<std::size_t> rows = {}) const {
    std::vector<std::uint32_t> all;
    for (const double x : numbers(name, 1, rows)) all.push_back(index(name, x, limit));
    return all;
  }
  std::uint32_t index(const char* name, double x, std::size_t limit) const {
    if (!(x >= 0 && x < static_cast<double>(limit) && x == std::floor(x)))
      refuse(result_, text("its table '", name, "' has the value ", x, ", and there are ", limit));
    return static_cast<std::uint32_t>(x);
  }
  std::vector<Vec3> vectors(const char* name, std::optional<std::size_t> rows = {}) const {
    std::vector<Vec3> all;
    const std::vector<double>& x = within(-kMostNumber, kMostNumber, name, 3, rows);
    for (std::size_t i = 0; i < x.size(); i += 3) all.push_back({x[i], x[i + 1], x[i + 2]});
    return all;
  }
  std::vector<PointYear> years(const char* name) const {
    const std::vector<double>& x = numbers(name, kColumns);
    std::vector<PointYear> all(x.size() / kColumns);
    const double* next = x.data();
    for (PointYear& year : all)
      for_each_column(year, [&]<class Number>(Number& to) {
        if constexpr (std::is_same_v<Number, double>) {
          require_within(0, kMostNumber, name, *next);
          to = *next++;
        } else {
          to = static_cast<Number>(index(name, *next++, kHoursOfYear + 1));
        }
      });
    return all;
  }
  std::vector<AreaPoints> areas(const char* name, const std::vector<AreaOfYear>& areas, std::size_t limit) const {
    const std::vector<double>& x = numbers(name, 2);
    std::vector<AreaPoints> all;
    std::size_t next = 0;
    for (const AreaOfYear& area : areas) {
      AreaPoints& to = all.emplace_back();
      if (area.points > (x.size() - next) / 2) refuse(result_, text("its table '", name, "' is cut short"));
      for (std::size_t i = 0; i < area.points; ++i, next += 2) {
        to.points.push_back(index(name, x[next], limit));
        require_within(kLeastWeight, kMostNumber, name, x[next + 1]);
        to.weight.push_back(x[next + 1]);
      }
    }
    if (next != x.size()) refuse(result_, text("its table '", name, "' is too long"));
    return all;
  }

 private:
  const WrittenResult& result_;
};

void read_scattering(const Tables& tables, const WrittenResult& result, YearPart& part) {
  const std::size_t P = result.points.size(), N = result.triangles.size();
  const int channels = result.channels();
  part.origin = tables.vectors("origin", 1).front();
  part.position = tables.vectors("position", P);
  part.patch_of_point = tables.indices("patch_of_point", N, P);
  part.rho.channels = part.tau.channels = channels;
  part.rho.value = tables.within(0, 1, "rho", channels, N);
  if (!result.year_tables.contains("tau")) return;
  part.tau.value = tables.within(0, 1, "tau", channels, N);
  part.behind_patch = tables.indices("behind_patch", N);
  const std::size_t B = part.behind_patch.size();
  part.behind_begin = tables.indices("behind_begin", B + 1, N + 1);
  part.behind_share = tables.within(0, kMostNumber, "behind_share", 1, B);
  if (!std::ranges::is_sorted(part.behind_begin) || part.behind_begin.back() != B)
    refuse(result, "its table 'behind_begin' does not fit the others");
}

}  // namespace

void add_year_part(const YearPart& part, WrittenResult& result) {
  result.year_part = json_of(part).dump(-1, ' ', false, Json::error_handler_t::replace);
  auto& to = result.year_tables;
  to[kPlace] = table(std::vector<std::size_t>{part.part, part.first_point, part.first_sensor});
  to[kPoints] = table(part.of_points);
  to[kSensors] = table(part.of_sensors);
  to["rooms"] = table(part.rooms);
  to["grids"] = table(part.grids);
  WrittenTable& sensors = to["sensors"] = {3, {}};
  for (const SensorPoint& s : part.sensors) add(s.position, sensors), add(s.normal, sensors);
  to["origin"] = table(std::vector<Vec3>{part.origin});
  to["position"] = table(part.position);
  to["patch_of_point"] = table(part.patch_of_point);
  to["rho"] = table(part.rho);
  if (part.tau.value.empty()) return;
  to["tau"] = table(part.tau);
  to["behind_begin"] = table(part.behind_begin);
  to["behind_patch"] = table(part.behind_patch);
  to["behind_share"] = table(part.behind_share);
}

YearPart year_part_of(const WrittenResult& result) {
  if (result.year_part.empty())
    throw InputError(result.file + ": is no part of a year; give the files that clerestory annual --part i/n wrote.");
  YearPart part;
  try {
    read_facts(parse_json<Json>(result.year_part, result.file), result, part);
  } catch (const nlohmann::json::exception& error) {
    refuse(result, quotable(error.what(), 100));
  }
  const Tables tables(result);
  const auto is_illuminance = [](double lux) { return lux > 0 && lux <= kMostNumber; };
  if (part.facts.occupied_hours < 1 || part.more_thresholds.size() > kMostThresholds ||
      !is_illuminance(part.facts.threshold) || !std::ranges::all_of(part.more_thresholds, is_illuminance))
    refuse(result, "its hours and thresholds");
  constexpr auto kAny = std::numeric_limits<std::uint32_t>::max();
  const std::vector<double>& place = tables.numbers(kPlace, 1, 3);
  part.part = tables.index(kPlace, place[0], kAny);
  part.first_point = tables.index(kPlace, place[1], kAny);
  part.first_sensor = tables.index(kPlace, place[2], kAny);
  if (part.part < 1 || part.part > part.parts) refuse(result, text("it is part ", part.part, " of ", part.parts));
  const std::vector<Vec3> sensors = tables.vectors("sensors");
  for (std::size_t i = 0; i + 1 < sensors.size(); i += 2) part.sensors.push_back({sensors[i], sensors[i + 1]});
  part.rooms = tables.areas("rooms", part.facts.rooms, result.points.size());
  part.grids = tables.areas("grids", part.facts.grids, part.sensors.size());
  read_scattering(tables, result, part);
  part.of_points = tables.years(kPoints);
  part.of_sensors = tables.years(kSensors);
  if (part.first_point + part.of_points.size() > result.points.size() ||
      part.first_sensor + part.of_sensors.size() > part.sensors.size())
    refuse(result, "it has more points than there are");
  return part;
}

void require_whole_year(const WrittenResult& result) {
  if (result.year_part.empty()) return;
  const YearPart part = year_part_of(result);
  throw InputError(text(result.file, ": is part ", part.part, " of ", part.parts,
                        " of a year; merge it first: clerestory merge PART.vtp... -o OUT.vtp"));
}

bool is_of_one_part(const std::string& table) { return table == kPlace || table == kPoints || table == kSensors; }

}  // namespace clerestory
