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

/// Separated as the file is; a separator between quotation marks is part of its cell.
Cells cells_of(std::string_view row, char separator) {
  Cells cells;
  while (cells.size() <= 1000) {
    row.remove_prefix(std::min(row.find_first_not_of(" \t"), row.size()));
    const std::size_t closing = row.starts_with('"') ? row.find('"', 1) : row.npos;
    const std::size_t end = row.find(separator, closing == row.npos ? 0 : closing);
    cells.push_back(unquoted(row.substr(0, end)));
    if (end == row.npos) break;
    row.remove_prefix(end + 1);
  }
  return cells;
}

/// One line, with what messages about it begin with.
struct Line {
  std::string where;
  Cells cells;

  std::string_view cell(std::size_t column) const { return column < cells.size() ? cells[column] : std::string_view{}; }
  double number(std::size_t column, std::string_view name, double low, double high) const {
    if (column >= cells.size())
      throw InputError(text(where, name, " is missing: the line has ", cells.size(), " values"));
    const std::optional<double> x = to_decimal(cells[column]);
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
  /// A number of [low, missing), from where on it marks that nothing was measured; what is no number is nothing too.
  std::optional<double> measured(std::size_t column, double low, double missing) const {
    const std::optional<double> x = to_decimal(cell(column));
    return x && *x >= low && *x < missing ? x : std::nullopt;
  }
};

/// Radiation [W/m2], nothing where it is missing; what else is wrong with it goes to `flaw`.
std::optional<double> radiation(const Line& line, std::size_t column, std::string_view name, std::string& flaw) {
  constexpr double kOffset = -5, kMissing = 9999, kMost = 1500;  // the sun outside the air gives 1367
  if (line.cell(column).empty()) return std::nullopt;
  const std::optional<double> x = to_decimal(line.cell(column));
  if (x && (*x < kOffset || *x >= kMissing)) return std::nullopt;
  if (x && *x <= kMost) return std::max(*x, 0.0);
  flaw = x && !std::isnan(*x) ? text(name, " = ", *x, " is outside [0, ", kMost, "] W/m2")
                              : text(name, " = '", quotable(line.cell(column)), "' is not a number");
  return std::nullopt;
}

/// Illuminance [lx]. Besides 999999 and its like, the fillers of other columns are found here.
std::optional<double> illuminance(const Line& line, std::size_t column) {
  const std::optional<double> lux = line.measured(column, 0, 999'900);
  return lux == 9999 || lux == 99'999 ? std::nullopt : lux;
}

/// "3/21", "3/21/2005" or "2005/3/21", with blanks and - for / perhaps, as days of a calendar; nothing for other words.
std::optional<std::chrono::sys_days> period_day(std::string_view date) {
  using namespace std::chrono;
  std::vector<int> part;
  while (part.size() <= 3) {
    const std::size_t end = date.find_first_of("/-");
    const std::optional<double> x = to_number(trimmed(date.substr(0, end)));
    if (!x || !(*x >= 1 && *x <= 9999) || *x != std::floor(*x)) return std::nullopt;
    part.push_back(static_cast<int>(*x));
    if (end == date.npos) break;
    date.remove_prefix(end + 1);
  }
  if (part.size() == 2) part.push_back(2001);  // without a year, of one without a leap day
  if (part.size() != 3) return std::nullopt;
  if (part[0] > 31) part = {part[1], part[2], part[0]};
  const year_month_day parsed(year(part[2]), month(static_cast<unsigned>(part[0])),
                              day(static_cast<unsigned>(part[1])));
  return parsed.ok() ? std::optional<sys_days>(parsed) : std::nullopt;
}

/// Hours that the last line of the header promises at least: leap days may be there or not. 0: it does not say.
std::size_t promised_hours(const Line& line, std::vector<std::string>& warnings) {
  using namespace std::chrono;
  const int periods = line.whole(1, "the number of periods", 1, 100);
  const int per_hour = line.whole(2, "the number of records an hour", 1, 60);
  if (per_hour != 1) throw InputError(text(line.where, per_hour, " records an hour; only hourly files are read"));
  long total = 0;
  for (int k = 0; k < periods; ++k) {
    const auto column = static_cast<std::size_t>(5 + 4 * k);
    const auto first = period_day(line.cell(column)), last = period_day(line.cell(column + 1));
    if (!first || !last) {
      warnings.push_back(text(line.where, "'", quotable(line.cell(first ? column + 1 : column)),
                              "' is not a date, month/day; whether the file is complete is not known"));
      return 0;
    }
    const long length = (*last - *first).count() + 1;
    total += length > 0 ? length : length + 365;  // over the end of the year
    for (year y = year_month_day(*first).year(); y <= year_month_day(*last).year(); ++y)
      if (const sys_days leap_day = y / February / 29; y.is_leap() && *first <= leap_day && leap_day <= *last) --total;
  }
  if (total > 100'000)
    throw InputError(text(line.where, "periods of ", total, " days; it is damaged, download it again"));
  return total > 0 ? static_cast<std::size_t>(total) * 24 : 0;
}

WeatherHour hour_of(const Line& line) {
  WeatherHour h;
  try {
    h.day = line.whole(2, "the day", 1, 31);
    h.hour = line.whole(3, "the hour", 0, 24);
    h.month = line.whole(1, "the month", 1, 12);
  } catch (const InputError& error) {
    h.flaw = std::string_view(error.what()).substr(line.where.size());
    return h;
  }
  h.year = static_cast<int>(line.measured(0, 1, 10'000).value_or(h.year));
  constexpr std::size_t kLeast = 16;  // up to the radiation
  if (line.cells.size() < kLeast)
    h.flaw = text("has ", line.cells.size(), line.cells.size() == 1 ? " value" : " values",
                  "; an hour has 35. The file is damaged or cut short");
  h.dew_point_c = line.measured(7, -90, 99.9);
  h.direct_normal = radiation(line, 14, "the direct normal radiation", h.flaw);
  h.diffuse_horizontal = radiation(line, 15, "the diffuse horizontal radiation", h.flaw);
  h.direct_normal_lux = illuminance(line, 17);
  h.diffuse_horizontal_lux = illuminance(line, 18);
  if (const auto mm = line.measured(28, 0, 999)) h.precipitable_water_cm = *mm / 10;
  return h;
}

/// Hours that are counted from 0: of a file that begins with one, by their beginning; else 0 is 24 of the day before.
void settle_hour_0(Weather& weather) {
  std::vector<WeatherHour>& hours = weather.hours;
  const auto is_0 = [](const WeatherHour& h) { return h.month > 0 && h.hour == 0; };
  if (std::ranges::none_of(hours, is_0)) return;
  const bool by_beginning = is_0(hours.front());
  for (std::size_t i = 0; i < hours.size(); ++i) {
    WeatherHour& h = hours[i];
    if (h.month == 0) continue;
    if (by_beginning) {
      h.hour = std::min(h.hour + 1, 24);
    } else if (h.hour == 0) {
      h.hour = 24;
      if (hours[i - 1].month > 0) h.year = hours[i - 1].year, h.month = hours[i - 1].month, h.day = hours[i - 1].day;
    }
  }
  weather.warnings.push_back(text(weather.file, ": counts hours from 0; hour 0 is taken as ",
                                  by_beginning ? "the one from 0:00 to 1:00" : "the last one of the day before"));
}

/// LOCATION,city,state,country,source,number,latitude,longitude,time zone,elevation
void read_location(const Line& line, Weather& weather) {
  if (to_lower(line.cells[0]) != "location")
    throw InputError(text(line.where, "begins with '", quotable(line.cells[0]),
                          "' and not with LOCATION; it is no EPW weather file. Name one"));
  std::size_t n = line.cells.size();
  while (n > 0 && line.cells[n - 1].empty()) --n;
  // A comma in the name of the city, without quotation marks, moves what follows.
  const std::size_t first = n > 10 && to_decimal(line.cells[n - 4]) ? n - 4 : 6;
  weather.city = clean_text(line.cell(1));
  weather.place = {line.number(first, "the latitude", -90, 90), line.number(first + 1, "the longitude", -180, 180),
                   line.number(first + 2, "the time zone", -14, 14)};
}

}  // namespace

const WeatherHour& Weather::at(int month, int day, int hour, std::optional<int> year) const {
  const WeatherHour* found = nullptr;
  for (const WeatherHour& h : hours) {
    if (h.month != month || h.day != day || h.hour != hour) continue;
    if (!found || h.year == year) found = &h;
    if (!year || h.year == year) break;
  }
  if (found) return *found;
  const auto has_date = [](const WeatherHour& h) { return h.month > 0; };
  const auto first = std::ranges::find_if(hours, has_date);
  const auto last = std::find_if(hours.rbegin(), hours.rend(), has_date);
  const auto bad = std::ranges::find_if_not(hours, has_date);
  throw InputError(text(file, ": has no hour ", hour, " of ", month, "/", day, " (month/day); ",
                        first == hours.end()
                            ? "no line has a date"
                            : text("it goes from ", first->month, "/", first->day, " to ", last->month, "/", last->day),
                        bad == hours.end() ? "" : text(". In line ", bad->line, " ", bad->flaw)));
}

Weather read_epw(const std::filesystem::path& file) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  Weather weather;
  weather.file = short_name(file);
  std::size_t number = 0, promised = 0;
  char separator = ',';
  for (std::string_view rest = text_bytes(bytes, weather.file); !rest.empty();) {
    const std::string_view row = trimmed(next_line(rest));
    ++number;
    if (const std::size_t first = row.find_first_of(",;\t"); number == 1 && first != row.npos) separator = row[first];
    if (number > kHeaderLines && row.empty()) continue;
    const bool used = number == 1 || number >= kHeaderLines;
    const Line line{text(weather.file, ":", number, ": "), used ? cells_of(row, separator) : Cells{}};
    if (number == 1) {
      read_location(line, weather);
    } else if (number == kHeaderLines) {
      if (to_lower(line.cells[0]) != "data periods")
        throw InputError(text(line.where, "begins with '", quotable(line.cells[0]), "' and not with DATA PERIODS; the ",
                              "header has 8 lines. Download it again"));
      promised = promised_hours(line, weather.warnings);
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
  if (weather.hours.size() < promised)
    throw InputError(text(weather.file, ": has ", weather.hours.size(), " hours; its DATA PERIODS say ", promised,
                          ". The file is cut short"));
  if (weather.hours.empty()) throw InputError(text(weather.file, ": has no hours; download it again"));
  settle_hour_0(weather);
  return weather;
}

}  // namespace clerestory
