#include "io/formats/epw.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 64u << 20;
constexpr std::size_t kHeaderLines = 8, kMostHours = 200'000;

using Cells = std::vector<std::string_view>;

Cells cells_of(std::string_view row) {
  Cells cells;
  while (cells.size() <= 1000) {
    const std::size_t end = row.find(',');
    cells.push_back(trimmed(row.substr(0, end)));
    if (end == row.npos) break;
    row.remove_prefix(end + 1);
  }
  return cells;
}

/// One line, with what messages about it begin with.
struct Line {
  std::string where;
  Cells cells;

  double number(std::size_t column, std::string_view name, double low, double high) const {
    if (column >= cells.size())
      throw InputError(text(where, name, " is missing: the line has ", cells.size(), " values"));
    const std::optional<double> x = to_number(cells[column]);
    if (!x) throw InputError(text(where, name, " = '", quotable(cells[column]), "' is not a number"));
    if (!(*x >= low && *x <= high))
      throw InputError(text(where, name, " = ", *x, " is outside [", low, ", ", high, "]"));
    return *x;
  }
  int whole(std::size_t column, std::string_view name, double low, double high) const {
    const double x = number(column, name, low, high);
    if (x != std::floor(x)) throw InputError(text(where, name, " = ", x, " is not a whole number"));
    return static_cast<int>(x);
  }
  /// A quantity; nothing from `missing` on, which marks that it was not measured.
  std::optional<double> measured(std::size_t column, std::string_view name, double low, double missing) const {
    const double x = number(column, name, low, 1e12);
    return x < missing ? std::optional(x) : std::nullopt;
  }
};

/// "3/21", with blanks and a year perhaps, as days of a calendar.
std::chrono::sys_days period_day(std::string_view date, const Line& line) {
  using namespace std::chrono;
  int part[3] = {0, 0, 2001};  // without a year, of one without a leap day
  std::size_t n = 0;
  for (std::string_view rest = date; n < 3; ++n) {
    const std::size_t slash = rest.find('/');
    const std::optional<double> x = to_number(trimmed(rest.substr(0, slash)));
    if (!x || !(*x >= 1 && *x <= 9999) || *x != std::floor(*x)) break;
    part[n] = static_cast<int>(*x);
    if (slash == rest.npos) {
      ++n;
      break;
    }
    rest.remove_prefix(slash + 1);
  }
  const year_month_day parsed(year(part[2]), month(static_cast<unsigned>(part[0])),
                              day(static_cast<unsigned>(part[1])));
  if (n < 2 || !parsed.ok())
    throw InputError(text(line.where, "'", quotable(date), "' is not a date; expected month/day"));
  return parsed;
}

/// Hours that the last line of the header says.
std::size_t promised_hours(const Line& line) {
  const int periods = line.whole(1, "the number of periods", 1, 100);
  const int per_hour = line.whole(2, "the number of records an hour", 1, 60);
  if (per_hour != 1) throw InputError(text(line.where, per_hour, " records an hour; only hourly files are read"));
  long days = 0;
  for (int k = 0; k < periods; ++k) {
    const auto column = static_cast<std::size_t>(5 + 4 * k);
    if (column + 1 >= line.cells.size())
      throw InputError(text(line.where, "has ", line.cells.size(), " values; expected first and last day of ", periods,
                            periods == 1 ? " period" : " periods"));
    const long length = (period_day(line.cells[column + 1], line) - period_day(line.cells[column], line)).count() + 1;
    days += length > 0 ? length : length + 365;  // over the end of the year
  }
  if (days < 0 || days > 10'000) throw InputError(text(line.where, "periods of ", days, " days"));
  return static_cast<std::size_t>(days) * 24;
}

WeatherHour hour_of(const Line& line) {
  constexpr std::size_t kLeast = 29;  // files of early versions have fewer than the 35 of today, but all these
  if (line.cells.size() < kLeast)
    throw InputError(text(line.where, "has ", line.cells.size(), line.cells.size() == 1 ? " value" : " values",
                          "; an hour has 35. The file is damaged or cut short"));
  WeatherHour h;
  h.year = line.whole(0, "the year", 1, 9999);
  h.month = line.whole(1, "the month", 1, 12);
  h.day = line.whole(2, "the day", 1, 31);
  h.hour = line.whole(3, "the hour", 1, 24);
  h.dew_point_c = line.measured(7, "the dew point", -150, 99.9);
  h.direct_normal = line.measured(14, "the direct normal radiation", 0, 9999);
  h.diffuse_horizontal = line.measured(15, "the diffuse horizontal radiation", 0, 9999);
  h.direct_normal_lux = line.measured(17, "the direct normal illuminance", 0, 999'900);
  h.diffuse_horizontal_lux = line.measured(18, "the diffuse horizontal illuminance", 0, 999'900);
  if (const auto mm = line.measured(28, "the precipitable water", 0, 999)) h.precipitable_water_cm = *mm / 10;
  return h;
}

}  // namespace

const WeatherHour& Weather::at(int month, int day, int hour) const {
  const auto found = std::find_if(hours.begin(), hours.end(), [&](const WeatherHour& h) {
    return h.month == month && h.day == day && h.hour == hour;
  });
  if (found == hours.end()) {
    const WeatherHour &first = hours.front(), &last = hours.back();
    throw InputError(text(file, ": has no hour ", hour, " of ", month, "/", day, " (month/day); it goes from ",
                          first.month, "/", first.day, " to ", last.month, "/", last.day));
  }
  return *found;
}

Weather read_epw(const std::filesystem::path& file) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  Weather weather;
  weather.file = short_name(file);
  std::size_t number = 0, promised = 0;
  for (std::size_t begin = bytes.starts_with("\xef\xbb\xbf") ? 3 : 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string_view row = trimmed(std::string_view(bytes).substr(begin, end - begin));
    begin = end + 1;
    ++number;
    if (number > kHeaderLines && row.empty()) continue;
    const bool used = number == 1 || number >= kHeaderLines;
    const Line line{text(weather.file, ":", number, ": "), used ? cells_of(row) : Cells{}};
    if (number == 1) {
      if (to_lower(line.cells[0]) != "location")
        throw InputError(text(line.where, "begins with '", quotable(line.cells[0]),
                              "' and not with LOCATION; it is no ", "EPW weather file"));
      weather.city = line.cells.size() > 1 ? clean_text(line.cells[1]) : "";
      weather.place = {line.number(6, "the latitude", -90, 90), line.number(7, "the longitude", -180, 180),
                       line.number(8, "the time zone", -14, 14)};
    } else if (number == kHeaderLines) {
      if (to_lower(line.cells[0]) != "data periods")
        throw InputError(text(line.where, "begins with '", quotable(line.cells[0]), "' and not with DATA PERIODS; the ",
                              "header has 8 lines"));
      promised = promised_hours(line);
    } else if (number > kHeaderLines) {
      weather.hours.push_back(hour_of(line));
      weather.hours.back().line = static_cast<int>(number);
      if (weather.hours.size() > kMostHours) throw InputError(text(weather.file, ": more than ", kMostHours, " hours"));
    }
  }
  if (number < kHeaderLines) {
    throw InputError(text(weather.file, ": ends after ", number, number == 1 ? " line" : " lines",
                          "; the header of an EPW file has 8"));
  }
  // A leap day may be there or not.
  if (weather.hours.size() != promised && weather.hours.size() != promised + 24) {
    throw InputError(text(weather.file, ": has ", weather.hours.size(), " hours; its DATA PERIODS say ", promised,
                          weather.hours.size() < promised ? ". The file is cut short" : ""));
  }
  if (weather.hours.empty()) throw InputError(text(weather.file, ": has no hours"));
  return weather;
}

}  // namespace clerestory
