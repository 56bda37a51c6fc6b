#include "pipeline/require_valid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "io/text.h"
#include "pipeline/wording.h"
#include "solver/lights/layers.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

[[noreturn]] void refuse(const Scene& scene, const std::string& what) { throw InputError(scene.file + ": " + what); }

std::string value(const Spectrum& s) {
  if (s.is_grey()) return rounded(s[0]);
  return "(" + rounded(s[0]) + ", " + rounded(s[1]) + ", " + rounded(s[2]) + ")";
}

bool is_light(const Spectrum& s) { return all_finite(s) && s.min() >= 0; }
bool is_unit(const Vec3& d) { return std::abs(length(d) - 1) < 1e-6; }

void check_material(const Scene& scene, const Material& m) {
  const std::string name = "material '" + m.name + "': ";
  const auto check = [&](const Spectrum& s, const char* what, bool one_is_possible) {
    if (all_finite(s) && s.min() >= 0 && (s.max() < 1 || (one_is_possible && s.max() == 1))) return;
    refuse(scene, name + what + " = " + value(s) + " is outside [0, 1" + (one_is_possible ? "]" : ")") +
                      "; a surface cannot give back or pass more than it receives.");
  };
  check(m.reflectance, "reflectance", false);
  check(m.transmittance, "transmittance", true);
  if (m.scatters_through()) check(m.reflectance + m.transmittance, "reflectance + transmittance", false);
  if (m.gloss && !m.is_glossy()) refuse(scene, name + "has a lobe, which glossy materials alone have.");
  if (m.is_glossy() && !m.gloss) refuse(scene, name + "is glossy and has no lobe.");
  if (m.gloss) {
    check(m.gloss->specular, "specular", false);
    check(m.reflectance + m.gloss->specular, "reflectance + specular", false);
    if (m.gloss->exponent && !(*m.gloss->exponent >= 0 && *m.gloss->exponent <= kMostExponent))
      refuse(scene, name + "exponent = " + rounded(*m.gloss->exponent) + " is outside [0, 1000000].");
    if (!m.gloss->exponent && !(m.gloss->roughness >= kLeastRoughness && m.gloss->roughness <= 1))
      refuse(scene, name + "roughness = " + rounded(m.gloss->roughness) + " is outside [0.01, 1].");
    if (m.sides != 2) refuse(scene, name + "sides = 1; a glossy surface reflects on both of its sides.");
  }
  if (!is_light(m.exitance))
    refuse(scene, name + "exitance = " + value(m.exitance) + " W/m2 is negative or no number.");
  if (m.total_power && !is_light(*m.total_power))
    refuse(scene, name + "power = " + value(*m.total_power) + " W is negative or no number.");
  if (m.sides != 1 && m.sides != 2)
    refuse(scene, name + "sides = " + std::to_string(m.sides) + "; 1 or 2 are possible.");
}

void check_faces(const Scene& scene) {
  const PolygonSoup& soup = scene.polygons;
  const std::size_t faces = soup.face_count();
  if (soup.face_begin.size() != faces + 1 || soup.surface.size() != faces ||
      soup.face_begin.back() != soup.corner.size())
    refuse(scene, "the arrays of the faces do not fit together; add corners, then end each face.");
  for (std::size_t f = 0; f < faces; ++f) {
    if (soup.material[f] >= scene.materials.size())
      refuse(scene, "face " + std::to_string(f) + " has a material that is not there; there are " +
                        std::to_string(scene.materials.size()) + ".");
    if (soup.surface[f] >= scene.surfaces.size())
      refuse(scene, "face " + std::to_string(f) + " belongs to a surface that is not there; there are " +
                        std::to_string(scene.surfaces.size()) + ".");
  }
  for (const std::uint32_t v : soup.corner)
    if (v >= soup.vertices.size())
      refuse(scene, "a face has vertex " + std::to_string(v) + " of " + std::to_string(soup.vertices.size()) + ".");
}

void check_lights(const Scene& scene) {
  for (const Luminaire& luminaire : scene.lights.luminaires) {
    const std::string name = "luminaire '" + luminaire.name + "' ";
    if (!is_finite(luminaire.position)) refuse(scene, name + "stands nowhere: its position is no number.");
    const Spectrum& colour =
        std::visit([](const auto& kind) -> const Spectrum& { return kind.colour(); }, luminaire.kind);
    if (!is_light(colour)) refuse(scene, name + "gives " + value(colour) + ", which is negative or no number.");
    if (const auto* web = std::get_if<WebLuminaire>(&luminaire.kind); web && !web->web)
      refuse(scene, name + "has no photometric web; read one, or make it a point luminaire.");
    if (const auto* spot = std::get_if<SpotLuminaire>(&luminaire.kind); spot && !is_unit(spot->direction))
      refuse(scene, name + "has no direction; it is a vector of length 1.");
  }
  for (const Sun& sun : scene.lights.suns)
    if (!is_unit(sun.direction) || !is_light(sun.normal_irradiance))
      refuse(scene, "a sun has no direction of length 1, or light that is negative or no number.");
  if (const auto& sky = scene.lights.sky) {
    if (!is_light(sky->horizontal_irradiance))
      refuse(scene, "the sky gives " + value(sky->horizontal_irradiance) + " W/m2, which is negative or no number.");
    if (!(sky->ground_reflectance >= 0 && sky->ground_reflectance <= 1))
      refuse(scene, "the ground's reflectance is " + rounded(sky->ground_reflectance) + ", outside [0, 1].");
    if (sky->model == SkyModel::image && !sky->image) refuse(scene, "the sky has no image.");
  }
  for (const SensorSet& set : scene.sensors)
    for (const SensorPoint& point : set.points)
      if (!is_finite(point.position) || !is_unit(point.normal))
        refuse(scene, "sensors '" + set.name + "': a point has no position, or a normal that is not of length 1.");
}

/// Groups become layers, and layers names of arrays.
void check_groups(const Scene& scene) {
  const auto check = [&](const std::string& what, const std::string& group) {
    if (const std::string problem = problem_with_group(group); !problem.empty())
      refuse(scene, what + ": its group '" + quotable(group, 40) + "' " + problem + ", or solve without layers.");
  };
  for (const Luminaire& luminaire : scene.lights.luminaires)
    check("luminaire '" + quotable(luminaire.name, 40) + "'", luminaire.group);
  for (const Material& material : scene.materials)
    check("material '" + quotable(material.name, 40) + "'", material.group);
}

/// Light that is a mean says so everywhere.
void check_times(const Scene& scene) {
  const LightSpec& lights = scene.lights;
  if (lights.times != std::max<std::size_t>(scene.times.size(), 1))
    refuse(scene, "its light is the mean of " + counted(lights.times, "time") + ", and it names " +
                      std::to_string(scene.times.size()) + "; make it by mean_over_times().");
  if (lights.sky && lights.sky->model == SkyModel::mean && lights.sky->parts.size() != lights.times)
    refuse(scene, "its sky is the mean of " + std::to_string(lights.sky->parts.size()) + " skies, of " +
                      counted(lights.times, "time") + "; make it by mean_over_times().");
  for (const Sun& sun : lights.suns)
    if (sun.time && *sun.time >= scene.times.size())
      refuse(scene, "a sun shines at time " + std::to_string(*sun.time) + " of " + std::to_string(scene.times.size()) +
                        "; they count from 0.");
}

void check_settings(const Scene& scene, const Settings& s) {
  const auto positive = [&](const std::optional<double>& x, const char* name) {
    if (x && !(std::isfinite(*x) && *x > 0))
      refuse(scene, std::string(name) + " = " + rounded(*x) + " is not above 0.");
  };
  positive(s.max_element, "max_element");
  if (s.detail && !(std::isfinite(*s.detail) && *s.detail >= 0))
    refuse(scene, "detail = " + rounded(*s.detail) + " is below 0.");
  positive(s.target_error, "target_error");
  if (s.target_error && *s.target_error >= 1)
    refuse(scene, "target_error = " + rounded(*s.target_error) + " is " + percent(*s.target_error) +
                      "; it is relative: 0.02 is 2 %.");
  if (s.target_error && s.error_samples == 0u)
    refuse(scene, "a target error cannot be kept without measuring the error; leave out --no-error, or the target.");
  positive(s.time_limit, "time_limit");
  if (s.channels && *s.channels != 1 && *s.channels != 3)
    refuse(scene, "channels = " + std::to_string(*s.channels) + "; 1 or 3 are possible.");
  if (!scene.times.empty() && s.solve.method != Method::hierarchical)
    refuse(scene, "several times are solved by the hierarchical method only, and the method is " +
                      std::string(kMethodNames[static_cast<std::size_t>(s.solve.method)]) + ".");
  if (s.layers && s.solve.method != Method::hierarchical)
    refuse(scene, "layers are of the hierarchical method only, and the method is " +
                      std::string(kMethodNames[static_cast<std::size_t>(s.solve.method)]) + ".");
  if (s.solve.tighten < 0 || s.solve.tighten > 8)
    refuse(scene, "tighten = " + std::to_string(s.solve.tighten) + " is outside [0, 8].");
}

}  // namespace

void require_valid(const Scene& scene, const Settings& settings) {
  for (const Material& material : scene.materials) check_material(scene, material);
  check_faces(scene);
  check_lights(scene);
  check_times(scene);
  check_settings(scene, settings);
  if (settings.layers) check_groups(scene);
}

}  // namespace clerestory
