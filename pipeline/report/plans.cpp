#include "pipeline/report/plans.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "io/text.h"
#include "pipeline/report/section_lines.h"
#include "pipeline/wording.h"
#include "solver/model/inner_rooms.h"

namespace clerestory {
namespace {

constexpr double kReach = 6;    ///< [m] luminaires farther off are of another storey
constexpr double kSmooth = 10;  ///< above this ratio of largest to least illuminance colours go by its logarithm

/// How a plane is looked at.
struct PlanView {
  Vec3 origin, right, up, normal;

  PlanPoint operator()(const Vec3& p) const { return {dot(p - origin, right), dot(p - origin, up)}; }
};

PlanView view_of(const Vec3& origin, const Vec3& normal) {
  if (std::abs(normal.z) > 0.7) return {origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Vec3 up = normalized(Vec3{0, 0, 1} - normal.z * normal);
  return {origin, cross(up, normal), up, normal};
}

struct PlanBox {
  PlanPoint low{1e300, 1e300}, high{-1e300, -1e300};

  void add(const PlanPoint& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// Room for what stands around.
  void widen() {
    const double size = std::max(high.x - low.x, high.y - low.y);
    const double by = std::clamp(0.12 * size, 0.05, 2.0);
    low = {low.x - by, low.y - by}, high = {high.x + by, high.y + by};
  }
  bool meets(const PlanLine& line) const {
    PlanBox box;
    for (const PlanPoint& p : line) box.add(p);
    return box.low.x <= high.x && box.high.x >= low.x && box.low.y <= high.y && box.high.y >= low.y;
  }
};

void set_colours(Plan& plan, const std::vector<double>& lux) {
  const auto [low, high] = std::ranges::minmax(lux);
  double dimmest = high;  // of what is not dark
  for (const double x : lux)
    if (x > 0) dimmest = std::min(dimmest, x);
  plan.by_logarithm = high > kSmooth * dimmest;
  const bool from_dark = high > 2 * low || !plan.layers.empty();  // layers can be dimmed
  plan.lowest = plan.by_logarithm ? std::max(dimmest, high / 1000) : from_dark ? 0 : low;
  plan.highest = high > plan.lowest ? high : plan.lowest + 1;
}

void add_isolux(Plan& plan, const std::vector<double>& lux) {
  const auto [low, high] = std::ranges::minmax(lux);
  std::vector<double> levels = isolux_levels(low, high);
  if (plan.target && *plan.target > low && *plan.target < high) {
    std::erase_if(levels, [&](double level) { return std::abs(level / *plan.target - 1) < 1e-6; });
    levels.push_back(*plan.target);
  }
  if (plan.lattice) plan.isolux = isolux_lines(*plan.lattice, levels);
}

void add_layer(Plan& plan, const std::vector<double>& lux) {
  for (const double x : lux) plan.layers.push_back(static_cast<float>(x));
}

/// Walls, panes and luminaires as they are seen.
/// reach  how far before the plane luminaires belong to it [m]
void add_surroundings(Plan& plan, const WrittenResult& result, const PlanView& view, const Vec3& cut_at, double reach) {
  const PlanBox frame{plan.low, plan.high};
  const auto add = [&](std::vector<PlanLine>& to, const std::vector<std::vector<Vec3>>& lines) {
    for (const auto& line : lines) {
      PlanLine flat;
      for (const Vec3& p : line) flat.push_back(view(p));
      if (frame.meets(flat)) to.push_back(std::move(flat));
    }
  };
  add(plan.walls, section_lines(result.points, result.triangles, cut_at, view.normal));
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> panes;
  for (const PaneTriangle& pane : result.around.panes) {
    if (!result.materials[pane.material].lets_rays_pass()) continue;
    const auto first = static_cast<std::uint32_t>(corners.size());
    corners.insert(corners.end(), pane.corners.begin(), pane.corners.end());
    panes.push_back({first, first + 1, first + 2});
  }
  add(plan.panes, section_lines(corners, panes, cut_at, view.normal));
  for (const ShownLuminaire& luminaire : result.around.luminaires) {
    const double above = dot(luminaire.position - view.origin, view.normal);
    const PlanPoint at = view(luminaire.position);
    if (above > -0.1 && above < reach && frame.meets({at})) plan.luminaires.push_back({at, luminaire.name});
  }
}

Vec3 mean_of(const std::vector<SensorPoint>& points, Vec3 SensorPoint::*what) {
  Vec3 sum;
  for (const SensorPoint& p : points) sum += p.*what - points.front().*what;
  return points.front().*what + sum / static_cast<double>(points.size());
}

bool is_flat(const std::vector<SensorPoint>& points, const PlanView& view) {
  double size = 0, off = 0;
  for (const SensorPoint& p : points) {
    const Vec3 d = p.position - view.origin;
    size = std::max(size, length(d)), off = std::max(off, std::abs(dot(d, view.normal)));
  }
  return off <= 0.02 * size;
}

// ---- floors

struct LevelFloor {
  double height = 0, area = 0;
  std::vector<std::size_t> triangles;
};

std::vector<LevelFloor> floors_of(const WrittenResult& r, std::size_t most, bool outdoors) {
  constexpr double kUp = 0.95, kThick = 0.15, kLeastShare = 0.1;
  const std::vector<bool> inner = inner_rooms(r);
  std::map<long, LevelFloor> levels;  // by centimetre
  for (std::size_t i = 0; i < r.triangles.size(); ++i) {
    if (!outdoors && !inner[r.room[i]]) continue;
    const auto& [a, b, c] = r.triangles[i];
    const Vec3 n = cross(r.points[b] - r.points[a], r.points[c] - r.points[a]);
    const double area = length(n) / 2;
    if (!(n.z > kUp * length(n)) || !(area > 0)) continue;
    const double z = (r.points[a].z + r.points[b].z + r.points[c].z) / 3;
    LevelFloor& level = levels[std::lround(100 * z)];
    level.height = z;
    level.area += area;
    level.triangles.push_back(i);
  }
  std::vector<LevelFloor> floors;
  while (!levels.empty() && floors.size() < most) {
    const auto best = std::ranges::max_element(levels, {}, [](const auto& l) { return l.second.area; });
    if (!floors.empty() && best->second.area < kLeastShare * floors.front().area) break;
    LevelFloor floor = best->second;
    const double z = floor.height;
    levels.erase(best);
    std::erase_if(levels, [&](auto& level) {  // steps, carpets, thresholds
      if (std::abs(level.second.height - z) > kThick) return false;
      floor.area += level.second.area;
      floor.triangles.insert(floor.triangles.end(), level.second.triangles.begin(), level.second.triangles.end());
      return true;
    });
    floors.push_back(std::move(floor));
  }
  std::ranges::sort(floors, {}, &LevelFloor::height);
  return floors;
}

/// Light on them, at the middle of cells.
///
/// lux  at the points of the result
Lattice raster_of(const WrittenResult& r, const std::vector<float>& lux, const LevelFloor& floor, const PlanView& view,
                  const PlanBox& box) {
  constexpr double kCells = 140;  // along the longer side
  Lattice raster;
  const double width = box.high.x - box.low.x, depth = box.high.y - box.low.y;
  const double cell = std::max(std::max(width, depth) / kCells, 1e-9);
  raster.columns = static_cast<std::size_t>(std::ceil(width / cell - 1e-9)) + 1;
  raster.rows = static_cast<std::size_t>(std::ceil(depth / cell - 1e-9)) + 1;
  raster.origin = box.low, raster.u = {cell, 0}, raster.v = {0, cell};
  raster.value.assign(raster.columns * raster.rows, std::numeric_limits<double>::quiet_NaN());
  for (const std::size_t i : floor.triangles) {
    const auto& t = r.triangles[i];
    const PlanPoint a = view(r.points[t[0]]), b = view(r.points[t[1]]), c = view(r.points[t[2]]);
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(std::abs(area) > 0)) continue;
    const auto first = [&](double least, double low) { return std::max(0.0, std::ceil((least - low) / cell - 1e-6)); };
    const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
    const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
    for (double row = first(low_y, box.low.y); box.low.y + row * cell <= high_y + 1e-6 * cell; ++row)
      for (double column = first(low_x, box.low.x); box.low.x + column * cell <= high_x + 1e-6 * cell; ++column) {
        const PlanPoint p = raster.place(column, row);
        const double s = ((p.x - a.x) * (c.y - a.y) - (p.y - a.y) * (c.x - a.x)) / area;
        const double q = ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) / area;
        if (s < -1e-6 || q < -1e-6 || s + q > 1 + 1e-6) continue;
        const auto at = static_cast<std::size_t>(row) * raster.columns + static_cast<std::size_t>(column);
        if (at < raster.value.size()) raster.value[at] = (1 - s - q) * lux[t[0]] + s * lux[t[1]] + q * lux[t[2]];
      }
  }
  return raster;
}

/// Within 0.03 %: with fewer digits they deflate to half, and a floor has 20,000 places for each layer.
std::vector<double> shortened(std::vector<double> lux) {
  for (double& x : lux) x = std::bit_cast<float>(std::bit_cast<std::uint32_t>(static_cast<float>(x)) & 0xffff'f800u);
  return lux;
}

std::vector<double> numbers_of(const Lattice& lattice) {
  std::vector<double> lux;
  std::ranges::copy_if(lattice.value, std::back_inserter(lux), [](double x) { return !std::isnan(x); });
  return lux;
}

}  // namespace

Plan plan_of(const WrittenResult& result, const MeasuredSensors& sensors, std::optional<double> target) {
  const std::vector<SensorPoint>& points = sensors.set.points;
  const Vec3 origin = mean_of(points, &SensorPoint::position);
  // The normals of a set that looks to many sides say nothing of how it lies.
  Vec3 normal = mean_of(points, &SensorPoint::normal);
  const bool leans = sensors.set.kind == SensorKind::planar && length(normal) > 0.99;
  PlanView view = view_of(origin, leans ? normalized(normal) : Vec3{0, 0, 1});
  if (!is_flat(points, view)) view = view_of(origin, {0, 0, 1});

  Plan plan;
  plan.title = text("Plan of ", sensors.set.name, ", illuminance from ", rounded(std::ranges::min(sensors.illuminance)),
                    " to ", rounded(std::ranges::max(sensors.illuminance)), " lx");
  plan.target = target;
  std::vector<PlanPoint> flat;
  PlanBox box;
  for (const SensorPoint& p : points) flat.push_back(view(p.position)), box.add(flat.back());
  plan.lattice = lattice_of(flat, sensors.illuminance);
  if (plan.lattice) {
    const Lattice& l = *plan.lattice;
    const double columns = static_cast<double>(l.columns), rows = static_cast<double>(l.rows);
    for (const double column : {-0.5, columns - 0.5})
      for (const double row : {-0.5, rows - 0.5}) box.add(l.place(column, row));
  } else {
    for (std::size_t i = 0; i < flat.size(); ++i) plan.dots.push_back({flat[i], sensors.illuminance[i]});
  }
  for (std::size_t k = 0; k < result.around.layers.size() && !sensors.layers.value.empty(); ++k) {
    const std::vector<double> lux = illuminance_of_layer(result.around, sensors, k);
    add_layer(plan, plan.lattice ? lattice_of(flat, lux)->value : lux);
  }
  box.widen();
  plan.low = box.low, plan.high = box.high;
  set_colours(plan, sensors.illuminance);
  add_isolux(plan, sensors.illuminance);
  add_surroundings(plan, result, view, origin, kReach);
  return plan;
}

std::vector<FloorPlan> floor_plans(const WrittenResult& result, std::size_t most) {
  constexpr double kCutAbove = 1.2;  // [m] through doors and windows
  std::vector<LevelFloor> floors = floors_of(result, most, result.room.empty());
  if (floors.empty()) floors = floors_of(result, most, true);
  std::vector<FloorPlan> plans;
  for (std::size_t level = 0; level < floors.size(); ++level) {
    const LevelFloor& floor = floors[level];
    const auto& first = result.triangles[floor.triangles.front()];
    const PlanView view = view_of(result.points[first[0]], {0, 0, 1});
    PlanBox box;
    for (const std::size_t i : floor.triangles)
      for (const std::uint32_t p : result.triangles[i]) box.add(view(result.points[p]));
    FloorPlan& out = plans.emplace_back(FloorPlan{floor.height, floor.area, {}});
    out.plan.lattice = raster_of(result, result.of_points.at("illuminance").value, floor, view, box);
    for (const ShownLayer& layer : result.around.layers) {
      const WrittenArray& lux_of_layer = result.of_points.at(of_layer("illuminance", layer.name));
      add_layer(out.plan, shortened(raster_of(result, lux_of_layer.value, floor, view, box).value));
    }
    const std::vector<double> lux = numbers_of(*out.plan.lattice);
    if (lux.empty()) {
      plans.pop_back();
      continue;
    }
    out.plan.title = text("Floor at ", std::round(100 * floor.height) / 100 + 0.0, " m, illuminance from ",
                          rounded(std::ranges::min(lux)), " to ", rounded(std::ranges::max(lux)), " lx");
    box.widen();
    out.plan.low = box.low, out.plan.high = box.high;
    set_colours(out.plan, lux);
    add_isolux(out.plan, lux);
    const Vec3 floor_place{view.origin.x, view.origin.y, floor.height};
    add_surroundings(out.plan, result, view, floor_place + Vec3{0, 0, kCutAbove},
                     level + 1 < floors.size() ? std::min(kReach, floors[level + 1].height - floor.height) : kReach);
  }
  return plans;
}

}  // namespace clerestory
