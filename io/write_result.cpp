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

#include "io/vtp_file.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

void add_field(vtkFieldData* to, const char* name, const Field& field) {
  vtkNew<vtkFloatArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(field.channels);
  array->SetNumberOfTuples(id(field.size()));
  for (std::size_t i = 0; i < field.value.size(); ++i) array->SetValue(id(i), to_float(field.value[i], name, i));
  to->AddArray(array);
}

template <class Value>
void add_indices(vtkFieldData* to, const char* name, std::size_t n, const Value& value) {
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  array->SetNumberOfTuples(id(n));
  for (std::size_t i = 0; i < n; ++i) array->SetValue(id(i), static_cast<int>(value(i)));
  to->AddArray(array);
}

/// The arrays that cells and points have in common.
void add_light(vtkFieldData* to, const Field& E, const Field& B, std::optional<double> daylight_reference) {
  add_field(to, "irradiance", E);
  add_values(to, "illuminance", E.size(), [&](std::size_t i) { return photometric(E[i]); });
  add_field(to, "radiosity", B);
  add_values(to, "luminance", B.size(), [&](std::size_t i) { return luminance_of_radiosity(B[i]); });
  if (daylight_reference)
    add_values(to, "daylight_factor", E.size(),
               [&](std::size_t i) { return 100 * photometric(E[i]) / *daylight_reference; });
}

/// Irradiance behind a diffuser's patch p at x, linear between the points of the patch that lies there.
Spectrum irradiance_behind(const PatchSet& patches, const VertexLightmap& lightmap, std::size_t p, const Vec3& x) {
  Spectrum E(0.0);
  double best = -1e300;
  for (const PatchSet::Behind& other : patches.patches_behind(p)) {
    const auto c = patches.corner_positions(other.patch);
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    const double v = dot(cross(c[2] - x, c[0] - x), n) / dot(n, n), w = dot(cross(c[0] - x, c[1] - x), n) / dot(n, n);
    const double inside = std::min({1 - v - w, v, w});
    if (!(inside > best)) continue;
    best = inside;
    const auto& point = lightmap.corners[other.patch];
    E = lightmap.E[point[0]] * (1 - v - w) + lightmap.E[point[1]] * v + lightmap.E[point[2]] * w;
  }
  return E;
}

Field radiosity_at_points(const PatchSet& patches, const VertexLightmap& lightmap) {
  Field B(lightmap.position.size(), lightmap.E.channels);
  for (std::size_t i = 0; i < B.size(); ++i) {
    const std::size_t p = lightmap.patch_of_point[i];
    B.set(i, patches.M[p] + patches.rho[p] * lightmap.E[i]);
    if (!patches.patches_behind(p).empty())
      B.add(i, patches.tau[p] * irradiance_behind(patches, lightmap, p, lightmap.position[i]));
  }
  return B;
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

void add_field_data(vtkPolyData* data, const PatchSet& patches, const RunReport& report) {
  vtkFieldData* to = data->GetFieldData();
  for (const Figure& figure : repeatable_figures(report)) add_figure(to, figure);
  add_names(to, "material_names", patches.materials.size(), [&](std::size_t i) { return patches.materials[i].name; });
  if (!patches.rooms.empty())
    add_names(to, "room_names", patches.rooms.size(), [&](std::size_t i) { return patches.rooms[i]; });
  add_names(to, "surface_names", patches.surfaces.size(), [&](std::size_t i) { return patches.surfaces[i]; });
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

void write_result(AtomicFile& file, const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution,
                  std::optional<double> daylight_reference, const RunReport& report) {
  vtkNew<vtkPolyData> data;
  set_points(data, lightmap.position, patches.origin);
  vtkNew<vtkCellArray> cells;
  for (const auto& c : lightmap.corners) add_triangle(cells, c[0], c[1], c[2]);
  data->SetPolys(cells);

  add_light(data->GetCellData(), solution.E, solution.B, daylight_reference);
  if (!solution.std_error.value.empty()) add_field(data->GetCellData(), "irradiance_std_error", solution.std_error);
  add_indices_of_patches(data->GetCellData(), patches);
  if (!patches.room.empty())
    add_indices(data->GetCellData(), "room", patches.patch_count(), [&](std::size_t i) { return patches.room[i]; });
  add_indices(data->GetCellData(), "level", patches.patch_count(),
              [&](std::size_t i) { return patches.level.empty() ? 0 : patches.level[i]; });
  add_light(data->GetPointData(), lightmap.E, radiosity_at_points(patches, lightmap), daylight_reference);
  if (!lightmap.std_error.value.empty()) add_field(data->GetPointData(), "irradiance_std_error", lightmap.std_error);
  add_field_data(data, patches, report);
  data->GetCellData()->SetActiveScalars("illuminance");
  data->GetPointData()->SetActiveScalars("illuminance");
  write_vtp(file, data);
}

void write_result(const std::filesystem::path& file, const PatchSet& patches, const VertexLightmap& lightmap,
                  const Solution& solution, std::optional<double> daylight_reference, const RunReport& report) {
  AtomicFile whole(file);
  write_result(whole, patches, lightmap, solution, daylight_reference, report);
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
  add_field_data(data, patches, report);
  to->SetActiveScalars("min_angle");
  write_vtp(file, data);
}

void write_patches(const std::filesystem::path& file, const PatchSet& patches, const RunReport& report) {
  AtomicFile whole(file);
  write_patches(whole, patches, report);
  whole.commit();
}

}  // namespace clerestory
