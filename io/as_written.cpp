#include "io/as_written.h"

#include "io/vtp_file.h"
#include "solver/model/radiosity_at_points.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

using Arrays = std::map<std::string, WrittenArray>;

/// n rows of one number, value(i) each.
template <class Value>
void add(Arrays& to, const std::string& name, std::size_t n, const Value& value) {
  std::vector<float>& row = to[name].value;
  row.reserve(n);
  for (std::size_t i = 0; i < n; ++i) row.push_back(to_float(value(i), name.c_str(), i));
}

/// Lanes first .. first + channels - 1 of a field.
void add_field(Arrays& to, const std::string& name, const Field& field, std::size_t first, int channels) {
  WrittenArray& array = to[name];
  array.components = channels;
  array.value.reserve(field.size() * static_cast<std::size_t>(channels));
  for (std::size_t i = 0; i < field.size(); ++i)
    for (int c = 0; c < channels; ++c)
      array.value.push_back(to_float(field.at(i, static_cast<int>(first) + c), name.c_str(), i));
}
void add_field(Arrays& to, const std::string& name, const Field& field) {
  add_field(to, name, field, 0, field.channels);
}

/// What cells and points have in common.
void add_light(Arrays& to, const Field& E, const Field& B, const std::optional<double>& daylight_reference) {
  add_field(to, "irradiance", E);
  add(to, "illuminance", E.size(), [&](std::size_t i) { return photometric(E[i]); });
  add_field(to, "radiosity", B);
  add(to, "luminance", B.size(), [&](std::size_t i) { return luminance_of_radiosity(B[i]); });
  if (daylight_reference)
    add(to, "daylight_factor", E.size(), [&](std::size_t i) { return 100 * photometric(E[i]) / *daylight_reference; });
}

void add_layer(Arrays& to, const std::string& name, std::size_t layer, int channels, const Field& E, const Field& B) {
  const std::size_t first = layer * static_cast<std::size_t>(channels);
  const std::string irradiance = of_layer("irradiance", name);
  add_field(to, irradiance, E, first, channels);
  to[of_layer("illuminance", name)] = illuminance_of(to.at(irradiance));
  if (!B.value.empty()) add_field(to, of_layer("radiosity", name), B, first, channels);
}

template <class Of>
WrittenArray photometric_rows(const WrittenArray& from, const Of& of) {
  WrittenArray to;
  const auto n = static_cast<std::size_t>(from.components);
  to.value.reserve(from.value.size() / n);
  for (std::size_t i = 0; i < from.value.size(); i += n) {
    const float* c = from.value.data() + i;
    to.value.push_back(static_cast<float>(of(n == 1 ? Spectrum(c[0]) : Spectrum(c[0], c[1], c[2]))));
  }
  return to;
}

}  // namespace

WrittenArray illuminance_of(const WrittenArray& irradiance) { return photometric_rows(irradiance, photometric); }
WrittenArray luminance_of(const WrittenArray& radiosity) { return photometric_rows(radiosity, luminance_of_radiosity); }

WrittenResult as_written(const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution,
                         const SceneAround& around, const LayeredLight& layers) {
  WrittenResult r;
  for (const Vec3& p : lightmap.position) r.points.push_back(p + patches.origin);
  r.triangles = lightmap.corners;
  r.materials = patches.materials;
  r.surfaces = patches.surfaces;
  r.rooms = patches.rooms;
  r.around = around;

  const std::size_t n = patches.patch_count();
  add_light(r.of_cells, solution.E, solution.B, around.daylight_reference);
  if (!solution.std_error.value.empty()) add_field(r.of_cells, "irradiance_std_error", solution.std_error);
  add(r.of_cells, "area", n, [&](std::size_t i) { return patches.area[i]; });
  add(r.of_cells, "level", n, [&](std::size_t i) { return patches.level.empty() ? 0 : patches.level[i]; });
  for (std::size_t i = 0; i < n; ++i) {
    r.material.push_back(patches.material(PatchId{i}).value);
    r.surface.push_back(patches.surface(PatchId{i}).value);
  }
  r.room = patches.room;
  add_light(r.of_points, lightmap.E, radiosity_at_points(patches, lightmap, lightmap.E, patches.M),
            around.daylight_reference);
  if (!lightmap.std_error.value.empty()) add_field(r.of_points, "irradiance_std_error", lightmap.std_error);
  for (std::size_t s = 0; s < around.layers.size(); ++s) {
    const std::string& name = around.layers[s].name;
    add_layer(r.of_points, name, s, lightmap.E.channels, layers.E, layers.B);
    add_layer(r.of_cells, name, s, solution.E.channels, layers.E_elements, layers.B_elements);
  }
  return r;
}

}  // namespace clerestory
