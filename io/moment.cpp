#include "io/moment.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

using Seconds = std::chrono::sys_seconds;
constexpr long long kMostTimes = 200;  // elements and rays grow with their number, the cost with its square

bool has_shape(std::string_view s, std::string_view shape) {
  if (s.size() != shape.size()) return false;
  for (std::size_t i = 0; i < s.size(); ++i)
    if (shape[i] == 'd' ? s[i] < '0' || s[i] > '9' : s[i] != shape[i]) return false;
  return true;
}

Seconds seconds_of(const Moment& m) {
  using namespace std::chrono;
  const year_month_day date(year(m.year), month(static_cast<unsigned>(m.month)), day(static_cast<unsigned>(m.day)));
  return sys_days(date) + seconds(std::llround(m.hour * 3600));
}

Moment moment_of(Seconds time) {
  using namespace std::chrono;
  const sys_days midnight = floor<days>(time);
  const year_month_day date(midnight);
  return {static_cast<int>(date.year()), static_cast<int>(static_cast<unsigned>(date.month())),
          static_cast<int>(static_cast<unsigned>(date.day())), static_cast<double>((time - midnight).count()) / 3600};
}

/// PT1H30M; nothing for what is no duration.
std::optional<std::chrono::seconds> duration_of(std::string_view s) {
  struct Part {
    char letter;
    long long seconds;
    bool of_time;
  };
  constexpr Part kParts[] = {{'D', 86'400, false}, {'H', 3'600, true}, {'M', 60, true}, {'S', 1, true}};
  constexpr std::size_t kMostDigits = 9;
  if (s.size() < 3 || s.front() != 'P') return {};
  s.remove_prefix(1);
  long long sum = 0;
  bool in_time = false, complete = false;
  for (const Part& part : kParts) {
    if (!in_time && s.starts_with('T')) in_time = true, complete = false, s.remove_prefix(1);
    const std::size_t digits = std::min(s.find_first_not_of("0123456789"), s.size());
    if (digits == 0 || digits > kMostDigits || digits == s.size() || s[digits] != part.letter) continue;
    if (part.of_time != in_time) return {};
    sum += static_cast<long long>(*to_number(s.substr(0, digits))) * part.seconds;
    complete = true;
    s.remove_prefix(digits + 1);
  }
  return complete && s.empty() ? std::optional(std::chrono::seconds(sum)) : std::nullopt;
}

}  // namespace

Moment read_moment(const std::string& time, const std::string& place) {
  if (!has_shape(time, "dddd-dd-ddTdd:dd") && !has_shape(time, "dddd-dd-ddTdd:dd:dd")) {
    throw InputError(text(place, " '", quotable(time), "' is not a time; write it as 2026-06-21T12:00, local standard ",
                          "time without a zone"));
  }
  const auto part = [&](std::size_t begin, std::size_t n) {
    return static_cast<int>(*to_number(std::string_view(time).substr(begin, n)));
  };
  const int seconds = time.size() == 19 ? part(17, 2) : 0;
  using namespace std::chrono;
  const year_month_day date(year(part(0, 4)), month(static_cast<unsigned>(part(5, 2))),
                            day(static_cast<unsigned>(part(8, 2))));
  if (!date.ok() || part(11, 2) > 23 || part(14, 2) > 59 || seconds > 59) {
    throw InputError(text(place, " '", time, "' does not exist; months are 01 to 12, days those of ",
                          "the month, hours 00 to 23, minutes and seconds 00 to 59"));
  }
  return {part(0, 4), part(5, 2), part(8, 2), part(11, 2) + part(14, 2) / 60.0 + seconds / 3600.0};
}

std::string moment_text(const Moment& m) {
  const long long seconds = std::llround(m.hour * 3600);
  char out[40];
  std::snprintf(out, sizeof out, "%04d-%02d-%02dT%02lld:%02lld", m.year, m.month, m.day, seconds / 3600,
                seconds / 60 % 60);
  std::string written = out;
  if (seconds % 60 == 0) return written;
  std::snprintf(out, sizeof out, ":%02lld", seconds % 60);
  return written + out;
}

double hours_since(const Moment& first, const Moment& moment) {
  return static_cast<double>((seconds_of(moment) - std::chrono::floor<std::chrono::days>(seconds_of(first))).count()) /
         3600;
}

std::vector<Moment> read_times(const std::string& series, const std::string& what) {
  const std::string who = text(what, " '", quotable(series, 80), "'");
  constexpr const char* kExample = "write it as 2026-03-21T06:00/20:00/PT1H: from, to, step";
  const std::size_t first = series.find('/'), last = series.rfind('/');
  if (first == last || series.find('/', first + 1) != last)
    throw InputError(text(who, " is no series of times; ", kExample));
  const std::string from = series.substr(0, first), step = series.substr(last + 1);
  std::string to = series.substr(first + 1, last - first - 1);
  const Moment begin = read_moment(from, what);
  if (has_shape(to, "dd:dd") || has_shape(to, "dd:dd:dd")) to = from.substr(0, 11) + to;
  const Moment end = read_moment(to, what);
  const std::optional<std::chrono::seconds> duration = duration_of(step);
  if (!duration)
    throw InputError(text(who, ": '", quotable(step), "' is no duration; write PT1H, PT30M or P1D, whole days, hours, ",
                          "minutes and seconds"));
  if (duration->count() == 0) throw InputError(text(who, ": a step of 0 comes to no end; write PT1H"));
  const Seconds start = seconds_of(begin), stop = seconds_of(end);
  if (stop < start) throw InputError(text(who, " ends before it begins; ", kExample));
  const long long count = (stop - start) / *duration + 1;
  if (count > kMostTimes)
    throw InputError(text(who, " has ", count, " times; at most ", kMostTimes, ": take a longer step or less ",
                          "time, or clerestory annual for a year"));
  std::vector<Moment> times;
  for (long long k = 0; k < count; ++k) times.push_back(moment_of(start + k * *duration));
  return times;
}

}  // namespace clerestory
