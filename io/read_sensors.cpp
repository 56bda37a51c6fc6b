#include "io/read_sensors.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "io/input_file.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr std::uintmax_t kMaxBytes = 2ull << 30;
constexpr std::array<std::string_view, 6> kColumns = {"x", "y", "z", "nx", "ny", "nz"};
using Order = std::array<std::size_t, kColumns.size()>;  ///< position in a row of each of kColumns

constexpr std::string_view kAnySeparator = ",;\t ", kNoComma = ";\t ";

using Cells = std::vector<std::string_view>;

/// Parts of a row between separators; blanks and tabs beside one another, or beside another separator, count as one.
Cells cells_of(std::string_view row, std::string_view separators) {
  Cells cells;
  const auto skip_blanks = [&] { row.remove_prefix(std::min(row.find_first_not_of(" \t"), row.size())); };
  while (cells.size() <= 64) {  // no sensor file has more columns; a row of a million commas is refused all the same
    skip_blanks();
    const std::size_t closing = row.starts_with('"') ? row.find('"', 1) : row.npos;
    const std::size_t end = row.find_first_of(separators, closing == row.npos ? 0 : closing);
    cells.push_back(unquoted(row.substr(0, end)));
    if (end == row.npos) break;
    row.remove_prefix(end);
    skip_blanks();
    if (row.starts_with(',') || row.starts_with(';')) row.remove_prefix(1);
  }
  return cells;
}

bool is_number(std::string_view cell) { return to_decimal(cell).has_value(); }

/// Cells of a row without the empty ones at its end, which spreadsheets leave.
std::size_t value_count(const Cells& cells) {
  std::size_t n = cells.size();
  while (n > 0 && cells[n - 1].empty()) --n;
  return n;
}

/// As a row of `columns` values, by what separates the header's names, else by anything, else with decimal commas.
Cells row_of(std::string_view row, std::string_view separators, std::size_t columns) {
  const Cells first = cells_of(row, separators);
  if (value_count(first) == columns) return first;
  for (const std::string_view others : {kAnySeparator, kNoComma})
    if (const Cells cells = cells_of(row, others); cells.size() == columns && std::ranges::all_of(cells, is_number))
      return cells;
  return first;
}

/// What separates the names of a header: blanks only where nothing else does, as a name may hold them.
std::string separators_of(std::string_view header) {
  std::string used;
  for (const char mark : {',', ';', '\t'})
    if (header.find(mark) != header.npos) used += mark;
  return used.empty() ? " " : used;
}

/// Position in a row of each of kColumns.
Order header_order(const Cells& names, const std::string& where) {
  Order order{};
  for (std::size_t k = 0; k < kColumns.size(); ++k) {
    const auto found =
        std::ranges::find_if(names, [&](std::string_view name) { return to_lower(name) == kColumns[k]; });
    if (found == names.end())
      throw InputError(text(where, "no column '", kColumns[k], "' in the header; expected x,y,z,nx,ny,nz"));
    order[k] = static_cast<std::size_t>(found - names.begin());
  }
  return order;
}

SensorPoint point_of(const Cells& cells, const Order& order, const std::string& where) {
  std::array<double, 6> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    if (order[k] >= cells.size()) {
      throw InputError(
          text(where, cells.size(), cells.size() == 1 ? " value" : " values", "; expected x,y,z,nx,ny,nz"));
    }
    const std::string_view cell = cells[order[k]];
    const std::optional<double> number = to_decimal(cell);
    if (!number) throw InputError(text(where, kColumns[k], " = '", quotable(cell), "' is not a number"));
    if (!(std::abs(*number) <= 1e12))
      throw InputError(text(where, kColumns[k], " = ", quotable(cell), " is outside [-1e12, 1e12]; ",
                            k < 3 ? "positions are in metres" : "give a normal of length 1"));
    value[k] = *number;
  }
  const Vec3 n{value[3], value[4], value[5]};
  if (n == Vec3{}) throw InputError(text(where, "the normal is 0,0,0; it needs a direction, 0,0,1 is up"));
  return {{value[0], value[1], value[2]}, unit_vector(n)};
}

}  // namespace

SensorSet read_sensors(const std::filesystem::path& file) {
  const std::string bytes = read_input_file(file, kMaxBytes);
  const std::string name = short_name(file);
  SensorSet sensors{file.stem().string(), {}};
  std::optional<Order> order;
  std::string separators(kAnySeparator);
  std::size_t columns = kColumns.size();  // a header may name more, of which we know nothing
  std::size_t row_number = 0;
  for (std::string_view rest = text_bytes(bytes, name); !rest.empty();) {
    const std::string_view row = trimmed(next_line(rest));
    ++row_number;
    if (row.empty() || row.front() == '#') continue;
    const std::string where = text(name, ": row ", row_number, ": ");
    if (!order) {
      const Cells names = cells_of(row, separators_of(row));
      if (!is_number(cells_of(row, kAnySeparator)[0]) && std::ranges::none_of(names, is_number)) {
        order = header_order(names, where);
        separators = separators_of(row), columns = names.size();
        continue;
      }
      order = Order{0, 1, 2, 3, 4, 5};
    }
    const Cells cells = row_of(row, separators, columns);
    if (value_count(cells) > columns)
      throw InputError(text(where, value_count(cells), " values; expected ",
                            columns == kColumns.size() ? "x,y,z,nx,ny,nz" : text("the ", columns, " of the header")));
    sensors.points.push_back(point_of(cells, *order, where));
    if (sensors.points.size() > kMaxSensors) throw InputError(text(name, ": has more than ", kMaxSensors, " rows"));
  }
  if (sensors.points.empty()) throw InputError(text(name, ": has no sensor; expected rows of x,y,z,nx,ny,nz"));
  return sensors;
}

}  // namespace clerestory
