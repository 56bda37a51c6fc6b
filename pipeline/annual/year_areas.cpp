#include "pipeline/annual/year_areas.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "solver/model/inner_rooms.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

const double kFacesUp = std::cos(25 * std::numbers::pi / 180);

/// Blinds scatter: what they let through closed is no beam, so closing a group takes all of its sun. That is what its
/// closed state lacks, over the share that it lacks. Some hours at a time, so that memory does not grow with the year.
void operate_in(const std::vector<std::unique_ptr<WindowState>>& states, std::span<const PlacesOfPoint> points,
                const YearRules& rules, YearArea& area) {
  constexpr std::size_t kHours = 128, kPoints = 32;
  const std::size_t H = states.front()->year().hours, n = area.points.size(), groups = states.size() - 1;
  std::vector<PlacesOfPoint> own;
  for (const std::size_t p : area.points) own.push_back(points[p]);
  area.blinds.resize(H);
  std::vector<std::vector<float>> sun(states.size()), taken(groups, std::vector<float>(n));
  std::vector<float> steady(n);
  const std::vector<std::span<const float>> windows(taken.begin(), taken.end());
  for (std::size_t first = 0; first < H; first += kHours) {
    const std::size_t hours = std::min(kHours, H - first);
    for (std::vector<float>& of_state : sun) of_state.resize(n * hours);
    parallel_for((n + kPoints - 1) / kPoints, 1, [&](std::size_t from, std::size_t to) {
      const std::size_t begin = kPoints * from, count = std::min(kPoints * to, n) - begin;
      for (std::size_t g = 0; g < states.size(); ++g)
        states[g]->sun_at(std::span(own).subspan(begin, count), first, hours,
                          std::span(sun[g]).subspan(begin * hours, count * hours));
    });
    for (std::size_t h = 0; h < hours; ++h) {
      for (std::size_t p = 0; p < n; ++p) {
        const float open = sun[0][p * hours + h];
        steady[p] = open;
        for (std::size_t g = 0; g < groups; ++g) {
          taken[g][p] = std::max(0.0f, open - sun[g + 1][p * hours + h]) / states[g + 1]->share_taken();
          steady[p] -= taken[g][p];
        }
        steady[p] = std::max(0.0f, steady[p]);
      }
      area.blinds[first + h] = close_blinds(windows, steady);
      if (rules.occupied[first + h] > 0) add_hour(area.blinds[first + h], area.closed);
    }
  }
}

}  // namespace

std::vector<YearArea> rooms_facing_up(const PatchSet& patches, const VertexLightmap& map) {
  const std::vector<bool> inner = inner_rooms(patches.rooms);
  std::vector<std::map<std::size_t, double>> weight(patches.rooms.size());
  for (std::size_t i = 0; i < patches.patch_count() && !patches.room.empty(); ++i)
    if (inner[patches.room[i]] && patches.normal[i].z >= kFacesUp)
      for (const std::uint32_t p : map.corners[i]) weight[patches.room[i]][p] += patches.area[i] / 3;
  std::vector<YearArea> rooms;
  for (std::size_t r = 0; r < weight.size(); ++r) {
    if (weight[r].empty()) continue;
    YearArea& room = rooms.emplace_back();
    room.name = patches.rooms[r], room.number = static_cast<std::uint32_t>(r);
    for (const auto& [point, area] : weight[r]) room.points.push_back(point), room.weight.push_back(area);
  }
  return rooms;
}

std::vector<std::uint32_t> room_of_points(const PatchSet& patches, const VertexLightmap& map,
                                          const std::vector<YearArea>& rooms) {
  const auto none = static_cast<std::uint32_t>(rooms.size());
  std::vector<std::uint32_t> place(patches.rooms.size(), none), of(map.position.size(), none);
  for (std::uint32_t k = 0; k < rooms.size(); ++k) place[rooms[k].number] = k;
  for (std::size_t p = 0; p < of.size() && !patches.room.empty(); ++p)
    of[p] = place[patches.room[map.patch_of_point[p]]];
  return of;
}

std::vector<YearArea> grids_of(const std::vector<SensorSet>& sets) {
  std::vector<YearArea> grids;
  std::size_t next = 0;
  for (const SensorSet& set : sets) {
    YearArea& grid = grids.emplace_back();
    grid.name = set.name, grid.has_area = set.area_of_point.has_value();
    for (std::size_t k = 0; k < set.points.size(); ++k) {
      grid.points.push_back(next++);
      grid.weight.push_back(set.area_of_point.value_or(1));
    }
  }
  return grids;
}

std::vector<std::uint32_t> set_of_sensors(const std::vector<SensorSet>& sets) {
  std::vector<std::uint32_t> of;
  for (std::uint32_t s = 0; s < sets.size(); ++s) of.insert(of.end(), sets[s].points.size(), s);
  return of;
}

void operate_blinds(const std::vector<std::unique_ptr<WindowState>>& states, std::span<const PlacesOfPoint> points,
                    const YearRules& rules, const Monitor& monitor, std::vector<YearArea>& areas) {
  for (std::size_t k = 0; k < areas.size(); ++k) {
    monitor.report("blinds", static_cast<double>(k) / static_cast<double>(areas.size()));
    operate_in(states, points, rules, areas[k]);
  }
}

void add_up(YearSolved& year) {
  const auto add = [&](std::vector<YearArea>& areas, const std::vector<PointYear>& of) {
    for (YearArea& area : areas) {
      std::vector<PointYear> points;
      for (const std::size_t p : area.points) points.push_back(of[p]);
      if (!points.empty()) area.figures = area_year(points, area.weight, year.rules);
    }
  };
  add(year.rooms, year.of_points);
  add(year.grids, year.of_sensors);
}

}  // namespace clerestory
