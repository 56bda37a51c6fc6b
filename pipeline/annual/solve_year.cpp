#include "pipeline/annual/solve_year.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/annual/mean_sky.h"
#include "pipeline/annual/window_state.h"
#include "pipeline/annual/year_areas.h"
#include "pipeline/annual/year_error.h"
#include "pipeline/annual/year_report.h"
#include "pipeline/collect_around.h"
#include "pipeline/prepare.h"
#include "pipeline/require_valid.h"
#include "pipeline/result_checks.h"
#include "pipeline/scene_checks.h"
#include "pipeline/wording.h"
#include "solver/annual/year_at_points.h"
#include "solver/evaluate/sensor_planes.h"
#include "solver/gather/gather.h"
#include "solver/model/error.h"
#include "solver/model/parallel.h"
#include "solver/model/units.h"
#include "solver/run/accuracy.h"

namespace clerestory {
namespace {

constexpr std::size_t kBlock = 32;         ///< points of one task: their shadow rays make packets
constexpr std::size_t kBlocksAtOnce = 32;  ///< whose series are there together
constexpr std::size_t kCoarseParts = 145;  ///< of light that surfaces send on

/// More planes of them than show images of the sun.
bool has_curved_mirrors(const Prepared& scene) {
  for (std::size_t t = 0; t < scene.patches.triangle_count(); ++t)
    if (scene.patches.front_material(TriangleId{t}).turns_rays() && scene.rays.plane_of(TriangleId{t}) == kNoPlane)
      return true;
  return false;
}

Monitor monitor_of(Observer& observer) {
  return {[&observer](std::string_view stage, double done) { observer.progress(stage, done); }, {}};
}

YearRules rules_of(std::span<const DaylightHour> hours, const YearSettings& settings) {
  std::vector<int> number;
  std::vector<double> diffuse;
  for (const DaylightHour& h : hours) number.push_back(h.hour), diffuse.push_back(h.diffuse_horizontal_lux);
  return year_rules(number, diffuse, settings.is_occupied, settings.threshold, settings.more_thresholds);
}

/// Hours that any figure counts, or all.
std::vector<DaylightHour> hours_that_count(const DaylightYear& year, const YearSettings& settings) {
  const YearRules all = rules_of(year.hours, settings);
  std::vector<DaylightHour> counting;
  for (std::size_t h = 0; h < year.hours.size(); ++h)
    if (settings.keeps_all_hours || all.occupied[h] > 0 || all.daylight[h] > 0) counting.push_back(year.hours[h]);
  return counting;
}

/// Of all hours of the year, whatever counts, so that what is asked for beside the figures does not change them; then
/// of_sun is by the hours that count.
SunNodes nodes_of(const DaylightYear& year, std::span<const DaylightHour> hours, double step_deg) {
  std::vector<Vec3> suns;
  std::vector<int> hour_of_sun;
  for (const DaylightHour& h : year.hours)
    if (h.sun_up) suns.push_back(h.sun), hour_of_sun.push_back(h.hour);
  SunNodes nodes = place_sun_nodes(suns, year.place.latitude_deg, year.north_deg, step_deg);
  std::vector<AmongNodes> of_hour(hours.size());
  for (std::size_t h = 0; h < hours.size(); ++h)
    if (hours[h].sun_up)
      of_hour[h] = nodes.of_sun[static_cast<std::size_t>(std::ranges::lower_bound(hour_of_sun, hours[h].hour) -
                                                         hour_of_sun.begin())];
  nodes.of_sun = std::move(of_hour);
  return nodes;
}

/// Places of the points that light is shown on, and of sensors.
std::vector<PlacesOfPoint> places_of(const VertexLightmap& map, const RayScene& rays) {
  const PointOf place = sample_points(map, rays);
  std::vector<PlacesOfPoint> points(map.position.size());
  for (std::size_t p = 0; p < points.size(); ++p)
    for (std::uint32_t s = map.sample_begin[p]; s < map.sample_begin[p + 1]; ++s) {
      points[p].at.push_back(place(s));
      points[p].weight.push_back(map.sample_weight[s]);
    }
  return points;
}
std::vector<PlacesOfPoint> places_of(const SensorPlanes& sensors, const Vec3& origin, const RayScene& rays) {
  const PointOf place = sensor_points(sensors.planes, origin, rays);
  std::vector<PlacesOfPoint> points(sensors.sensor_count());
  for (std::size_t s = 0; s < points.size(); ++s) {
    const std::uint32_t begin = sensors.begin[s], end = sensors.begin[s + 1];
    for (std::uint32_t i = begin; i < end; ++i) {
      points[s].at.push_back(place(i));
      points[s].weight.push_back(1.0 / (end - begin));
    }
  }
  return points;
}

/// Part `part` of n points in `parts`: whole blocks, whose points share what they look at.
YearSolved::Range range_of_part(std::size_t n, std::size_t part, std::size_t parts) {
  const std::size_t blocks = (n + kBlock - 1) / kBlock;
  return {std::min(n, blocks * (part - 1) / parts * kBlock), std::min(n, blocks * part / parts * kBlock)};
}

/// Light of the points with blinds as the rooms have them, from that of each state of the windows.
struct BlockSeries {
  std::vector<float> total, direct;  ///< points x H, blinds open
  std::vector<float> shaded;         ///< the same of all light, blinds operated; empty where none is closed
};

class PointYears {
 public:
  PointYears(const std::vector<std::unique_ptr<WindowState>>& states, const YearRules& rules, const YearError& error,
             std::string_view stage, const Monitor& monitor)
      : states_(states), rules_(rules), error_(error), stage_(stage), monitor_(monitor) {}

  /// room_of  whose blinds are a point's; null: it has none.
  void run(std::span<const PlacesOfPoint> points, YearSolved::Range range, const GatherPattern& pattern,
           const std::vector<const YearArea*>& room_of, const TakeSeries& take, std::vector<PointYear>& out) {
    const auto [begin, end] = range;
    const std::size_t H = states_.front()->year().hours;
    for (std::size_t first = begin; first < end; first += kBlock * kBlocksAtOnce) {
      const std::size_t last = std::min(end, first + kBlock * kBlocksAtOnce),
                        blocks = (last - first + kBlock - 1) / kBlock;
      monitor_.report(stage_, static_cast<double>(first - begin) / static_cast<double>(end - begin));
      std::vector<BlockSeries> series(blocks);
      parallel_for(blocks, 1, [&](std::size_t from, std::size_t to) {
        for (std::size_t b = from; b < to; ++b) {
          const std::size_t at = first + b * kBlock, count = std::min(kBlock, last - at);
          series[b] = series_of_block(points.subspan(at, count), pattern, std::span(room_of).subspan(at, count));
          for (std::size_t p = 0; p < count; ++p) out[at + p] = figures(series[b], p, H);
          if (!take) series[b] = {};
        }
      });
      for (std::size_t b = 0; b < blocks && take; ++b) {
        const std::size_t at = first + b * kBlock;
        take({at, std::min(at + kBlock, last), series[b].shaded.empty() ? series[b].total : series[b].shaded,
              series[b].direct});
      }
    }
  }

 private:
  BlockSeries series_of_block(std::span<const PlacesOfPoint> points, const GatherPattern& pattern,
                              std::span<const YearArea* const> rooms) const {
    const std::size_t H = states_.front()->year().hours, n = points.size() * H;
    BlockSeries s{std::vector<float>(n), std::vector<float>(n), {}};
    states_.front()->year_at(points, pattern, s.total, s.direct);
    if (states_.size() == 1) return s;
    s.shaded = s.total;
    std::vector<float> total(n), direct(n);
    for (std::size_t g = 1; g < states_.size(); ++g) {
      states_[g]->year_at(points, pattern, total, direct);
      for (std::size_t p = 0; p < points.size(); ++p)
        for (std::size_t h = 0; h < H && rooms[p]; ++h)
          if (rooms[p]->blinds[h].closed >> (g - 1) & 1) s.shaded[p * H + h] += total[p * H + h] - s.total[p * H + h];
    }
    for (float& E : s.shaded) E = std::max(0.0f, E);
    return s;
  }

  PointYear figures(const BlockSeries& s, std::size_t p, std::size_t H) const {
    const std::span<const float> total = std::span(s.total).subspan(p * H, H),
                                 direct = std::span(s.direct).subspan(p * H, H);
    if (s.shaded.empty()) return figures_of(total, direct, rules_, error_);
    PointYear with_blinds = figures_of(std::span(s.shaded).subspan(p * H, H), direct, rules_, error_);
    with_blinds.EN17037 = figures_of(total, direct, rules_, error_).EN17037;  // it asks for daylight without shading
    return with_blinds;
  }

  const std::vector<std::unique_ptr<WindowState>>& states_;
  const YearRules& rules_;
  const YearError& error_;
  std::string_view stage_;
  const Monitor& monitor_;
};

/// What light of elements, hours and figures of points take, beside the solve [bytes].
std::size_t memory_of_year(const PatchSet& elements, std::size_t states, const SunNodes& nodes, const YearLight& year,
                           std::size_t points) {
  const std::size_t lanes = year.coarse.parts() + nodes.direction.size();
  const std::size_t of_state =
      elements.patch_count() * static_cast<std::size_t>(elements.channels) * lanes * sizeof(float);
  const std::size_t of_hours = (year.fine.parts() + year.coarse.parts()) * year.hours * sizeof(float);
  constexpr std::size_t kPlace = 2 * sizeof(ReceivingPoint);
  return states * of_state + of_hours + points * (sizeof(PointYear) + sizeof(PlacesOfPoint) + kPlace);
}

/// Which room decides on the blinds, by point.
std::vector<const YearArea*> rooms_of_points(std::size_t points, const std::vector<YearArea>& areas,
                                             const std::vector<std::uint32_t>& area_of_point) {
  std::vector<const YearArea*> of(points, nullptr);
  for (std::size_t p = 0; p < points && !area_of_point.empty(); ++p)
    if (area_of_point[p] < areas.size()) of[p] = &areas[area_of_point[p]];
  return of;
}

}  // namespace

YearSolved solve_year(const Scene& scene, const DaylightYear& year, const YearSettings& settings, Observer& observer,
                      const TakeSeries& take) {
  const Monitor monitor = monitor_of(observer);
  const Effort effort_here = effort(settings.solve.solve.accuracy);
  const std::vector<DaylightHour> hours = hours_that_count(year, settings);
  if (hours.empty()) throw InputError(year.file + ": no hour has any light; take another weather file.");
  YearSolved out;
  out.rules = rules_of(hours, settings);
  for (const DaylightHour& h : hours) out.hours.push_back(h.hour);
  out.sky_parts = settings.sky_parts.value_or(effort_here.year.sky_parts);

  // Hours -> light of sky parts and sun by the hour, and the one sky that elements are fitted to.
  const SkyParts fine(out.sky_parts), coarse(kCoarseParts);
  const SunNodes nodes = nodes_of(year, hours, effort_here.year.node_step_deg);
  out.sun_nodes = nodes.direction.size();
  const YearLight light = light_of_year(hours, fine, coarse, nodes);
  const std::vector<float>& counts = out.rules.occupied;
  const bool any_occupied = std::any_of(counts.begin(), counts.end(), [](float x) { return x > 0; });
  const Scene shown =
      under_sky(scene, mean_sky(hours, any_occupied ? counts : std::vector<float>(hours.size(), 1.0f), light, coarse));

  // Scene -> elements, their transport, points to show figures on.
  Settings solving = settings.solve;
  solving.solve.method = Method::hierarchical;
  require_valid(shown, solving);
  warn_about_scene(shown, observer);
  const SensorPlanes sensors = planes_of(scene.sensors);
  StageSeconds seconds;
  std::optional<PreparedToSolve> prepared = prepare_to_solve(shown, solving, observer, monitor, seconds);
  warn_about_places(prepared->scene.problem(), shown, sensors, solving.solve.method, observer);
  if (has_curved_mirrors(prepared->scene))
    observer.warn(shown.file +
                  ": mirrors lie in more than 64 planes, as curved ones do: what those that have less than a 64th of "
                  "their area send on of the sun itself is left out of a year.");
  if (prepared->scene.rays.has_gloss())
    observer.warn(shown.file +
                  ": what glossy surfaces send on of the sun itself is left out of a year where it falls "
                  "straight on sensors and vertices; their light of the sky and of other surfaces is in it.");
  KeptTransport kept;
  // Light at vertices is gathered again below.
  const AroundSolve around{.vertices = effort(Accuracy::draft).vertices, .keep = &kept};
  SolvedPatches solved = solve(prepared->scene.problem(), std::move(prepared->lightmap),
                               prepared->scene.repairs.max_element, solving.solve, monitor, around);
  out.solved.panes = panes_of(prepared->scene.patches);
  out.solved.settings = solving;
  out.solved.repairs = prepared->scene.repairs;
  out.solved.openings = prepared->scene.lights.sky_openings().size();
  out.solved.lightmap = std::move(solved.lightmap);
  out.solved.solution = std::move(solved.solution);

  const std::size_t shown_points = out.solved.lightmap.position.size() + sensors.sensor_count();
  observer.step(
      "a year at " + counted(shown_points, "point") + " from " + counted(kept.elements.patch_count(), "element") +
      ": about " +
      bytes(memory_of_year(kept.elements, blind_groups(shown.materials).size() + 1, nodes, light, shown_points)) +
      " more memory");

  // Windows open, and closed one group after the other.
  const StateOptions how{
      fine,          coarse, nodes, light, hours, prepared->scene.repairs.max_element, effort_here.year.sun_rays,
      solving.solve, around};
  std::vector<std::unique_ptr<WindowState>> states;
  states.push_back(std::make_unique<WindowState>(prepared->scene, std::move(kept), how, monitor));
  add_closed_states(shown, *prepared, how, monitor, states);
  out.solved.patches = solved.elements.patch_count() > 0 ? std::move(solved.elements) : prepared->scene.patches;

  const std::vector<PlacesOfPoint> points = places_of(out.solved.lightmap, prepared->scene.rays);
  const std::vector<PlacesOfPoint> at_sensors =
      places_of(sensors, prepared->scene.patches.origin, prepared->scene.rays);
  const GatherPattern of_points(effort_here.vertices, solving.solve.seed),
      of_sensors(effort_here.sensors, solving.solve.seed);

  out.rooms = rooms_facing_up(out.solved.patches, out.solved.lightmap);
  out.grids = grids_of(scene.sensors);
  out.has_blinds = states.size() > 1;
  if (out.has_blinds) {
    operate_blinds(states, points, out.rules, monitor, out.rooms);
    operate_blinds(states, at_sensors, out.rules, monitor, out.grids);
  }
  measure_year_error(*states.front(), prepared->scene, points, of_points, at_sensors, of_sensors, hours, solving.solve,
                     monitor, out);

  out.of_points.resize(points.size());
  out.of_sensors.resize(at_sensors.size());
  out.part_of_sensors = range_of_part(at_sensors.size(), settings.part, settings.parts);
  out.part_of_points = range_of_part(points.size(), settings.part, settings.parts);
  PointYears(states, out.rules, out.error_of_sensors, "sensors", monitor)
      .run(at_sensors, out.part_of_sensors, of_sensors,
           rooms_of_points(at_sensors.size(), out.grids, set_of_sensors(scene.sensors)), take, out.of_sensors);
  PointYears(states, out.rules, out.error_of_points, "points", monitor)
      .run(
          points, out.part_of_points, of_points,
          rooms_of_points(points.size(), out.rooms, room_of_points(out.solved.patches, out.solved.lightmap, out.rooms)),
          {}, out.of_points);
  warn_about_result(out.solved, observer);
  show_mean(out.rules, out.of_points, out.solved);
  if (settings.parts == 1) add_up(out);
  return out;
}

}  // namespace clerestory
