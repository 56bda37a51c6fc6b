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
using Order = std::array<std::size_t, 6>;  ///< position in a row of each of kColumns

/// Parts of a row between commas or semicolons.
std::vector<std::string_view> cells_of(std::string_view row) {
  std::vector<std::string_view> cells;
  while (cells.size() <= 64) {  // no sensor file has more columns; a row of a million commas is refused all the same
    const std::size_t end = row.find_first_of(",;");
    std::string_view cell = trimmed(row.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (end == row.npos) break;
    row.remove_prefix(end + 1);
  }
  return cells;
}

/// Cells of a row without the empty ones at its end, which spreadsheets leave.
std::size_t value_count(const std::vector<std::string_view>& cells) {
  std::size_t n = cells.size();
  while (n > 0 && cells[n - 1].empty()) --n;
  return n;
}

/// Order of the columns when the row is a header, that is, has no number in it.
std::optional<Order> header_order(const std::vector<std::string_view>& cells, const std::string& where) {
  if (std::any_of(cells.begin(), cells.end(), [](std::string_view cell) { return to_number(cell).has_value(); }))
    return {};
  Order order{};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](std::string_view cell) { return to_lower(cell) == kColumns[k]; });
    if (found == cells.end()) {
      throw InputError(text(where, "no column '", kColumns[k], "' in the header; expected x,y,z,nx,ny,nz"));
    }
    order[k] = static_cast<std::size_t>(found - cells.begin());
  }
  return order;
}

SensorPoint point_of(const std::vector<std::string_view>& cells, const Order& order, const std::string& where) {
  std::array<double, 6> value{};
  for (std::size_t k = 0; k < 6; ++k) {
    if (order[k] >= cells.size()) {
      throw InputError(
          text(where, cells.size(), cells.size() == 1 ? " value" : " values", "; expected x,y,z,nx,ny,nz"));
    }
    const std::string_view cell = cells[order[k]];
    const std::optional<double> number = to_number(cell);
    if (!number) throw InputError(text(where, kColumns[k], " = '", quotable(cell), "' is not a number"));
    if (!(std::abs(*number) <= 1e12))
      throw InputError(text(where, kColumns[k], " = ", quotable(cell), " is outside [-1e12, 1e12]"));
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
  std::size_t columns = 6;  // a header may name more, of which we know nothing
  std::size_t row_number = 0;
  for (std::size_t begin = bytes.starts_with("\xef\xbb\xbf") ? 3 : 0; begin < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', begin), bytes.size());
    const std::string_view row = trimmed(std::string_view(bytes).substr(begin, end - begin));
    begin = end + 1;
    ++row_number;
    if (row.empty() || row.front() == '#') continue;
    const std::string where = text(name, ": row ", row_number, ": ");
    const std::vector<std::string_view> cells = cells_of(row);
    if (!order) {
      order = header_order(cells, where);
      if (order) {
        columns = cells.size();
        continue;
      }
      order = Order{0, 1, 2, 3, 4, 5};
    }
    if (value_count(cells) > columns)
      throw InputError(text(where, value_count(cells), " values; expected ",
                            columns == 6 ? "x,y,z,nx,ny,nz" : text("the ", columns, " of the header")));
    sensors.points.push_back(point_of(cells, *order, where));
    if (sensors.points.size() > kMaxSensors) throw InputError(text(name, ": has more than ", kMaxSensors, " rows"));
  }
  if (sensors.points.empty()) throw InputError(text(name, ": has no sensor; expected rows of x,y,z,nx,ny,nz"));
  return sensors;
}

}  // namespace clerestory
