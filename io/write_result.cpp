#include "io/write_result.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkTypeInt64Array.h>

#include "io/as_written.h"
#include "io/result_arrays.h"
#include "io/vtp_file.h"

namespace clerestory {
namespace {

/// The numbers stay where they are, and must outlive the data.
void add_array(vtkFieldData* to, const std::string& name, const WrittenArray& from) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(from.components);
  array->SetArray(const_cast<float*>(from.value.data()), id(from.value.size()), 1);  // NOLINT: VTK only reads it
  to->AddArray(array);
}

/// What cells and points have in common: first in the file, in this order.
void add_light(vtkFieldData* to, const std::map<std::string, WrittenArray>& from) {
  for (const char* name :
       {"irradiance", "illuminance", "radiosity", "luminance", "daylight_factor", "irradiance_std_error"})
    if (const auto at = from.find(name); at != from.end()) add_array(to, name, at->second);
}
/// What is not there yet.
void add_rest(vtkFieldData* to, const std::map<std::string, WrittenArray>& from) {
  for (const auto& [name, array] : from)
    if (!to->HasArray(name.c_str())) add_array(to, name, array);
}

template <class Value>
void add_indices(vtkFieldData* to, const char* name, std::size_t n, const Value& value) {
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(id(n));
  for (std::size_t i = 0; i < n; ++i) array->SetValue(id(i), static_cast<int>(value(i)));
  to->AddArray(array);
}

void add_names(vtkFieldData* to, const char* name, std::size_t n, const auto& value) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (std::size_t i = 0; i < n; ++i) array->InsertNextValue(value(i));
  to->AddArray(array);
}

void add_figure(vtkFieldData* to, const Figure& figure) {
  const auto add = [&](auto array, auto value) {
    array->SetName(figure.name.c_str());
    array->InsertNextValue(value);
    to->AddArray(array);
  };
  if (const auto* text = std::get_if<std::string>(&figure.value)) add(vtkNew<vtkStringArray>().Get(), text->c_str());
  if (const auto* real = std::get_if<double>(&figure.value)) add(vtkNew<vtkDoubleArray>().Get(), *real);
  if (const auto* whole = std::get_if<long long>(&figure.value)) add(vtkNew<vtkTypeInt64Array>().Get(), *whole);
  if (const auto* flag = std::get_if<bool>(&figure.value)) add(vtkNew<vtkIntArray>().Get(), *flag ? 1 : 0);
}

void add_field_data(vtkPolyData* data, const std::vector<Material>& materials, const std::vector<std::string>& rooms,
                    const std::vector<std::string>& surfaces, const RunReport& report) {
  vtkFieldData* to = data->GetFieldData();
  for (const Figure& figure : repeatable_figures(report)) add_figure(to, figure);
  add_names(to, arrays::kMaterialNames, materials.size(), [&](std::size_t i) { return materials[i].name; });
  if (!rooms.empty()) add_names(to, arrays::kRoomNames, rooms.size(), [&](std::size_t i) { return rooms[i]; });
  add_names(to, arrays::kSurfaceNames, surfaces.size(), [&](std::size_t i) { return surfaces[i]; });
}

/// n tuples of numbers, value(i, c) each.
template <class Value>
void add_numbers(vtkFieldData* to, const char* name, std::size_t n, int components, const Value& value) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(id(n));
  for (std::size_t i = 0; i < n; ++i)
    for (int c = 0; c < components; ++c) array->SetComponent(id(i), c, value(i, c));
  to->AddArray(array);
}

template <class Position>
void add_positions(vtkFieldData* to, const char* name, std::size_t n, const Position& position) {
  add_numbers(to, name, n, 3, [&](std::size_t i, int c) {
    const Vec3 p = position(i);
    return c == 0 ? p.x : c == 1 ? p.y : p.z;
  });
}

void add_materials(vtkFieldData* to, const std::vector<Material>& materials) {
  const std::size_t n = materials.size();
  add_names(to, arrays::kMaterialKinds, n,
            [&](std::size_t i) { return kMaterialKindNames[static_cast<std::size_t>(materials[i].kind)].data(); });
  add_numbers(to, arrays::kMaterialReflectance, n, 3,
              [&](std::size_t i, int c) { return materials[i].reflectance[c]; });
  add_numbers(to, arrays::kMaterialTransmittance, n, 3,
              [&](std::size_t i, int c) { return materials[i].transmittance[c]; });
  if (std::ranges::none_of(materials, &Material::is_glossy)) return;
  add_numbers(to, arrays::kMaterialGloss, n, 5, [&](std::size_t i, int c) {
    const Gloss gloss = materials[i].gloss.value_or(Gloss{});
    return c < 3 ? gloss.specular[c] : c == 3 ? gloss.exponent.value_or(-1) : gloss.roughness;
  });
}

void add_panes(vtkFieldData* to, const std::vector<PaneTriangle>& panes) {
  if (panes.empty()) return;
  add_positions(to, arrays::kPaneCorners, 3 * panes.size(), [&](std::size_t i) { return panes[i / 3].corners[i % 3]; });
  add_indices(to, arrays::kPaneMaterial, panes.size(), [&](std::size_t i) { return panes[i].material; });
  add_indices(to, arrays::kPaneSurface, panes.size(), [&](std::size_t i) { return panes[i].surface; });
}

void add_sensors(vtkFieldData* to, const std::vector<MeasuredSensors>& sensors) {
  if (sensors.empty()) return;
  std::vector<std::size_t> set_of;
  std::vector<SensorPoint> points;
  std::vector<double> lux;
  for (const MeasuredSensors& s : sensors) {
    set_of.insert(set_of.end(), s.set.points.size(), static_cast<std::size_t>(&s - sensors.data()));
    points.insert(points.end(), s.set.points.begin(), s.set.points.end());
    lux.insert(lux.end(), s.illuminance.begin(), s.illuminance.end());
  }
  const std::size_t n = sensors.size();
  add_names(to, arrays::kSensorSets, n, [&](std::size_t i) { return sensors[i].set.name; });
  add_indices(to, arrays::kSensorKinds, n, [&](std::size_t i) { return static_cast<int>(sensors[i].set.kind); });
  add_numbers(to, arrays::kSensorThresholds, n, 1,
              [&](std::size_t i, int) { return sensors[i].set.threshold.value_or(0); });
  add_indices(to, arrays::kSensorSet, points.size(), [&](std::size_t i) { return set_of[i]; });
  add_positions(to, arrays::kSensorPositions, points.size(), [&](std::size_t i) { return points[i].position; });
  add_positions(to, arrays::kSensorNormals, points.size(), [&](std::size_t i) { return points[i].normal; });
  add_numbers(to, arrays::kSensorIlluminance, points.size(), 1, [&](std::size_t i, int) { return lux[i]; });
  const int lanes = sensors.front().layers.channels;
  if (sensors.front().layers.value.empty()) return;
  std::vector<double> of_layers;
  for (const MeasuredSensors& s : sensors)
    of_layers.insert(of_layers.end(), s.layers.value.begin(), s.layers.value.end());
  add_numbers(to, arrays::kSensorLayers, points.size(), lanes, [&](std::size_t i, int c) {
    return of_layers[i * static_cast<std::size_t>(lanes) + static_cast<std::size_t>(c)];
  });
}

void add_luminaires(vtkFieldData* to, const std::vector<ShownLuminaire>& luminaires) {
  const std::size_t n = luminaires.size();
  if (n == 0) return;
  add_positions(to, arrays::kLuminairePositions, n, [&](std::size_t i) { return luminaires[i].position; });
  add_numbers(to, arrays::kLuminaireFlux, n, 1, [&](std::size_t i, int) { return luminaires[i].luminous_flux; });
  add_names(to, arrays::kLuminaireNames, n, [&](std::size_t i) { return luminaires[i].name; });
  add_names(to, arrays::kLuminaireGroups, n, [&](std::size_t i) { return luminaires[i].group; });
}

void add_sky(vtkFieldData* to, const std::string& name, const SkyTable& sky) {
  if (sky.empty()) return;
  const Field& L = sky.radiance;
  vtkNew<vtkFloatArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(L.channels);
  array->SetNumberOfTuples(id(L.size()));
  for (std::size_t k = 0; k < L.value.size(); ++k) array->SetValue(id(k), to_float(L.value[k], name.c_str(), k));
  to->AddArray(array);
}

void add_layers(vtkFieldData* to, const std::vector<ShownLayer>& layers) {
  const std::size_t n = layers.size();
  if (n == 0) return;
  add_names(to, arrays::kLayerNames, n, [&](std::size_t i) { return layers[i].name; });
  add_numbers(to, arrays::kLayerEnergy, n, 3, [&](std::size_t i, int c) {
    const EnergyBalance& e = layers[i].energy;
    return c == 0 ? e.emitted : c == 1 ? e.absorbed : e.escaped;
  });
  add_numbers(to, arrays::kLayerFlux, n, 1, [&](std::size_t i, int) { return layers[i].luminous_flux(); });
  add_numbers(to, arrays::kLayerFactors, n, 1, [&](std::size_t i, int) { return layers[i].factor; });
  for (const ShownLayer& layer : layers) add_sky(to, of_layer(arrays::kSky, layer.name), layer.sky);
}

void add_around(vtkFieldData* to, const std::vector<Material>& materials, const SceneAround& around,
                const RunReport& report) {
  add_indices(to, arrays::kFormat, 1, [](std::size_t) { return arrays::kFormatNumber; });
  add_names(to, arrays::kReport, 1, [&](std::size_t) { return repeatable_text(report); });
  if (!around.files.empty())
    add_names(to, arrays::kSceneFiles, around.files.size(), [&](std::size_t i) { return around.files[i]; });
  add_materials(to, materials);
  add_panes(to, around.panes);
  add_sky(to, arrays::kSky, around.sky);
  if (around.daylight_reference)
    add_numbers(to, arrays::kDaylightReference, 1, 1, [&](std::size_t, int) { return *around.daylight_reference; });
  add_sensors(to, around.sensors);
  add_layers(to, around.layers);
  add_luminaires(to, around.luminaires);
}

void add_year_part(vtkFieldData* to, const WrittenResult& result) {
  if (result.year_part.empty()) return;
  add_names(to, arrays::kYearPart, 1, [&](std::size_t) { return result.year_part; });
  for (const auto& [name, table] : result.year_tables) {
    const auto n = static_cast<std::size_t>(table.components);
    add_numbers(to, (arrays::kYearTables + name).c_str(), table.value.size() / n, table.components,
                [&](std::size_t i, int c) { return table.value[i * n + static_cast<std::size_t>(c)]; });
  }
}

void add_indices_of_patches(vtkFieldData* to, const PatchSet& patches) {
  const std::size_t n = patches.patch_count();
  add_indices(to, "material", n, [&](std::size_t i) { return patches.material(PatchId{i}).value; });
  add_indices(to, "surface", n, [&](std::size_t i) { return patches.surface(PatchId{i}).value; });
  add_values(to, "area", n, [&](std::size_t i) { return patches.area[i]; });
}

void add_triangle(vtkCellArray* cells, std::size_t a, std::size_t b, std::size_t c) {
  const vtkIdType corners[3] = {id(a), id(b), id(c)};
  cells->InsertNextCell(3, corners);
}

struct Quality {
  double min_angle_deg, aspect, longest_edge;
};

Quality quality(const std::array<Vec3, 3>& p, double area) {
  const double a = length(p[1] - p[2]), b = length(p[2] - p[0]), c = length(p[0] - p[1]);
  const double longest = std::max({a, b, c}), shortest = std::min({a, b, c}), middle = a + b + c - longest - shortest;
  // The smallest angle lies between the two longer edges: sin = 2 A / (product of those).
  const double sine = std::min(1.0, 2 * area / (longest * middle));
  return {std::asin(sine) * 180 / std::numbers::pi, longest * longest / (2 * area), longest};
}

}  // namespace

void write_result(AtomicFile& file, const WrittenResult& result, const RunReport& report) {
  vtkNew<vtkPolyData> data;
  set_points(data, result.points, {});
  vtkNew<vtkCellArray> cells;
  for (const auto& c : result.triangles) add_triangle(cells, c[0], c[1], c[2]);
  data->SetPolys(cells);

  const auto add_index = [&](const char* name, const auto& index) {
    if (!index.empty()) add_indices(data->GetCellData(), name, index.size(), [&](std::size_t i) { return index[i]; });
  };
  add_light(data->GetCellData(), result.of_cells);
  add_index("material", result.material);
  add_index("surface", result.surface);
  add_index("room", result.room);
  add_index("level", result.of_cells.at("level").value);
  add_rest(data->GetCellData(), result.of_cells);
  add_light(data->GetPointData(), result.of_points);
  add_rest(data->GetPointData(), result.of_points);
  add_field_data(data, result.materials, result.rooms, result.surfaces, report);
  add_around(data->GetFieldData(), result.materials, result.around, report);
  add_year_part(data->GetFieldData(), result);
  data->GetCellData()->SetActiveScalars("illuminance");
  data->GetPointData()->SetActiveScalars("illuminance");
  write_vtp(file, data, result.around.layers.empty() ? Packing::zlib : Packing::plain);
}

void write_result(AtomicFile& file, const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution,
                  const SceneAround& around, const RunReport& report, const LayeredLight& layers) {
  write_result(file, as_written(patches, lightmap, solution, around, layers), report);
}

void write_result(const std::filesystem::path& file, const PatchSet& patches, const VertexLightmap& lightmap,
                  const Solution& solution, const SceneAround& around, const RunReport& report) {
  AtomicFile whole(file);
  write_result(whole, patches, lightmap, solution, around, report);
  whole.commit();
}

void write_patches(AtomicFile& file, const PatchSet& patches, const RunReport& report) {
  vtkNew<vtkPolyData> data;
  set_points(data, patches.vertices, patches.origin);
  vtkNew<vtkCellArray> cells;
  const std::size_t n = patches.patch_count();
  for (std::size_t i = 0; i < n; ++i) {
    const auto& c = patches.corners[patches.triangle[i]];
    const bool front = patches.side[i] == kFront;
    add_triangle(cells, c[0], front ? c[1] : c[2], front ? c[2] : c[1]);
  }
  data->SetPolys(cells);

  vtkCellData* to = data->GetCellData();
  const auto of_patch = [&](std::size_t i) { return quality(patches.corner_positions(PatchId{i}), patches.area[i]); };
  add_values(to, "min_angle", n, [&](std::size_t i) { return of_patch(i).min_angle_deg; });
  add_values(to, "aspect", n, [&](std::size_t i) { return of_patch(i).aspect; });
  add_values(to, "longest_edge", n, [&](std::size_t i) { return of_patch(i).longest_edge; });
  add_indices_of_patches(to, patches);
  add_field_data(data, patches.materials, patches.rooms, patches.surfaces, report);
  to->SetActiveScalars("min_angle");
  write_vtp(file, data);
}

void write_patches(const std::filesystem::path& file, const PatchSet& patches, const RunReport& report) {
  AtomicFile whole(file);
  write_patches(whole, patches, report);
  whole.commit();
}

}  // namespace clerestory
