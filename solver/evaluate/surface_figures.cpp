#include "solver/evaluate/surface_figures.h"

#include <algorithm>
#include <map>
#include <utility>

namespace clerestory {
namespace {

double area_of(const Vec3& a, const Vec3& b, const Vec3& c) { return length(cross(b - a, c - a)) / 2; }

double area_of(const WrittenResult& result, std::size_t triangle) {
  const auto& [a, b, c] = result.triangles[triangle];
  return area_of(result.points[a], result.points[b], result.points[c]);
}

}  // namespace

void LitFigures::add(const LitFigures& other) {
  if (!(other.area > 0)) return;
  lowest = area > 0 ? std::min(lowest, other.lowest) : other.lowest;
  highest = std::max(highest, other.highest);
  mean = (mean * area + other.mean * other.area) / (area + other.area);
  area += other.area;
}

std::vector<RoomFigures> figures_by_room(const WrittenResult& result) {
  struct Sum {
    double area = 0, flux = 0, lowest = 0, highest = 0;
  };
  const std::vector<float>& lux = result.of_points.at("illuminance").value;
  // Means of elements are what the balance of light and the measured error go by.
  const auto means = result.of_cells.find("illuminance");
  std::map<std::pair<std::uint32_t, std::uint32_t>, Sum> sums;
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    const double area = area_of(result, i);
    if (!(area > 0)) continue;
    const auto& [a, b, c] = result.triangles[i];
    const auto [lowest, highest] = std::minmax({double{lux[a]}, double{lux[b]}, double{lux[c]}});
    Sum& sum = sums[{result.room.empty() ? 0 : result.room[i], result.surface[i]}];
    sum.lowest = sum.area > 0 ? std::min(sum.lowest, lowest) : lowest;
    sum.highest = std::max(sum.highest, highest);
    sum.area += area;
    sum.flux += area * (means != result.of_cells.end() ? double{means->second.value[i]}
                                                       : (double{lux[a]} + lux[b] + lux[c]) / 3);
  }
  std::map<std::uint32_t, RoomFigures> rooms;
  for (const auto& [key, sum] : sums) {
    const LitFigures lit{sum.area, sum.flux / sum.area, sum.lowest, sum.highest};
    RoomFigures& room = rooms[key.first];
    room.lit.add(lit);
    room.surfaces.push_back({key.second, lit});
  }
  std::vector<RoomFigures> all;
  for (auto& [id, room] : rooms) {
    room.name = result.room.empty() ? "scene" : result.rooms[id];
    std::ranges::stable_sort(room.surfaces, std::greater(), [](const SurfaceFigures& s) { return s.lit.area; });
    all.push_back(std::move(room));
  }
  return all;
}

std::vector<double> areas_of_materials(const WrittenResult& result) {
  std::vector<double> areas(result.materials.size());
  for (std::size_t i = 0; i < result.triangles.size(); ++i) areas[result.material[i]] += area_of(result, i);
  for (const PaneTriangle& pane : result.around.panes)
    areas[pane.material] += area_of(pane.corners[0], pane.corners[1], pane.corners[2]);
  return areas;
}

}  // namespace clerestory
