#include "io/formats/ifc_lights.h"

#include <algorithm>
#include <cmath>

#include "io/formats/photometry.h"
#include "io/text.h"
#include "io/unit_vector.h"
#include "solver/model/error.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostAngles = 4096;
constexpr double kMostFlux = 1e15;  // [lm]

Vec3 vector(const Json& of, const char* key) {
  const Json& v = of.at(key);
  if (!v.is_array() || v.size() != 3) throw std::runtime_error(text(key, " of a light is no vector"));
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

std::vector<double> angles_of(const Json& list) {
  if (!list.is_array() || list.size() > kMostAngles) throw std::runtime_error("angles of a light are no list");
  std::vector<double> angles;
  for (const Json& angle : list) angles.push_back(angle.is_number() ? angle.get<double>() : std::nan(""));
  return angles;
}

bool ascends(const std::vector<double>& angles, double last) {
  return !angles.empty() && std::isfinite(angles.back()) && angles.front() >= -1e-6 && angles.back() <= last + 1e-6 &&
         std::adjacent_find(angles.begin(), angles.end(), [](double a, double b) { return !(a < b); }) == angles.end();
}

/// Intensities of planes C with common angles gamma; nothing when it is something else, or a single ray.
std::shared_ptr<const PhotometricWeb> web_of(const Json& distribution, const std::string& name,
                                             std::vector<std::string>& warnings) {
  if (distribution.value("type", "") != "TYPE_C") return nullptr;
  const Json& planes = distribution.at("planes");
  if (!planes.is_array() || planes.empty() || planes.size() > kMostAngles) return nullptr;
  PhotometricWeb web;
  web.name = name;
  web.vertical = angles_of(planes[0].at("angles"));
  if (web.vertical.size() < 2 || !ascends(web.vertical, 180)) return nullptr;
  for (const Json& plane : planes) {
    const std::vector<double> intensities = angles_of(plane.at("intensities"));
    if (angles_of(plane.at("angles")) != web.vertical || intensities.size() != web.vertical.size()) return nullptr;
    web.horizontal.push_back(plane.at("angle").is_number() ? plane["angle"].get<double>() : std::nan(""));
    for (const double I : intensities) {
      if (!(I >= 0 && I <= 1e9)) return nullptr;
      web.candela.push_back(static_cast<float>(I));
    }
  }
  if (!ascends(web.horizontal, 360)) return nullptr;
  const auto symmetry = symmetry_of(web.horizontal);
  if (!symmetry) return nullptr;
  web.symmetry = *symmetry;
  complete_web(web, 0, true, warnings);
  return web.flux > 0 ? std::make_shared<const PhotometricWeb>(std::move(web)) : nullptr;
}

/// LightColour says a hue, the flux how much: its luminous mean is 1.
Spectrum hue_of(const Json& source) {
  const Vec3 rgb = vector(source, "colour");
  const Spectrum colour{std::clamp(rgb.x, 0.0, 1e6), std::clamp(rgb.y, 0.0, 1e6), std::clamp(rgb.z, 0.0, 1e6)};
  const double mean = photometric(colour) / kWhiteEfficacy;
  return mean > 0 ? colour / mean : Spectrum(1.0);
}

}  // namespace

/// The photometric file that a source names, where it lies beside the IFC file; folders in its name do not count.
IfcLights::Web IfcLights::web_beside(const std::string& named) {
  const std::string name = named.substr(named.find_last_of("/\\") + 1);  // npos + 1 is 0
  const std::string extension = to_lower(std::filesystem::path(name).extension().string());
  const auto file = finder_.file(ifc_file_.parent_path(), name);
  if ((extension != ".ies" && extension != ".ldt") || !file) return nullptr;
  const auto [at, is_new] = webs_.try_emplace(*file);
  if (!is_new) return at->second;
  model_.files.push_back(*file);
  try {
    at->second = std::make_shared<const PhotometricWeb>(read_photometry(*file, model_.warnings, &model_.files));
  } catch (const InputError& problem) {
    model_.warnings.push_back(problem.what());
  }
  return at->second;
}

std::optional<Luminaire> IfcLights::luminaire(const Json& source, const std::string& fixture) {
  const double flux = source.value("flux", 0.0);
  if (!(flux > 0 && flux <= kMostFlux)) return std::nullopt;
  std::string name = source.value("name", "");
  name = name.empty() ? fixture : name;
  const Spectrum power = hue_of(source) * (flux / kWhiteEfficacy);
  const Json& given = source.contains("distribution") ? source["distribution"] : Json();
  const std::string file = source.value("file", "");
  const auto web = given.is_object() ? web_of(given, name, model_.warnings) : web_beside(file);
  if (!web || !(web->flux > 0)) {
    const bool is_there = web || finder_.file(ifc_file_.parent_path(), file);
    model_.warnings.push_back(
        text("the light '", quotable(name), "' is taken as a point of ", flux, " lm: ",
             given.is_object() ? "its intensities are not planes of type C with common angles, all round or by symmetry"
             : file.empty()    ? "the file does not say where its light goes"
                               : text("its photometric file '", quotable(file), "' ",
                                   is_there ? "gives no light that can be read" : "is not beside the model")));
    return Luminaire{name, vector(source, "position"), "", PointLuminaire{power}};
  }
  WebLuminaire luminaire;
  luminaire.web = web;
  luminaire.axes.z = unit_vector(vector(source, "z"));
  luminaire.axes.x = unit_vector(vector(source, "x"));
  luminaire.axes.y = cross(luminaire.axes.z, luminaire.axes.x);
  luminaire.scale = power / web->flux;
  return Luminaire{name, vector(source, "position"), "", luminaire};
}

ModelFixture IfcLights::fixture(const Json& json) {
  ModelFixture fixture;
  for (const Json& name : json.at("names")) fixture.names.push_back(clean_text(name.get<std::string>()));
  if (fixture.names.empty()) throw std::runtime_error("a fixture has no name");
  fixture.is_fixture = json.at("is_fixture").get<bool>();
  fixture.position = vector(json, "position");
  fixture.x = unit_vector(vector(json, "x"));
  fixture.z = unit_vector(vector(json, "z"));
  if (std::abs(dot(fixture.x, fixture.z)) > 1e-6 || length(cross(fixture.x, fixture.z)) < 0.5)
    throw std::runtime_error("the axes of a fixture are not at right angles");
  if (json.contains("surface")) {
    const auto surface = json["surface"].get<std::size_t>();
    if (surface >= model_.surfaces.size()) throw std::runtime_error("a fixture has a body that is no surface");
    fixture.body = SurfaceId(surface);
  }
  for (const Json& source : json.at("sources")) {
    if (auto light = luminaire(source, fixture.names.front()))
      fixture.lights.push_back(std::move(*light));
    else
      fixture.mute.push_back(clean_text(source.value("kind", "")));
  }
  return fixture;
}

}  // namespace clerestory
