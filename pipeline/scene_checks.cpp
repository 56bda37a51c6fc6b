#include "pipeline/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_set>

#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "pipeline/collect_around.h"
#include "pipeline/wording.h"
#include "solver/evaluate/buried_points.h"
#include "solver/lights/beam.h"
#include "solver/lights/luminaire.h"
#include "solver/lights/near_planes.h"
#include "solver/model/box.h"
#include "solver/model/error.h"
#include "solver/model/random_stream.h"

namespace clerestory {
namespace {

/// What rays meet in some directions, spread evenly over the sphere.
struct Surroundings {
  double open = 0;  ///< share of them that meet nothing
  Box met;          ///< around all that is met
};
Surroundings look_around(const Problem& problem, const Vec3& position, int directions) {
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  Surroundings found;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions, r = std::sqrt(1 - z * z), phi = i * golden_angle;
    const Ray ray{position, {r * std::cos(phi), r * std::sin(phi), z}};
    const Hit hit = problem.rays.first_hit(problem.patches, ray);
    if (hit.escaped())
      found.open += 1.0 / directions;
    else if (!hit.reflected)
      found.met.add(hit.position(ray));
  }
  return found;
}

/// Name of the solid that all light of a luminaire ends in, or nothing: its rays meet inner sides only, of surfaces
/// that are a small part of the model; or mostly inner sides, as where a desk stands on a floor, in a space too low or
/// narrow for a room.
std::string solid_around(const Problem& problem, const PlacedLuminaire& luminaire) {
  constexpr std::uint32_t kRays = 512;
  constexpr double kSmallPart = 0.25, kHalf = 0.5;  // of all area; a room whose faces are wound outwards is more
  constexpr double kRoom = 1.5;                     // m, each way: as of sensors (buried_points.h)
  const PatchSet& patches = problem.patches;
  const Beam beam = beam_of(luminaire);
  std::vector<std::size_t> met;
  std::size_t fronts = 0;
  for (std::uint32_t k = 0; k < kRays; ++k) {
    const auto u = sobol4(k, 3);
    const Vec3 d = direction_in(beam, u[0], u[1]);
    if (intensity(luminaire, d).is_black()) continue;
    const Hit hit = problem.rays.first_hit(patches, {ray_start(luminaire, luminaire.position, d), d});
    if (hit.escaped() || hit.reflected || patches.front_material(hit.triangle).scatters_through()) return {};
    if (hit.transmittance.max() < 1) return {};  // of a glass shade
    if (hit.patch.valid() && patches.side[hit.patch] != kBack)
      ++fronts;
    else
      met.push_back(patches.side_surface[hit.triangle][kBack]);
  }
  if (met.empty() || fronts > met.size()) return {};
  std::vector<std::size_t> surfaces = met;
  std::ranges::sort(surfaces);
  surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
  double own = 0, all = 0;
  for (std::size_t t = 0; t < patches.triangle_count(); ++t) {
    const auto& c = patches.corners[t];
    const Vec3& a = patches.vertices[c[0]];
    const double area = length(cross(patches.vertices[c[1]] - a, patches.vertices[c[2]] - a)) / 2;
    all += area;
    if (std::ranges::binary_search(surfaces, std::size_t{patches.side_surface[t][kBack]})) own += area;
  }
  if (fronts == 0 && own < kSmallPart * all) return patches.surfaces[met.front()];
  constexpr int kDirections = 64;
  const Surroundings around = look_around(problem, luminaire.position, kDirections);
  const Vec3 size = around.met.upper - around.met.lower;
  const double least = std::min({size.x, size.y, size.z});
  const bool is_no_room = around.open == 0 && least >= 0 && least < kRoom && own < kHalf * all;
  return is_no_room ? patches.surfaces[met.front()] : std::string();
}

/// The first of those that stand in the open one by one, the others by their number; of very many, each is looked at in
/// few directions before it is looked at in all.
void warn_about_luminaires(const Problem& problem, Observer& observer) {
  constexpr int kDirections = 256;
  constexpr std::size_t kMostRays = 1 << 21, kShown = 20;
  constexpr double kOpen = 0.6;
  const auto& luminaires = problem.lights.luminaires;
  if (luminaires.empty()) return;
  const int first_look = static_cast<int>(std::clamp<std::size_t>(kMostRays / luminaires.size(), 8, kDirections));
  std::size_t shown = 0, more = 0;
  for (const PlacedLuminaire& luminaire : luminaires) {
    if (luminaire.is_image()) continue;
    const bool may_be_open = look_around(problem, luminaire.position, first_look).open > kOpen;
    if (may_be_open && shown == kShown) {
      ++more;
      continue;
    }
    const double open = may_be_open ? look_around(problem, luminaire.position, kDirections).open : 0;
    const bool look_inside = open <= kOpen && first_look == kDirections && shown < kShown;
    const std::string solid = look_inside ? solid_around(problem, luminaire) : std::string();
    if (open <= kOpen && solid.empty()) continue;
    ++shown;
    const Vec3 p = luminaire.position + problem.patches.origin;
    observer.warn("luminaire '" + luminaire.name + "' at (" + rounded(p.x, 4) + ", " + rounded(p.y, 4) + ", " +
                  rounded(p.z, 4) + ") stands " +
                  (open > kOpen ? "outside every room: " + percent(open) + " of the directions around it meet nothing."
                                : "inside of the solid '" + solid + "': all of its light is absorbed in there."));
  }
  if (more > 0)
    observer.warn((first_look < kDirections ? "about " : "") + grouped(more) +
                  " more luminaires stand outside every room.");
}

/// "rows 3, 7, 8 and 12 more"
std::string row_list(const std::vector<std::size_t>& rows) {
  constexpr std::size_t kShown = 10;
  std::string text = rows.size() == 1 ? "row " : "rows ";
  for (std::size_t i = 0; i < std::min(rows.size(), kShown); ++i) text += (i ? ", " : "") + std::to_string(rows[i] + 1);
  if (rows.size() > kShown) text += " and " + grouped(rows.size() - kShown) + " more";
  return text;
}

/// Tells why rules match nothing.
class UnusedRules {
 public:
  explicit UnusedRules(const Scene& scene) {
    for (const Material& material : scene.materials) names_.insert(material.name);
    constexpr std::size_t kMostPairs = 200'000;  // of names to compare, for a hint
    if (scene.materials.size() * scene.unused_materials.size() > kMostPairs) return;
    for (const Material& material : scene.materials) known_.push_back(material.name);
  }
  std::string why(const std::string& pattern) const {
    if (pattern.find_first_of("*?") != pattern.npos) return "matches no material of the model that is left to it.";
    if (names_.contains(pattern)) return "decides nothing: a rule before it matches that material first.";
    const std::string near = suggestion(pattern, known_);
    return near.starts_with("did you mean") ? "matches no material of the model; " + near
                                            : "matches no material of the model.";
  }

 private:
  std::unordered_set<std::string_view> names_;
  std::vector<std::string_view> known_;  ///< those that a pattern is compared with, in the model's order
};

/// Of very many only as many as can be looked at in a second or two, evenly spread. Returns the planes that are buried.
std::vector<std::size_t> warn_about_sensors(const Problem& problem, const std::string& file,
                                            const SensorPlanes& sensors, Observer& observer) {
  constexpr std::size_t kMostPlanes = 100'000;
  constexpr std::string_view kInside = ") inside a solid; what arrives there means little.";
  const std::size_t step = 1 + sensors.planes.size() / kMostPlanes;
  if (step == 1) {
    std::vector<std::size_t> planes = buried_points(problem, sensors.planes);
    const auto buried = sensors_of(sensors, planes);
    if (!buried.empty())
      observer.warn(text(file, ": ", counted(buried.size(), "sensor"), " (", row_list(buried), kInside));
    return planes;
  }
  std::vector<SensorPoint> some;
  for (std::size_t s = 0; s < sensors.sensor_count(); s += step) some.push_back(sensors.planes[sensors.begin[s]]);
  std::vector<std::size_t> rows = buried_points(problem, some), planes;
  for (std::size_t& row : rows) {
    row *= step;
    planes.push_back(sensors.begin[row]);
  }
  if (!rows.empty())
    observer.warn(text(file, ": of ", grouped(some.size()), " sensors looked at, one in ", grouped(step), ", ",
                       grouped(rows.size()), " (", row_list(rows), kInside));
  return planes;
}

}  // namespace

bool has_light(const Scene& scene) {
  const LightSpec& lights = scene.lights;
  const auto shines = [](const Spectrum& s) { return s.max() > 0; };
  if (std::ranges::any_of(lights.luminaires, [&](const Luminaire& l) { return shines(power(l)); }) ||
      std::ranges::any_of(lights.suns, [&](const Sun& sun) { return shines(sun.normal_irradiance); }) ||
      (lights.sky && shines(lights.sky->horizontal_irradiance)))
    return true;
  const auto& used = scene.polygons.material;
  return std::any_of(used.begin(), used.end(), [&](MaterialId m) { return scene.materials[m].emits(); });
}

void require_light(const Scene& scene) {
  if (has_light(scene)) return;
  throw InputError(
      scene.file +
      ": there is no light at all: no material that emits, no luminaire that gives any, no sky, no sun. Add a sky with "
      "--sky cie-overcast:10000, or in a scene file give a material \"luminous_exitance\", or add "
      "\"luminaires\", \"sky\" or \"sun\".");
}

void warn_about_scene(const Scene& scene, Observer& observer) {
  constexpr std::size_t kShown = 500;
  for (std::size_t i = 0; i < std::min(scene.warnings.size(), kShown); ++i) observer.warn(scene.warnings[i]);
  if (scene.warnings.size() > kShown)
    observer.warn(scene.file + ": " + grouped(scene.warnings.size() - kShown) + " more warnings are left out.");
  const UnusedRules unused(scene);
  for (const std::string& name : scene.unused_materials)
    observer.warn(scene.file + ": materials '" + quotable(name) + "' " + unused.why(name));
  const auto emits = [&](MaterialId m) { return scene.materials[m].emits(); };
  if (daylight_reference(scene.lights) &&
      (!scene.lights.luminaires.empty() || std::ranges::any_of(scene.polygons.material, emits)))
    observer.warn(scene.file +
                  ": daylight factors hold the light of the lamps, too; those of daylight alone are left where solve "
                  "--layers and mix --set put the lamps at 0");
}

std::vector<std::size_t> warn_about_places(const Problem& problem, const Scene& scene, const SensorPlanes& sensors,
                                           Method method, Observer& observer) {
  warn_about_luminaires(problem, observer);
  constexpr double kMuch = 0.01;
  if (const double lost = problem.lights.lost_in_mirrors; lost > kMuch)
    observer.warn(
        text(scene.file, ": mirrors and glass turn ", percent(lost),
             " of the light of lamps and sun on ways that are not followed (more than 64 planes, more than 15 "
             "one after another, or each with very little); ",
             method == Method::particles ? "at sensors and in the measured error it is missing."
                                         : "it is missing where it arrives. --method particles has it on surfaces."));
  return warn_about_sensors(problem, scene.file, sensors, observer);
}

}  // namespace clerestory
