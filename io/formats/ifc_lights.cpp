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

/// Which part of the circle planes up to this angle are.
WebSymmetry symmetry_of(double last_plane) {
  if (last_plane < 1e-6) return WebSymmetry::rotational;
  if (std::abs(last_plane - 90) < 1e-6) return WebSymmetry::quadrants;
  if (std::abs(last_plane - 180) < 1e-6) return WebSymmetry::about_0_180;
  return WebSymmetry::none;
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
  web.symmetry = symmetry_of(web.horizontal.back());
  if (web.symmetry == WebSymmetry::none && web.horizontal.back() < 360 - 1e-6) {
    web.horizontal.push_back(360);  // C360 is C0
    web.candela.insert(web.candela.end(), web.candela.begin(),
                       web.candela.begin() + static_cast<std::ptrdiff_t>(web.vertical.size()));
  }
  complete_web(web, 0, true, warnings);
  return web.flux > 0 ? std::make_shared<const PhotometricWeb>(std::move(web)) : nullptr;
}

/// The photometric file that a source names, where it lies beside the IFC file; folders in its name do not count.
std::shared_ptr<const PhotometricWeb> web_beside(const std::filesystem::path& ifc_file, std::string named,
                                                 std::vector<std::string>& warnings) {
  named = named.substr(named.find_last_of("/\\") + 1);  // npos + 1 is 0
  const std::string extension = to_lower(std::filesystem::path(named).extension().string());
  std::error_code error;
  const std::filesystem::path file = ifc_file.parent_path() / named;
  if ((extension != ".ies" && extension != ".ldt") || !std::filesystem::is_regular_file(file, error)) return nullptr;
  try {
    return std::make_shared<const PhotometricWeb>(read_photometry(file, warnings));
  } catch (const InputError& problem) {
    warnings.push_back(problem.what());
    return nullptr;
  }
}

/// LightColour says a hue, the flux how much: its luminous mean is 1.
Spectrum hue_of(const Json& source) {
  const Vec3 rgb = vector(source, "colour");
  const Spectrum colour{std::clamp(rgb.x, 0.0, 1e6), std::clamp(rgb.y, 0.0, 1e6), std::clamp(rgb.z, 0.0, 1e6)};
  const double mean = photometric(colour) / kWhiteEfficacy;
  return mean > 0 ? colour / mean : Spectrum(1.0);
}

std::optional<Luminaire> luminaire_of(const Json& source, const std::string& fixture,
                                      const std::filesystem::path& ifc_file, std::vector<std::string>& warnings) {
  const double flux = source.value("flux", 0.0);
  if (!(flux > 0 && flux <= kMostFlux)) return std::nullopt;
  std::string name = source.value("name", "");
  name = name.empty() ? fixture : name;
  const Spectrum power = hue_of(source) * (flux / kWhiteEfficacy);
  const Json& given = source.contains("distribution") ? source["distribution"] : Json();
  const std::string file = source.value("file", "");
  const auto web = given.is_object() ? web_of(given, name, warnings) : web_beside(ifc_file, file, warnings);
  if (!web || !(web->flux > 0)) {
    warnings.push_back(text("the light '", quotable(name), "' is taken as a point of ", flux, " lm: ",
                            given.is_object() ? "its intensities are not planes of type C with common angles"
                            : !file.empty()
                                ? text("its photometric file '", quotable(file), "' is not beside the model")
                                : "the file does not say where its light goes"));
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

}  // namespace

ModelFixture read_ifc_fixture(const Json& json, std::size_t surfaces, const std::filesystem::path& ifc_file,
                              std::vector<std::string>& warnings) {
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
    if (surface >= surfaces) throw std::runtime_error("a fixture has a body that is no surface");
    fixture.body = SurfaceId(surface);
  }
  for (const Json& source : json.at("sources")) {
    const auto luminaire = luminaire_of(source, fixture.names.front(), ifc_file, warnings);
    if (luminaire)
      fixture.lights.push_back(*luminaire);
    else
      fixture.mute.push_back(clean_text(source.value("kind", "")));
  }
  return fixture;
}

}  // namespace clerestory
