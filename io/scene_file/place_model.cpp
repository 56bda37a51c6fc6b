#include "io/scene_file/place_model.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "io/input_file.h"
#include "io/scene_file/own_materials.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

std::array<double, 12> rows_of(const Affine& a) {
  std::array<double, 12> rows{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c)
      rows[4 * r + c] = c < 3 ? a.A[r][static_cast<int>(c)] : a.b[static_cast<int>(r)];
  return rows;
}

void warn_once(Scene& scene, ModelsInScene& before, std::string warning) {
  if (before.warnings.insert(warning).second) scene.warnings.push_back(std::move(warning));
}

/// A name for messages and results; what is longer than a page of text names nothing.
std::string usable_name(const std::string& name) { return quotable(name, 1000); }

/// For each material of the model its id in the scene; one that is there already, the same in all it says, is shared.
/// Materials and surfaces that no face carries are left out.
std::vector<MaterialId> add_materials(Scene& scene, ModelsInScene& before, const Model& model,
                                      const std::filesystem::path& file, const std::vector<bool>& hidden,
                                      const MaterialOverride& by_scene_file) {
  std::vector<bool> carried(model.materials.size(), false);
  for (std::size_t f = 0; f < model.polygons.face_count(); ++f)
    if (!hidden[model.polygons.surface[f]]) carried[model.polygons.material[f]] = true;
  const std::size_t of_others = scene.materials.size();
  const std::string stem = clean_text(file.stem().string());
  OwnMaterials own(before.takes_gloss);
  std::vector<MaterialId> id(model.materials.size());
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    if (!carried[m]) continue;
    ModelMaterial described = model.materials[m];
    described.material.name = usable_name(described.material.name);
    Material material = described.material;
    if (!by_scene_file || !by_scene_file(material)) material = own.settle(described);
    const auto same = before.material.find(material.name);
    if (same != before.material.end() && same->second < of_others && scene.materials[same->second] == material) {
      id[m] = same->second;
      continue;
    }
    material.name = before.materials.take(material.name, stem);
    id[m] = MaterialId(scene.materials.size());
    before.material.emplace(material.name, id[m]);
    scene.materials.push_back(std::move(material));
  }
  for (const std::string& warning : own.warnings()) warn_once(scene, before, short_name(file) + ": " + warning);
  if (const std::string gloss = short_name(file) + ": " + own.gloss_left_out();
      own.leaves_gloss_out() && before.warnings.insert(gloss).second)
    scene.left_out.push_back(gloss);
  return id;
}

std::vector<SurfaceId> add_surfaces(Scene& scene, NamesInUse& names, const Model& model,
                                    const std::vector<bool>& hidden, const std::string& stem) {
  std::vector<bool> carried(model.surfaces.size(), false);
  for (const SurfaceId s : model.polygons.surface) carried[s] = !hidden[s];
  std::vector<SurfaceId> id(model.surfaces.size());
  for (std::size_t s = 0; s < model.surfaces.size(); ++s) {
    if (!carried[s]) continue;
    id[s] = SurfaceId(scene.surfaces.size());
    scene.surfaces.push_back(names.take(usable_name(model.surfaces[s]), stem));
  }
  return id;
}

Vec3 light_position(const Vec3& p, const std::string& light, const std::string& file) {
  if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargestCoordinate) {
    throw InputError(text(file, ": the light '", quotable(light), "' stands at (", p.x, ", ", p.y, ", ", p.z,
                          "), outside [-1e12, 1e12] m; check the file, unit and transform"));
  }
  return p;
}

void turn(PointLuminaire&, const Affine&) {}
void turn(SpotLuminaire& luminaire, const Affine& place) {
  luminaire.direction = normalized(place.direction(luminaire.direction));
}
void turn(WebLuminaire& luminaire, const Affine& place) {
  // A mirrored transform does not mirror the lamp: its third axis follows from the others.
  luminaire.axes.z = normalized(place.direction(luminaire.axes.z));
  const Vec3 x = place.direction(luminaire.axes.x);
  luminaire.axes.x = normalized(x - luminaire.axes.z * dot(x, luminaire.axes.z));
  luminaire.axes.y = cross(luminaire.axes.z, luminaire.axes.x);
}

void add_luminaire(Scene& scene, Luminaire luminaire, const Affine& place, const std::string& file) {
  luminaire.position = light_position(place.point(luminaire.position), luminaire.name, file);
  std::visit([&](auto& kind) { turn(kind, place); }, luminaire.kind);
  scene.lights.luminaires.push_back(std::move(luminaire));
}

void add_lights(Scene& scene, const LightSpec& lights, const Affine& place, const std::string& file) {
  for (const Luminaire& luminaire : lights.luminaires) add_luminaire(scene, luminaire, place, file);
  for (Sun sun : lights.suns) {
    sun.direction = normalized(place.direction(sun.direction));
    scene.lights.suns.push_back(sun);
  }
}

/// Adds the light of fixtures. Returns which surfaces of the model are housings of those.
std::vector<bool> add_fixtures(Scene& scene, const Model& model, const Affine& place, const std::string& file,
                               const FixtureLight& by_fixture) {
  std::vector<bool> housing(model.surfaces.size(), false);
  NameList dark, mute;
  for (const ModelFixture& fixture : model.fixtures) {
    ModelFixture placed = fixture;
    placed.position = light_position(place.point(fixture.position), fixture.names.front(), file);
    placed.z = normalized(place.direction(fixture.z));
    const Vec3 x = place.direction(fixture.x);
    placed.x = normalized(x - placed.z * dot(x, placed.z));
    std::size_t lights = 0;
    if (auto luminaire = by_fixture ? by_fixture(placed) : std::nullopt) {
      scene.lights.luminaires.push_back(std::move(*luminaire));
      lights = 1;
    } else {
      for (const Luminaire& own : fixture.lights) add_luminaire(scene, own, place, file);
      lights = fixture.lights.size();
      for (const std::string& kind : fixture.mute) mute.add(text(fixture.names.front(), " (", kind, ")"));
      if (lights == 0 && fixture.mute.empty() && fixture.is_fixture) dark.add(fixture.names.front());
    }
    if (lights > 0 && fixture.body) housing[*fixture.body] = true;
  }
  if (!mute.empty()) {
    scene.warnings.push_back(text(file, ": light sources without a flux in lumens are left out: ", mute.str(),
                                  "; name a photometric file for them under \"fixtures\" of a scene file"));
    scene.not_read.push_back({"light source without a flux", mute.count(), mute.first()});
  }
  if (!dark.empty()) {
    scene.warnings.push_back(text(file, ": nothing says what light these fixtures give, they are left dark: ",
                                  dark.str(), "; name a photometric file for them under \"fixtures\" of a scene file"));
    scene.not_read.push_back({"light fixture without photometry", dark.count(), dark.first()});
  }
  return housing;
}

void add_spaces(Scene& scene, NamesInUse& names, const Model& model, const Affine& place, const std::string& stem) {
  for (NamedSpace space : model.spaces) {
    space.name = names.take(space.name, stem);
    for (Vec3& p : space.vertices) p = place.point(p);
    scene.spaces.push_back(std::move(space));
  }
}

void note_north(Scene& scene, const Model& model, const Affine& place) {
  if (!model.north_deg || scene.model_north_deg) return;
  constexpr double kDegree = std::numbers::pi / 180;
  const Vec3 north = place.direction({std::sin(*model.north_deg * kDegree), std::cos(*model.north_deg * kDegree), 0});
  scene.model_north_deg = std::atan2(north.x, north.y) / kDegree;
}

void warn_of_size(Scene& scene, ModelsInScene& before, const Vec3& size, bool unit_is_known, const std::string& name) {
  const double largest = std::max({size.x, size.y, size.z});
  const std::string extent = text(name, ": is ", size.x, " x ", size.y, " x ", size.z, " m large");
  if (largest < 0.01) {
    warn_once(scene, before, text(extent, "; is its unit larger than assumed? Say so with \"unit\" (--unit)"));
  } else if (largest > 10'000 || (!unit_is_known && largest > 500)) {
    warn_once(scene, before, text(extent, "; was it drawn in millimetres? Then say \"unit\": \"mm\" (--unit mm)"));
  }
}

std::string words_of_unit(double metres) { return metres == 1 ? "metres" : text("units of ", metres, " m"); }

}  // namespace

Affine to_scene(double metres, Up up, const std::optional<std::array<double, 16>>& transform) {
  Affine file;
  if (up == Up::y) file.A = {Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{0, 1, 0}};
  for (Vec3& row : file.A) row *= metres;
  if (!transform) return file;
  const auto& t = *transform;
  const Affine placed{{Vec3{t[0], t[1], t[2]}, Vec3{t[4], t[5], t[6]}, Vec3{t[8], t[9], t[10]}}, {t[3], t[7], t[11]}};
  return placed * file;
}

std::optional<double> metres_of_unit(std::string_view unit) {
  if (unit == "m") return 1.0;
  if (unit == "cm") return 0.01;
  if (unit == "mm") return 0.001;
  if (unit == "ft") return 0.3048;
  if (unit == "in") return 0.0254;
  return std::nullopt;
}

std::string NamesInUse::take(const std::string& name, const std::string& stem) {
  if (taken_.insert(name).second) return name;
  const std::string start = text(name, " (", stem);
  for (int& n = last_[start];;) {
    const std::string candidate = ++n == 1 ? start + ")" : text(start, " ", n, ")");
    if (taken_.insert(candidate).second) return candidate;
  }
}

void note_files(Scene& scene, const std::filesystem::path& file, const Model& model) {
  scene.files.push_back(file);
  scene.files.insert(scene.files.end(), model.files.begin(), model.files.end());
}

void place_model(Scene& scene, ModelsInScene& before, const Model& model, const std::filesystem::path& file,
                 const Placement& placement, const MaterialOverride& by_scene_file, const FixtureLight& by_fixture) {
  const std::string name = short_name(file);
  constexpr std::size_t kShown = 50;
  const std::size_t count = model.warnings.size();
  for (std::size_t k = 0; k < std::min(count, kShown); ++k) warn_once(scene, before, name + ": " + model.warnings[k]);
  if (count > kShown) warn_once(scene, before, text(name, ": ", count - kShown, " more warnings are left out"));
  if (model.metres_per_unit && placement.metres_per_unit &&
      std::abs(*model.metres_per_unit / *placement.metres_per_unit - 1) > 1e-9) {
    warn_once(scene, before,
              text(name, ": the file itself says ", words_of_unit(*model.metres_per_unit),
                   "; the unit given for it is not used. To scale the model, use \"transform\""));
  }
  if (model.up && placement.up && *model.up != *placement.up) {
    warn_once(scene, before,
              text(name, ": the file itself says that ", *model.up == Up::y ? 'y' : 'z',
                   " is up; what was given for it is not used. To turn the model, use \"transform\""));
  }
  const double metres = model.metres_per_unit.value_or(placement.metres_per_unit.value_or(1.0));
  const Affine place = to_scene(metres, model.up.value_or(placement.up.value_or(Up::z)), placement.transform);
  const bool mirrored = place.mirrors();

  const std::string stem = clean_text(file.stem().string());
  scene.not_read.insert(scene.not_read.end(), model.not_read.begin(), model.not_read.end());
  const std::vector<bool> housing = add_fixtures(scene, model, place, name, by_fixture);
  const std::vector<MaterialId> material = add_materials(scene, before, model, file, housing, by_scene_file);
  const std::size_t first_surface = scene.surfaces.size();
  const std::vector<SurfaceId> surface = add_surfaces(scene, before.surfaces, model, housing, stem);
  scene.models.push_back({file, rows_of(place), first_surface, scene.surfaces.size() - first_surface});
  add_lights(scene, model.lights, place, name);
  add_spaces(scene, before.spaces, model, place, stem);
  note_north(scene, model, place);

  const PolygonSoup& from = model.polygons;
  PolygonSoup& to = scene.polygons;
  if (to.vertices.size() + from.vertices.size() >= std::numeric_limits<std::uint32_t>::max() ||
      to.corner.size() + from.corner.size() >= std::numeric_limits<std::uint32_t>::max()) {
    throw InputError(text(name, ": more than 4 billion corners in one scene; leave out what light does not need"));
  }
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec3 lower{kInfinity, kInfinity, kInfinity}, upper = -lower;
  for (const Vec3& p : from.vertices) {
    const Vec3 q = place.point(p);
    to.add_vertex(q);
    lower = {std::min(lower.x, q.x), std::min(lower.y, q.y), std::min(lower.z, q.z)};
    upper = {std::max(upper.x, q.x), std::max(upper.y, q.y), std::max(upper.z, q.z)};
  }
  for (std::size_t f = 0; f < from.face_count(); ++f) {
    if (housing[from.surface[f]]) continue;
    const std::uint32_t begin = from.face_begin[f], end = from.face_begin[f + 1];
    for (std::uint32_t c = begin; c < end; ++c) {
      const std::uint32_t vertex = first + from.corner[mirrored ? end - 1 - (c - begin) : c];
      const Vec3& p = to.vertices[vertex];
      if (!is_finite(p) || std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > kLargestCoordinate) {
        throw InputError(text(name, ": surface '", quotable(model.surfaces[from.surface[f]]), "' has a corner at (",
                              p.x, ", ", p.y, ", ", p.z,
                              "), outside [-1e12, 1e12] m; check the file, unit and transform"));
      }
      to.add_corner(vertex);
    }
    to.end_face(material[from.material[f]], surface[from.surface[f]]);
  }
  warn_of_size(scene, before, upper - lower, model.metres_per_unit || placement.metres_per_unit, name);
}

}  // namespace clerestory
