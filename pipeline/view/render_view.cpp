#include "pipeline/view/render_view.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <string_view>

#include "io/picture/encode.h"
#include "io/picture/iso_lines.h"
#include "io/picture/paint_view.h"
#include "io/read_result.h"
#include "io/text.h"
#include "meshing/make_lightmap.h"
#include "pipeline/view/choose_camera.h"
#include "pipeline/view/lights_of_result.h"
#include "pipeline/wording.h"
#include "solver/illumination/caustic_legs.h"
#include "solver/model/error.h"
#include "solver/model/exposure.h"
#include "solver/model/units.h"
#include "solver/run/accuracy.h"
#include "solver/view/rest_of_light.h"
#include "solver/view/trace_view.h"
#include "solver/view/visible_line.h"

namespace clerestory {
namespace {

/// A field as it is named, and its unit.
struct Quantity {
  std::string name, unit;
};

Quantity quantity_of(const std::string& name) {
  const std::string base = name.substr(0, name.find(':'));
  if (base == "illuminance" || base == "mean_illuminance") return {quotable(name, 24), "[lux]"};
  if (base == "luminance") return {name, "[cd/m2]"};
  if (base == "daylight_factor") return {name, "[%]"};
  if (base == "irradiance" || base == "radiosity") return {quotable(name, 24), "[W/m2]"};
  return {quotable(name, 24), ""};
}

ShownField field_of(const WrittenResult& result, const ViewRequest& request) {
  if (request.shows_colour() || request.show == "luminance") return radiance_of(result);
  const WrittenArray& array = array_of_points(result, request.show);
  if (array.components != 1 && array.components != 3)
    throw InputError(text(result.file, ": its array '", quotable(request.show), "' has ", array.components,
                          " components; pictures are of 1 or 3."));
  return {array.components, array.value, false};
}

/// One number a row: of three channels the mean by their luminous weights.
std::vector<float> one_channel(const std::vector<float>& value, int channels, double factor) {
  std::vector<float> one;
  one.reserve(value.size() / static_cast<std::size_t>(channels));
  for (std::size_t i = 0; i < value.size(); i += static_cast<std::size_t>(channels)) {
    const auto c = [&](std::size_t k) { return double{value[i + (channels == 3 ? k : 0)]}; };
    one.push_back(static_cast<float>(factor * luminous_mean({c(0), c(1), c(2)})));
  }
  return one;
}

/// Lines of equal value on what is shown, as the camera sees them.
std::vector<LineOnPicture> lines_on_picture(const WrittenResult& result, const ViewRequest& request,
                                            const Camera& camera, const std::string& name,
                                            const std::vector<std::uint32_t>& shown) {
  const WrittenArray& array = array_of_points(result, name);
  const ViewScene scene(result, {array.components, array.value, false}, shown);
  const std::vector<float> value = one_channel(array.value, array.components, 1);
  const auto facing = facing_triangles(camera, result.points, scene.triangles());
  std::vector<LineOnPicture> lines;
  for (const IsoLine& line : iso_lines(result.points, facing, value, request.isolux)) {
    LineOnPicture& to = lines.emplace_back();
    to.level = line.level;
    for (const auto& part : visible_parts(camera, scene.surfaces(), line.points)) {
      auto& corners = to.parts.emplace_back();
      for (const OnPicture& at : part) corners.push_back({at.x, at.y});
    }
  }
  return lines;
}

std::string exr_of(const ViewImage& image) {
  const auto n = static_cast<std::size_t>(image.channels);
  std::vector<float> rows;
  rows.reserve((n + 1) * image.pixels());
  for (std::size_t i = 0; i < image.pixels(); ++i) {
    for (std::size_t k = 0; k < n; ++k) rows.push_back(image.value[i * n + k]);
    rows.push_back(std::min(image.seen[i], 1.0f));
  }
  const std::vector<std::string> names =
      n == 3 ? std::vector<std::string>{"R", "G", "B", "A"} : std::vector<std::string>{"Y", "A"};
  return exr_bytes(image.width, image.height, names, rows);
}

void warn_when_inside(const ViewScene& scene, const ViewRequest& request, const Camera& camera, Observer& observer) {
  if (request.is_drawing() || camera.kind == CameraKind::orthographic) return;
  const double backs = scene.backs_around(camera.eye);
  if (backs > 0.5)
    observer.warn(text("the eye is inside of something: ", percent(backs),
                       " of what is around it is seen from behind, where surfaces are not shown; move --eye."));
}

ValueScale scale_of(const ViewImage& image, const ViewRequest& request) {
  if (request.range) return {request.range->first, request.range->second, request.log_scale};
  std::vector<float> seen;
  for (std::size_t i = 0; i < image.pixels(); ++i)
    if (image.seen[i] > 0.5f) seen.push_back(image.value[i] / image.seen[i]);
  return scale_around(std::move(seen), request.log_scale);
}

/// What rays find at each place that is seen, and the field that is left to the result.
struct RaysAndRest {
  Prepared scene;
  VertexLightmap points;           ///< of its patches
  std::optional<FineLight> light;  ///< of that
  ShownField rest;
  std::optional<ViewScene> around;  ///< of a final gather: all surfaces, with all light
};

/// As the accuracy of the result has them.
void add_caustics(const WrittenResult& result, RaysAndRest& rays, const Monitor& monitor) {
  const auto named = result.texts.find("settings.accuracy");
  const bool is_named = named != result.texts.end() && !named->second.empty();
  const auto at = std::ranges::find(kAccuracyNames, is_named ? std::string_view(named->second.front()) : "standard");
  const Effort e = effort(at == std::end(kAccuracyNames) ? Accuracy::standard
                                                         : static_cast<Accuracy>(at - std::begin(kAccuracyNames)));
  rays.scene.lights.caustics = find_caustics(rays.scene.problem(), static_cast<std::size_t>(e.caustic_particles),
                                             static_cast<std::size_t>(e.caustic_legs), 1, monitor);
  if (!rays.scene.lights.caustics.legs.empty()) rays.points = make_lightmap(rays.scene.patches);
}

/// Null when interrupted. throws InputError as lights_of_result(), and for quantities that have no such light.
std::unique_ptr<RaysAndRest> rays_and_rest(const WrittenResult& result, const std::filesystem::path& file,
                                           const ViewRequest& request, const Monitor& monitor) {
  const bool is_radiance = request.shows_colour() || request.show == "luminance";
  if (!is_radiance && request.show != "illuminance")
    throw InputError(text(result.file, ": '", quotable(request.show), "' is not found by rays; ",
                          request.final_gather > 0 ? "--final-gather" : "--raytrace",
                          " goes with --show colour, luminance or illuminance."));
  std::optional<Prepared> scene = lights_of_result(result, file, request.scene, monitor);
  if (!scene) return {};
  auto found = std::make_unique<RaysAndRest>(RaysAndRest{std::move(*scene), {}, {}, {}, {}});
  add_caustics(result, *found, monitor);
  found->light.emplace(found->scene.problem(), &found->points);
  Field E;  // that is left to the result
  if (request.final_gather > 0) {
    std::vector<std::uint32_t> all(result.triangles.size());
    std::iota(all.begin(), all.end(), 0u);
    found->around.emplace(result, radiance_of(result), std::move(all));
    E = light_by_gloss(result, *found->light, monitor);
  } else {
    E = rest_of_light(result, *found->light, monitor);
  }
  if (E.value.empty()) return {};
  found->rest = is_radiance ? radiance_of(result, E) : illuminance_of(E);
  return found;
}

}  // namespace

RenderedView render_view(const WrittenResult& result, const std::filesystem::path& file, const ViewRequest& request,
                         bool as_exr, Observer& observer, const Monitor& monitor) {
  ShownField field = field_of(result, request);
  const Camera camera = choose_camera(result, file, request);
  std::unique_ptr<RaysAndRest> rays;
  if (request.wants_lights()) {
    rays = rays_and_rest(result, file, request, monitor);
    if (!rays) return {};
    field = std::move(rays->rest);
  }
  const std::vector<std::uint32_t> shown = shown_triangles(result, request);
  const ViewScene scene(result, std::move(field), shown);
  warn_when_inside(scene, request, camera, observer);

  const double exposure = exposure_of(result, request.ev);
  ViewOptions options{.samples = request.samples, .sees_sky = !request.is_drawing()};
  // What is brighter than white is white before a pixel takes its mean, so that bright edges are smooth.
  if (request.shows_colour() && !as_exr) options.most = 1 / (exposure * std::numbers::pi);
  if (rays) options.fine = &*rays->light, options.gather = request.final_gather;
  if (rays && rays->around) options.around = &*rays->around;
  ViewImage image = scene.trace(camera, options, monitor);
  RenderedView view;
  if (image.empty()) return view;
  if (std::ranges::all_of(image.seen, [](float s) { return s == 0; }))
    observer.warn("nothing is seen from there: the picture is empty.");
  const bool shows_light = request.shows_colour() || request.show == "luminance";
  if (rays)
    view.notes.push_back(text(rays->light->empty() ? "the scene has no lamps and no sun for rays to find"
                                                   : "light straight from lamps and sun by rays",
                              request.final_gather > 0
                                  ? text(", all other light by ", request.final_gather, " rays from each place")
                                  : std::string(", all other light is the result's")));
  if (shows_light && !rays && std::ranges::any_of(result.materials, &Material::is_glossy))
    view.notes.push_back("glossy surfaces show other surfaces and the sky, not lamps and the sun themselves");
  if (!request.shows_colour() && (request.show == "luminance" || !as_exr)) {
    image.value = one_channel(image.value, image.channels, request.show == "luminance" ? kWhiteEfficacy : 1);
    image.channels = 1;
  }
  view.width = image.width, view.height = image.height;
  if (as_exr) {
    view.bytes = exr_of(image);
    view.notes.push_back(request.shows_colour() ? "radiance [W/(m2 sr)]"
                                                : request.show + " " + quantity_of(request.show).unit);
    return view;
  }

  Pixels pixels;
  std::optional<ValueScale> scale;
  if (request.shows_colour()) {
    pixels = true_colours(image, exposure, request.is_drawing() ? 1 : 0);
    view.notes.push_back(text("exposure ", rounded(exposure), " m2/W, ", rounded(request.ev),
                              " EV from the automatic one; white is ",
                              rounded(photometric(Spectrum(1 / exposure)) / std::numbers::pi), " cd/m2"));
  } else {
    scale = scale_of(image, request);
    pixels = false_colours(image, *scale);
    const Quantity quantity = quantity_of(request.show);
    view.notes.push_back(text(quantity.name, " from ", scale->low, " to ", scale->high, " ", quantity.unit,
                              scale->by_logarithm ? ", by logarithm" : ""));
  }
  if (!request.isolux.empty())
    draw_lines(lines_on_picture(result, request, camera, request.shows_colour() ? "illuminance" : request.show, shown),
               scale ? &*scale : nullptr, pixels);
  if (scale) {
    const Quantity quantity = quantity_of(request.show);
    pixels = with_legend(pixels, *scale, quantity.name, quantity.unit);
  }
  view.width = pixels.width, view.height = pixels.height;
  view.bytes = png_bytes(pixels.width, pixels.height, pixels.rgb);
  return view;
}

}  // namespace clerestory
