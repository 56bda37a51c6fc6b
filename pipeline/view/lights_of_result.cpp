#include "pipeline/view/lights_of_result.h"

#include <algorithm>
#include <cmath>

#include "io/input_file.h"
#include "io/read_run_report.h"
#include "io/text.h"
#include "pipeline/collect_around.h"
#include "pipeline/scene_of_result.h"
#include "pipeline/wording.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kAlike = 1e-3;        ///< of numbers that were written as float, or summed in another order [1]
constexpr double kMissing = 0.01;      ///< of the surfaces; less is rounding
constexpr double kOffSurface = 1e-5;   ///< of the diagonal: results are written as float
constexpr std::size_t kPlaces = 2000;  ///< where surfaces are looked for

bool alike(double a, double b) { return std::abs(a - b) <= kAlike * std::max(std::abs(a), std::abs(b)); }
bool alike(const Spectrum& a, const Spectrum& b) {
  for (int k = 0; k < kMaxChannels; ++k)
    if (!alike(a[k], b[k])) return false;
  return true;
}

void require_light_as_in_scene(const WrittenResult& result) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(text(result.file, ": ", why,
                          "; rays find the light that its scene has. Leave --raytrace and --final-gather out."));
  };
  if (result.texts.contains("settings.weather")) refuse("holds the light of a year");
  if (result.texts.contains("time")) refuse("holds one of several times");
  for (const ShownLayer& layer : result.around.layers)
    if (layer.factor != 1) refuse(text("was mixed: '", quotable(layer.name), "' is at ", rounded(layer.factor)));
}

/// Nothing where the result does not say, or says 0.
std::optional<double> figure(const WrittenResult& result, const char* name) {
  const auto at = result.figures.find(name);
  return at == result.figures.end() || !(at->second > 0) ? std::nullopt : std::optional(at->second);
}

/// As it was meshed.
Settings settings_of(const WrittenResult& result) {
  Settings settings;
  settings.channels = result.channels();
  settings.max_element = figure(result, "settings.max_element");
  if (const auto detail = result.figures.find("settings.detail"); detail != result.figures.end())
    settings.detail = detail->second;
  return settings;
}

/// What differs between a scene as it is now and as it was; empty: nothing.
std::string changed_material(const WrittenResult& result, const std::vector<Material>& now) {
  if (result.materials.size() != now.size())
    return text("it has ", now.size(), " materials instead of ", result.materials.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Material &a = result.materials[i], &b = now[i];
    const bool same_gloss = a.is_glossy() == b.is_glossy() &&
                            (!a.is_glossy() || (alike(a.gloss->specular, b.gloss->specular) &&
                                                a.gloss->exponent.has_value() == b.gloss->exponent.has_value() &&
                                                alike(a.gloss->exponent.value_or(0), b.gloss->exponent.value_or(0)) &&
                                                (a.gloss->exponent || alike(a.gloss->roughness, b.gloss->roughness))));
    if (a.name != b.name || a.kind != b.kind || !alike(a.reflectance, b.reflectance) ||
        !alike(a.transmittance, b.transmittance) || !same_gloss)
      return text("its material '", quotable(b.name), "' is another");
  }
  return {};
}

std::string changed_light(const WrittenResult& result, const Scene& scene) {
  Solved nothing;
  nothing.patches.channels = result.channels();
  const SceneAround now = collect_around(scene, nothing);
  const SceneAround& then = result.around;
  if (now.luminaires.size() != then.luminaires.size())
    return text("it has ", counted(now.luminaires.size(), "luminaire"), " instead of ", then.luminaires.size());
  for (std::size_t i = 0; i < now.luminaires.size(); ++i) {
    const ShownLuminaire &a = then.luminaires[i], &b = now.luminaires[i];
    if (length(a.position - b.position) > kAlike || !alike(a.luminous_flux, b.luminous_flux))
      return text("its luminaire '", quotable(b.name), "', number ", i + 1, ", is another");
  }
  const std::vector<double>&a = then.sky.radiance.value, &b = now.sky.radiance.value;
  const double most = a.empty() ? 0 : *std::ranges::max_element(a);
  if (a.size() != b.size() ||
      !std::ranges::equal(a, b, [&](double x, double y) { return std::abs(x - y) <= kAlike * most; }))
    return "its sky is another";
  const std::optional<Daylight> daylight = run_report_of(result.report, result.file).daylight;
  if (daylight.has_value() != scene.daylight.has_value()) return "its daylight is another";
  constexpr double kDegrees = 0.02;
  if (daylight && (std::abs(daylight->sun.elevation_deg - scene.daylight->sun.elevation_deg) > kDegrees ||
                   std::abs(daylight->sun.azimuth_deg - scene.daylight->sun.azimuth_deg) > kDegrees))
    return "its sun stands elsewhere";
  return {};
}

std::string changed_surfaces(const WrittenResult& result, const Prepared& now) {
  const std::size_t faces = now.repairs.input_faces;
  const double faces_then = figure(result, "repairs.input_faces").value_or(static_cast<double>(faces));
  if (faces_then != static_cast<double>(faces))
    return text("it has ", grouped(faces), " faces instead of ", grouped(static_cast<std::size_t>(faces_then)));
  const double reach = kOffSurface * now.rays.diameter() + now.repairs.tolerance + now.repairs.simplified_by;
  const std::size_t step = std::max<std::size_t>(result.triangles.size() / kPlaces, 1);
  double area = 0, missing = 0;
  for (std::size_t i = 0; i < result.triangles.size(); i += step) {
    const auto& [a, b, c] = result.triangles[i];
    const auto& x = result.points;
    const Vec3 across = cross(x[b] - x[a], x[c] - x[a]);
    if (!(length(across) > 0)) continue;
    const Vec3 n = normalized(across), middle = (x[a] + x[b] + x[c]) / 3 - now.patches.origin;
    area += length(across);
    if (!(now.rays.first_surface({middle + n * reach, -n}) <= 2 * reach)) missing += length(across);
  }
  if (missing > kMissing * area) return text("it has no face where ", percent(missing / area), " of the surfaces were");
  return {};
}

}  // namespace

std::optional<Prepared> lights_of_result(const WrittenResult& result, const std::filesystem::path& file,
                                         const std::filesystem::path& instead, const Monitor& monitor) {
  require_light_as_in_scene(result);
  const Scene scene = read_scene_of(result, file, instead);
  const auto require_same = [&](const std::string& change) {
    if (!change.empty())
      throw InputError(text(short_name(scene.file), ": is not as it was when ", result.file, " was solved: ", change,
                            ". Solve it again, or name the right one by --scene FILE."));
  };
  if (!scene.times.empty())
    throw InputError(text(short_name(scene.file), ": is lit for ", scene.times.size(),
                          " times, and rays need the light of one. Leave --raytrace and --final-gather out."));
  require_same(changed_light(result, scene));
  std::optional<Prepared> prepared = prepare_for_rays(scene, settings_of(result), monitor);
  if (!prepared) return {};
  require_same(changed_material(result, prepared->patches.materials));
  require_same(changed_surfaces(result, *prepared));
  return prepared;
}

}  // namespace clerestory
