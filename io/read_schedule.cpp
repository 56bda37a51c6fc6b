#include "io/read_schedule.h"

#include <algorithm>
#include <optional>
#include <system_error>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/annual.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 1u << 20;

/// A whole hour of digits alone; nothing for other words.
std::optional<int> hour_of(std::string_view word) {
  const bool digits = !word.empty() && word.size() <= 3 && word.find_first_not_of("0123456789") == word.npos;
  return digits ? std::optional(static_cast<int>(*to_number(word))) : std::nullopt;
}

struct DailyHours {
  int from = 0, to = 0;
};

std::optional<DailyHours> daily_hours(std::string_view asked) {
  const std::size_t dash = asked.find('-');
  if (dash == asked.npos) return std::nullopt;
  const auto from = hour_of(trimmed(asked.substr(0, dash))), to = hour_of(trimmed(asked.substr(dash + 1)));
  return from && to ? std::optional(DailyHours{*from, *to}) : std::nullopt;
}

Schedule every_day(const std::string& name, const DailyHours& daily) {
  if (daily.from > 24 || daily.to > 24)
    throw InputError(text("--schedule '", name, "' has an hour outside [0, 24]; write it as 8-18"));
  if (daily.from % 24 == daily.to % 24 && daily.to - daily.from != 24)
    throw InputError(text("--schedule '", name, "' has no hours; write the first and the end of the last, as 8-18"));
  Schedule schedule{name, std::vector<std::uint8_t>(kHoursOfYear)};
  for (std::size_t h = 0; h < kHoursOfYear; ++h) {
    const int of_day = static_cast<int>(h % 24);
    schedule.occupied[h] =
        daily.from < daily.to ? of_day >= daily.from && of_day < daily.to : of_day >= daily.from || of_day < daily.to;
  }
  return schedule;
}

Schedule from_file(const std::string& file) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  const std::string name = short_name(file);
  Schedule schedule{name, {}};
  std::size_t line = 0;
  for (std::string_view rest = text_bytes(bytes, name); !rest.empty();) {
    const std::string_view row = trimmed(next_line(rest));
    ++line;
    if (row.empty()) continue;
    const std::optional<double> x = to_number(row);
    if (!x || !(*x >= 0 && *x <= 1)) {
      throw InputError(text(name, ":", line, ": '", quotable(row), "' is not a number of [0, 1]; a schedule has ",
                            kHoursOfYear, " of them, a line each"));
    }
    schedule.occupied.push_back(*x >= 0.5);
  }
  if (schedule.occupied.size() != kHoursOfYear) {
    throw InputError(text(name, ": has ", schedule.occupied.size(), " hours; a schedule has ", kHoursOfYear,
                          ", one for each hour of a year of 365 days"));
  }
  if (std::ranges::count(schedule.occupied, 1) == 0)
    throw InputError(text(name, ": no hour is occupied; hours count from 0.5 on"));
  return schedule;
}

}  // namespace

bool is_hours_of_day(std::string_view words) { return daily_hours(words).has_value(); }

Schedule read_schedule(std::string_view asked) {
  const std::string name(asked);
  if (const auto daily = daily_hours(asked)) return every_day(name, *daily);
  std::error_code none;
  if (!std::filesystem::exists(name, none)) {
    throw InputError(text("--schedule '", quotable(asked), "' is neither hours of the day, as 8-18, nor a file of ",
                          kHoursOfYear, " numbers that is there"));
  }
  return from_file(name);
}

}  // namespace clerestory
