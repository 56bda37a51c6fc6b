#include "pipeline/scene_checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/scene_file/nearest_name.h"
#include "pipeline/wording.h"
#include "solver/evaluate/buried_points.h"
#include "solver/lights/luminaire.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

/// Share of 256 directions, spread evenly over the sphere, in which nothing is met.
double open_share(const Problem& problem, const Vec3& position) {
  constexpr int kDirections = 256;
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  int escaped = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z), phi = i * golden_angle;
    if (problem.rays.first_hit(problem.patches, {position, {r * std::cos(phi), r * std::sin(phi), z}}).escaped())
      ++escaped;
  }
  return double(escaped) / kDirections;
}

void warn_about_luminaire(const Problem& problem, const std::string& name, const Vec3& position, Observer& observer) {
  const double open = open_share(problem, position);
  if (open <= 0.6) return;
  const Vec3 p = position + problem.patches.origin;
  observer.warn("luminaire '" + name + "' at (" + rounded(p.x, 4) + ", " + rounded(p.y, 4) + ", " + rounded(p.z, 4) +
                ") stands outside every room: " + percent(open) + " of the directions around it meet nothing.");
}

/// "rows 3, 7, 8 and 12 more"
std::string row_list(const std::vector<std::size_t>& rows) {
  constexpr std::size_t kShown = 10;
  std::string text = rows.size() == 1 ? "row " : "rows ";
  for (std::size_t i = 0; i < std::min(rows.size(), kShown); ++i) text += (i ? ", " : "") + std::to_string(rows[i] + 1);
  if (rows.size() > kShown) text += " and " + grouped(rows.size() - kShown) + " more";
  return text;
}

std::string why_unused(const std::string& pattern, const Scene& scene) {
  if (pattern.find_first_of("*?") != pattern.npos) return "matches no material of the model that is left to it.";
  std::vector<std::string_view> names;
  for (const Material& material : scene.materials) {
    if (material.name == pattern) return "decides nothing: a rule before it matches that material first.";
    names.push_back(material.name);
  }
  const std::string near = suggestion(pattern, names);
  return near.starts_with("did you mean") ? "matches no material of the model; " + near
                                          : "matches no material of the model.";
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
  throw InputError(scene.file +
                   ": there is no light at all: no material that emits, no luminaire, no sky, no sun. Add a sky with "
                   "--sky cie-overcast:10000, or in a scene file give a material \"luminous_exitance\", or add "
                   "\"luminaires\", \"sky\" or \"sun\".");
}

void warn_about_scene(const Scene& scene, Observer& observer) {
  for (const std::string& warning : scene.warnings) observer.warn(warning);
  for (const std::string& name : scene.unused_materials)
    observer.warn(scene.file + ": materials '" + name + "' " + why_unused(name, scene));
}

std::vector<std::size_t> warn_about_places(const Problem& problem, const Scene& scene, const SensorPlanes& sensors,
                                           Observer& observer) {
  for (const PlacedLuminaire& luminaire : problem.lights.luminaires)
    if (luminaire.mirror == kNoMirror) warn_about_luminaire(problem, luminaire.name, luminaire.position, observer);
  std::vector<std::size_t> planes = buried_points(problem, sensors.planes);
  const auto buried = sensors_of(sensors, planes);
  if (!buried.empty())
    observer.warn(scene.file + ": " + counted(buried.size(), "sensor") + " (" + row_list(buried) +
                  ") inside a solid; what arrives there means little.");
  return planes;
}

}  // namespace clerestory
