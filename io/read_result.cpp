#include "io/read_result.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include "io/input_file.h"
#include "io/text.h"
#include "solver/model/error.h"

namespace clerestory {
namespace {

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
    to.value.reserve(static_cast<std::size_t>(array->GetNumberOfValues()));
    for (vtkIdType k = 0; k < array->GetNumberOfTuples(); ++k)
      for (int c = 0; c < to.components; ++c) to.value.push_back(static_cast<float>(array->GetComponent(k, c)));
  }
  return all;
}

std::map<std::string, std::vector<std::string>> texts_of(vtkFieldData* data) {
  std::map<std::string, std::vector<std::string>> all;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(i)); array && array->GetName())
      for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k) all[array->GetName()].push_back(array->GetValue(k));
  return all;
}

/// VTK prints what it finds wrong unless it is told not to, and that for the whole process.
struct QuietVtk {
  QuietVtk() { vtkObject::GlobalWarningDisplayOff(); }
  ~QuietVtk() { vtkObject::SetGlobalWarningDisplay(before); }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;
  int before = vtkObject::GetGlobalWarningDisplay();
};

}  // namespace

WrittenResult read_result(const std::filesystem::path& file) {
  check_input_file(file, kMaxBytes);
  const QuietVtk quiet;
  vtkNew<vtkXMLPolyDataReader> reader;
  if (!reader->CanReadFile(file.c_str())) refuse(file, "is no VTK PolyData");
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0 || reader->GetOutput()->GetNumberOfCells() == 0)
    refuse(file, "is damaged, cut short or empty");

  vtkPolyData* data = reader->GetOutput();
  WrittenResult result;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    double p[3];
    data->GetPoint(i, p);
    result.points.push_back({p[0], p[1], p[2]});
  }
  vtkCellArray* cells = data->GetPolys();
  if (data->GetNumberOfCells() != cells->GetNumberOfCells()) refuse(file, "has other cells than triangles");
  for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i) {
    vtkIdType count = 0;
    const vtkIdType* corners = nullptr;
    cells->GetCellAtId(i, count, corners);
    if (count != 3) refuse(file, text("cell ", i, " has ", count, " corners and is no triangle"));
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] < 0 || corners[k] >= data->GetNumberOfPoints())
        refuse(file, text("cell ", i, " has a corner of number ", corners[k], ", and there are ",
                          data->GetNumberOfPoints(), " points"));
      triangle[k] = static_cast<std::uint32_t>(corners[k]);
    }
    result.triangles.push_back(triangle);
  }
  result.of_points = arrays_of(data->GetPointData());
  result.of_cells = arrays_of(data->GetCellData());
  result.texts = texts_of(data->GetFieldData());
  const auto lit = result.of_points.find("illuminance");
  if (lit == result.of_points.end() || lit->second.value.size() != result.points.size())
    refuse(file, "has no array 'illuminance' on its points");
  return result;
}

}  // namespace clerestory
