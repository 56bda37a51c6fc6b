#include "solver/model/inner_rooms.h"

#include <algorithm>
#include <string_view>

#include "solver/model/patch_set.h"

namespace clerestory {
namespace {

constexpr double kOpen = 0.5;  // of open ground; the brightest rooms behind glass have a third

std::vector<bool> open_air(const WrittenResult& result) {
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  std::vector<double> flux(result.rooms.size(), 0), area(result.rooms.size(), 0);
  for (std::size_t i = 0; i < result.room.size(); ++i) {
    const auto& [a, b, c] = result.triangles[i];
    const Vec3 x = result.points[a];
    const double A = length(cross(result.points[b] - x, result.points[c] - x)) / 2;
    area[result.room[i]] += A;
    flux[result.room[i]] += A * (double{lux[a]} + lux[b] + lux[c]) / 3;
  }
  const auto& reference = result.around.daylight_reference;
  std::vector<bool> is_open;
  for (std::size_t k = 0; k < result.rooms.size(); ++k)
    is_open.push_back(result.rooms[k] == kOutdoors || (reference && flux[k] > kOpen * *reference * area[k]));
  return is_open;
}

/// "room 12", as rooms are called that nobody gave a name.
bool has_only_a_number(std::string_view name) {
  constexpr std::string_view kRoom = kUnnamedRoom;
  return name.starts_with(kRoom) && name.size() > kRoom.size() &&
         name.find_first_not_of("0123456789", kRoom.size()) == name.npos;
}

std::vector<bool> inner_of(const std::vector<std::string>& rooms, const std::vector<bool>& is_open) {
  std::vector<bool> inner(rooms.size()), named(rooms.size());
  for (std::size_t k = 0; k < inner.size(); ++k) {
    inner[k] = !is_open[k] && rooms[k] != kSmallerSpaces;
    named[k] = inner[k] && !has_only_a_number(rooms[k]);
  }
  if (std::ranges::find(named, true) != named.end()) return named;
  if (std::ranges::find(inner, true) == inner.end())
    for (std::size_t k = 0; k < inner.size(); ++k) inner[k] = rooms[k] != kOutdoors;
  return inner;
}

}  // namespace

std::vector<bool> inner_rooms(const WrittenResult& result) { return inner_of(result.rooms, open_air(result)); }

std::vector<bool> inner_rooms(const std::vector<std::string>& rooms) {
  std::vector<bool> is_open;
  for (const std::string& name : rooms) is_open.push_back(name == kOutdoors);
  return inner_of(rooms, is_open);
}

}  // namespace clerestory
