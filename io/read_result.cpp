#include "io/read_result.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "io/input_file.h"
#include "io/result_arrays.h"
#include "io/scene_file/nearest_name.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

constexpr double kFarthest = 1e13;  // [m] ten times what readers of models take
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{64} << 30;

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& why) {
  throw InputError(
      text(short_name(file), ": ", why, "; give a .vtp that clerestory solve wrote, or solve the scene again."));
}

std::map<std::string, WrittenArray> arrays_of(vtkFieldData* data) {
  std::map<std::string, WrittenArray> all;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (!array || !array->GetName()) continue;
    WrittenArray& to = all[array->GetName()];
    to.components = array->GetNumberOfComponents();
    const auto n = static_cast<std::size_t>(array->GetNumberOfValues());
    if (auto* floats = vtkFloatArray::SafeDownCast(array)) {
      to.value.assign(floats->GetPointer(0), floats->GetPointer(0) + n);
      continue;
    }
    to.value.reserve(n);
    for (vtkIdType k = 0; k < array->GetNumberOfTuples(); ++k)
      for (int c = 0; c < to.components; ++c) to.value.push_back(static_cast<float>(array->GetComponent(k, c)));
  }
  return all;
}

/// Field data: what is not on points or cells.
class Tables {
 public:
  Tables(vtkFieldData* data, const std::filesystem::path& file) : data_(data), file_(file) {}

  std::map<std::string, std::vector<std::string>> texts() const {
    std::map<std::string, std::vector<std::string>> all;
    for (int i = 0; i < data_->GetNumberOfArrays(); ++i)
      if (auto* array = vtkStringArray::SafeDownCast(data_->GetAbstractArray(i)); array && array->GetName())
        for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k) all[array->GetName()].push_back(array->GetValue(k));
    return all;
  }
  std::map<std::string, double> figures() const {
    std::map<std::string, double> all;
    for (int i = 0; i < data_->GetNumberOfArrays(); ++i)
      if (vtkDataArray* array = data_->GetArray(i); array && array->GetName() && array->GetNumberOfValues() == 1)
        all[array->GetName()] = array->GetComponent(0, 0);
    return all;
  }

  /// Those whose names begin so, by what follows.
  std::map<std::string, WrittenTable> named(const std::string& beginning) const {
    std::map<std::string, WrittenTable> all;
    for (int i = 0; i < data_->GetNumberOfArrays(); ++i) {
      vtkDataArray* array = data_->GetArray(i);
      if (!array || !array->GetName() || !std::string_view(array->GetName()).starts_with(beginning)) continue;
      const int n = array->GetNumberOfComponents();
      all[array->GetName() + beginning.size()] = {n, numbers(array->GetName(), n)};
    }
    return all;
  }

  bool has(const char* name) const { return data_->GetAbstractArray(name) != nullptr; }
  /// n rows (any number when it is not given) of so many numbers; none where there is no such array.
  std::vector<double> numbers(const char* name, int components, std::optional<std::size_t> n = {}) const {
    vtkDataArray* array = data_->GetArray(name);
    if (!array && n.value_or(0) == 0) return {};
    if (!array || array->GetNumberOfComponents() != components ||
        (n && static_cast<std::size_t>(array->GetNumberOfTuples()) != *n))
      refuse(file_, text("its table '", name, "' is missing or of another size than it has to be"));
    std::vector<double> value;
    for (vtkIdType k = 0; k < array->GetNumberOfTuples(); ++k)
      for (int c = 0; c < components; ++c) value.push_back(array->GetComponent(k, c));
    for (const double x : value)
      if (!std::isfinite(x)) refuse(file_, text("its table '", name, "' has a number that is none"));
    return value;
  }
  std::vector<Vec3> positions(const char* name, std::optional<std::size_t> n = {}) const {
    const std::vector<double> x = numbers(name, 3, n);
    std::vector<Vec3> p;
    for (std::size_t i = 0; i < x.size(); i += 3) p.push_back({x[i], x[i + 1], x[i + 2]});
    return p;
  }
  /// Whole numbers below `limit`.
  std::vector<std::uint32_t> indices(const char* name, std::size_t limit, std::optional<std::size_t> n = {}) const {
    return whole(name, numbers(name, 1, n), limit);
  }
  /// The same of an array of cells.
  template <class Number>
  std::vector<std::uint32_t> whole(const char* name, const std::vector<Number>& value, std::size_t limit) const {
    std::vector<std::uint32_t> index;
    index.reserve(value.size());
    for (const Number x : value) {
      if (!(x >= 0 && x < static_cast<Number>(limit)))
        refuse(file_, text("'", name, "' has the value ", x, ", and there are ", limit));
      index.push_back(static_cast<std::uint32_t>(x));
    }
    return index;
  }

 private:
  vtkFieldData* data_;
  const std::filesystem::path& file_;
};

/// Missing names are empty.
std::vector<std::string> names(const WrittenResult& result, const char* name, std::size_t n) {
  const auto at = result.texts.find(name);
  std::vector<std::string> all = at != result.texts.end() ? at->second : std::vector<std::string>();
  all.resize(n);
  return all;
}

std::vector<Material> materials_of(const Tables& tables, const WrittenResult& result,
                                   const std::filesystem::path& file) {
  const auto at = result.texts.find(arrays::kMaterialNames);
  if (at == result.texts.end()) refuse(file, text("has no table '", arrays::kMaterialNames, "'"));
  const std::size_t n = at->second.size();
  const std::vector<std::string> kinds = names(result, arrays::kMaterialKinds, n);
  const std::vector<double> rho = tables.numbers(arrays::kMaterialReflectance, 3, n),
                            tau = tables.numbers(arrays::kMaterialTransmittance, 3, n);
  const bool has_gloss = tables.has(arrays::kMaterialGloss);
  const std::vector<double> gloss = has_gloss ? tables.numbers(arrays::kMaterialGloss, 5, n) : std::vector<double>{};
  std::vector<Material> materials(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto kind = std::ranges::find(kMaterialKindNames, kinds[i]);
    if (kind == std::end(kMaterialKindNames)) refuse(file, text("has a material of the unknown kind '", kinds[i], "'"));
    materials[i].name = at->second[i];
    materials[i].kind = static_cast<MaterialKind>(kind - std::begin(kMaterialKindNames));
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
      if (!(rho[k] >= 0 && rho[k] <= 1 && tau[k] >= 0 && tau[k] <= 1))
        refuse(file, text("its material '", quotable(at->second[i]), "' reflects ", rho[k], " and passes ", tau[k],
                          " of the light, which is outside [0, 1]"));
    materials[i].reflectance = {rho[3 * i], rho[3 * i + 1], rho[3 * i + 2]};
    materials[i].transmittance = {tau[3 * i], tau[3 * i + 1], tau[3 * i + 2]};
    if (materials[i].kind != MaterialKind::glossy) continue;
    const bool is_lobe =
        has_gloss && std::all_of(&gloss[5 * i], &gloss[5 * i] + 3, [](double x) { return x >= 0 && x < 1; }) &&
        gloss[5 * i + 4] >= kLeastRoughness && gloss[5 * i + 4] <= 1 && gloss[5 * i + 3] <= kMostExponent;
    if (!is_lobe)
      refuse(file,
             text("its material '", quotable(at->second[i]), "' is glossy, and has no lobe that a surface can have"));
    materials[i].gloss = Gloss{{gloss[5 * i], gloss[5 * i + 1], gloss[5 * i + 2]}, {}, gloss[5 * i + 4]};
    if (gloss[5 * i + 3] >= 0) materials[i].gloss->exponent = gloss[5 * i + 3];
  }
  return materials;
}

/// layers  how many there are.
std::vector<MeasuredSensors> sensors_of(const Tables& tables, const WrittenResult& result, std::size_t layers) {
  const auto at = result.texts.find(arrays::kSensorSets);
  if (at == result.texts.end()) return {};
  const std::size_t n = at->second.size();
  std::vector<MeasuredSensors> sensors(n);
  const auto kinds = tables.indices(arrays::kSensorKinds, std::size(kSensorKindNames), n);
  const auto thresholds = tables.numbers(arrays::kSensorThresholds, 1, n);
  for (std::size_t i = 0; i < n; ++i) {
    sensors[i].set.name = at->second[i];
    sensors[i].set.kind = static_cast<SensorKind>(kinds[i]);
    if (thresholds[i] > 0) sensors[i].set.threshold = thresholds[i];
  }
  const auto set = tables.indices(arrays::kSensorSet, n);
  const auto position = tables.positions(arrays::kSensorPositions, set.size()),
             normal = tables.positions(arrays::kSensorNormals, set.size());
  const auto lux = tables.numbers(arrays::kSensorIlluminance, 1, set.size());
  const int lanes = static_cast<int>(layers) * result.channels();
  const auto of_layers = lanes > 0 ? tables.numbers(arrays::kSensorLayers, lanes, set.size()) : std::vector<double>();
  for (std::size_t i = 0; i < set.size(); ++i) {
    MeasuredSensors& to = sensors[set[i]];
    to.set.points.push_back({position[i], normal[i]});
    to.illuminance.push_back(lux[i]);
    const auto row = of_layers.begin() + static_cast<std::ptrdiff_t>(i) * lanes;
    to.layers.channels = std::max(1, lanes);
    to.layers.value.insert(to.layers.value.end(), row, row + lanes);
  }
  return sensors;
}

SkyTable sky_of(const Tables& tables, const std::string& name, int channels) {
  SkyTable sky;
  if (!tables.has(name.c_str())) return sky;
  sky.radiance.channels = channels;
  sky.radiance.value = tables.numbers(name.c_str(), channels, SkyTable::kRows * SkyTable::kColumns);
  return sky;
}

/// That points, or cells, have all light and that of each layer, in arrays that add up.
void require_layers(const std::map<std::string, WrittenArray>& of_what, const std::vector<std::string>& names,
                    int channels, const std::filesystem::path& file) {
  const auto require = [&](const std::string& name, int components) {
    const auto at = of_what.find(name);
    if (at == of_what.end() || at->second.components != components)
      refuse(file, text("has layers, and not on all points and cells an array '", quotable(name), "' of ", components,
                        components == 1 ? " component" : " components"));
  };
  require("irradiance", channels), require("radiosity", channels);
  for (const std::string& name : names) {
    require(of_layer("irradiance", name), channels), require(of_layer("illuminance", name), 1);
    if (const std::string radiosity = of_layer("radiosity", name); of_what.contains(radiosity))
      require(radiosity, channels);
  }
}

/// throws  InputError when a layer has no light of its own.
std::vector<ShownLayer> layers_of(const Tables& tables, const std::vector<std::string>& names,
                                  const WrittenResult& result, const std::filesystem::path& file) {
  const std::size_t n = names.size();
  for (const auto* of_what : {&result.of_points, &result.of_cells})
    if (n > 0) require_layers(*of_what, names, result.channels(), file);
  const auto energy = tables.numbers(arrays::kLayerEnergy, 3, n), factors = tables.numbers(arrays::kLayerFactors, 1, n);
  std::vector<ShownLayer> layers;
  for (std::size_t i = 0; i < n; ++i) {
    layers.push_back({names[i],
                      {energy[3 * i], energy[3 * i + 1], energy[3 * i + 2]},
                      sky_of(tables, of_layer(arrays::kSky, names[i]), result.channels()),
                      factors[i]});
  }
  return layers;
}

SceneAround around_of(const Tables& tables, const WrittenResult& result, const std::vector<std::string>& layers,
                      const std::filesystem::path& file) {
  SceneAround around;
  if (const auto lux = tables.numbers(arrays::kDaylightReference, 1); !lux.empty()) around.daylight_reference = lux[0];
  const auto corners = tables.positions(arrays::kPaneCorners);
  if (corners.size() % 3 != 0) refuse(file, text("its table '", arrays::kPaneCorners, "' is cut short"));
  const auto material = tables.indices(arrays::kPaneMaterial, result.materials.size(), corners.size() / 3),
             surface = tables.indices(arrays::kPaneSurface, result.surfaces.size(), corners.size() / 3);
  for (std::size_t i = 0; i < material.size(); ++i)
    around.panes.push_back({{corners[3 * i], corners[3 * i + 1], corners[3 * i + 2]}, material[i], surface[i]});
  around.sky = sky_of(tables, arrays::kSky, result.channels());
  if (const auto files = result.texts.find(arrays::kSceneFiles); files != result.texts.end())
    around.files = files->second;
  around.sensors = sensors_of(tables, result, layers.size());
  around.layers = layers_of(tables, layers, result, file);
  const auto at = tables.positions(arrays::kLuminairePositions);
  const auto flux = tables.numbers(arrays::kLuminaireFlux, 1, at.size());
  const auto name = names(result, arrays::kLuminaireNames, at.size()),
             group = names(result, arrays::kLuminaireGroups, at.size());
  for (std::size_t i = 0; i < at.size(); ++i) around.luminaires.push_back({at[i], name[i], group[i], flux[i]});
  return around;
}

/// VTK prints what it finds wrong unless it is told not to, and that for the whole process.
struct QuietVtk {
  QuietVtk() { vtkObject::GlobalWarningDisplayOff(); }
  ~QuietVtk() { vtkObject::SetGlobalWarningDisplay(before); }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;
  int before = vtkObject::GetGlobalWarningDisplay();
};

/// Takes the lines of that name out of the texts; none where there are none.
std::vector<std::string> take(std::map<std::string, std::vector<std::string>>& texts, const char* name) {
  const auto lines = texts.extract(name);
  return lines ? lines.mapped() : std::vector<std::string>();
}

void require_own_format(vtkPolyData* data, const WrittenResult& result, const std::filesystem::path& file) {
  if (!data->GetPointData()->HasArray("illuminance")) refuse(file, "has no array 'illuminance' on its points");
  const auto format = result.figures.find(arrays::kFormat);
  if (format != result.figures.end() && format->second == arrays::kFormatNumber) return;
  const auto version = result.texts.find("version");
  if (version == result.texts.end()) refuse(file, "was not written by clerestory solve");
  refuse(file, text("was written by Clerestory ", version->second.front(),
                    format == result.figures.end() ? ", before results held what is needed"
                                                   : ", which writes results otherwise than this one"));
}

std::vector<Vec3> points_of(vtkPolyData* data, const std::filesystem::path& file) {
  std::vector<Vec3> points(static_cast<std::size_t>(data->GetNumberOfPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    double p[3];
    data->GetPoint(static_cast<vtkIdType>(i), p);
    points[i] = {p[0], p[1], p[2]};
    for (const double x : p)
      if (!(std::abs(x) <= kFarthest))
        refuse(file, text("point ", i, " has the coordinate ", x, ", and all are within ", kFarthest, " m"));
  }
  return points;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(vtkPolyData* data, const std::filesystem::path& file) {
  vtkCellArray* cells = data->GetPolys();
  if (data->GetNumberOfCells() != cells->GetNumberOfCells()) refuse(file, "has other cells than triangles");
  std::vector<std::array<std::uint32_t, 3>> triangles(static_cast<std::size_t>(cells->GetNumberOfCells()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCellAtId(static_cast<vtkIdType>(i), count, corners);
    if (count != 3) refuse(file, text("cell ", i, " has ", count, " corners and is no triangle"));
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] < 0 || corners[k] >= data->GetNumberOfPoints())
        refuse(file, text("cell ", i, " has a corner of number ", corners[k], ", and there are ",
                          data->GetNumberOfPoints(), " points"));
      triangles[i][k] = static_cast<std::uint32_t>(corners[k]);
    }
  }
  return triangles;
}

void require_rows(const std::map<std::string, WrittenArray>& arrays, std::size_t n, const char* of_what,
                  const std::filesystem::path& file) {
  for (const auto& [name, array] : arrays)
    if (array.value.size() != static_cast<std::size_t>(array.components) * n)
      refuse(file, text("its array '", quotable(name), "' has another number of rows than there are ", of_what));
}

/// What every result has on its points, and that all of it is numbers.
void require_light(const std::map<std::string, WrittenArray>& of_points, const std::filesystem::path& file) {
  const auto components = [&](const char* name) {
    const auto at = of_points.find(name);
    if (at == of_points.end()) refuse(file, text("has no array '", name, "' on its points"));
    return at->second.components;
  };
  for (const char* name : {"illuminance", "luminance"})
    if (const int n = components(name); n != 1) refuse(file, text("its array '", name, "' has ", n, " components"));
  if (const int n = components("irradiance"); (n != 1 && n != 3) || components("radiosity") != n)
    refuse(file, text("its arrays 'irradiance' and 'radiosity' have ", n, " and ", components("radiosity"),
                      " components, and should have 1 or 3 alike"));
  for (const auto& [name, array] : of_points)
    if (!std::ranges::all_of(array.value, [](float value) { return std::isfinite(value); }))
      refuse(file, text("its array '", quotable(name), "' has a value that is no number"));
}

}  // namespace

WrittenResult read_result(const std::filesystem::path& file) {
  check_input_file(file, kMaxBytes);
  if (file.extension() == ".pvd") refuse(file, "is a series, which names the result of each time");
  const QuietVtk quiet;
  vtkNew<vtkXMLPolyDataReader> reader;
  if (!reader->CanReadFile(file.c_str())) refuse(file, "is no VTK PolyData");
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0 || reader->GetOutput()->GetNumberOfCells() == 0)
    refuse(file, "is damaged, cut short or empty");

  vtkPolyData* data = reader->GetOutput();
  const Tables tables(data->GetFieldData(), file);
  WrittenResult result;
  result.file = short_name(file);
  result.figures = tables.figures();
  result.texts = tables.texts();
  require_own_format(data, result, file);
  result.points = points_of(data, file);
  result.triangles = triangles_of(data, file);
  result.of_points = arrays_of(data->GetPointData());
  result.of_cells = arrays_of(data->GetCellData());
  require_rows(result.of_points, result.points.size(), "points", file);
  require_rows(result.of_cells, result.triangles.size(), "cells", file);
  require_light(result.of_points, file);

  result.materials = materials_of(tables, result, file);
  result.surfaces = take(result.texts, arrays::kSurfaceNames);
  result.rooms = take(result.texts, arrays::kRoomNames);
  const auto of_cells = [&](const char* name, std::size_t limit) {
    const auto at = result.of_cells.find(name);
    if (at == result.of_cells.end()) refuse(file, text("has no array '", name, "' on its cells"));
    return tables.whole(name, at->second.value, limit);
  };
  result.material = of_cells("material", result.materials.size());
  result.surface = of_cells("surface", result.surfaces.size());
  if (result.of_cells.contains("room")) result.room = of_cells("room", result.rooms.size());
  result.around = around_of(tables, result, take(result.texts, arrays::kLayerNames), file);
  for (const std::string& report : take(result.texts, arrays::kReport)) result.report = report;
  for (const std::string& part : take(result.texts, arrays::kYearPart)) result.year_part = part;
  if (!result.year_part.empty()) result.year_tables = tables.named(arrays::kYearTables);
  return result;
}

const WrittenArray& array_of_points(const WrittenResult& result, const std::string& name) {
  if (const auto at = result.of_points.find(name); at != result.of_points.end()) return at->second;
  std::vector<std::string_view> known;
  for (const auto& [other, array] : result.of_points) known.push_back(other);
  const std::string near = suggestion(name, known);
  throw InputError(text(result.file, ": there is no array '", name, "'; ", near, near.ends_with('?') ? "" : "."));
}

}  // namespace clerestory
