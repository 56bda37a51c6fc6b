#pragma once
// --schedule: which hours of a year are occupied.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace clerestory {

struct Schedule {
  std::string name;                    ///< "8-18", or a file's
  std::vector<std::uint8_t> occupied;  ///< by hour of the year, 8,760: 1 or 0
};

/// Whether these words are hours of the day, as "8-18", and not the name of a file.
bool is_hours_of_day(std::string_view words);

/// "8-18": from 8:00 to 18:00, every day, 3,650 hours. Whole hours of local standard time, also over midnight: "20-6".
/// Else a file of 8,760 numbers from 0 to 1, a line each, the first that of 1 January from 0:00 to 1:00: as Honeybee
/// writes them. An hour is occupied from 0.5 on.
///
/// throws  InputError: neither hours nor a file, no occupied hour, another count of lines, what is no number of [0, 1].
Schedule read_schedule(std::string_view hours_or_file);

}  // namespace clerestory
