#include "tests/support/result_file.h"

#include <stdexcept>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

namespace clerestory {
namespace {

std::map<std::string, ResultArray> numbers_of(vtkFieldData* data) {
  std::map<std::string, ResultArray> all;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i) {
    vtkDataArray* array = data->GetArray(i);
    if (!array) continue;
    ResultArray& to = all[array->GetName()];
    to.components = array->GetNumberOfComponents();
    for (vtkIdType k = 0; k < array->GetNumberOfTuples(); ++k)
      for (int c = 0; c < to.components; ++c) to.values.push_back(array->GetComponent(k, c));
  }
  return all;
}

std::map<std::string, std::vector<std::string>> texts_of(vtkFieldData* data) {
  std::map<std::string, std::vector<std::string>> all;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (auto* array = vtkStringArray::SafeDownCast(data->GetAbstractArray(i)))
      for (vtkIdType k = 0; k < array->GetNumberOfValues(); ++k) all[array->GetName()].push_back(array->GetValue(k));
  return all;
}

}  // namespace

ResultFile read_result(const std::string& file) {
  vtkNew<vtkXMLPolyDataReader> reader;
  if (!reader->CanReadFile(file.c_str())) throw std::runtime_error(file + ": VTK does not read it");
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetErrorCode() != 0) throw std::runtime_error(file + ": VTK finds it damaged");
  vtkPolyData* data = reader->GetOutput();
  ResultFile result;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    double p[3];
    data->GetPoint(i, p);
    result.points.push_back({p[0], p[1], p[2]});
  }
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) {
    data->GetCellPoints(i, corners);
    const auto corner = [&](vtkIdType k) { return static_cast<std::size_t>(corners->GetId(k)); };
    if (corners->GetNumberOfIds() == 2) {
      result.lines.push_back({corner(0), corner(1)});
      continue;
    }
    if (corners->GetNumberOfIds() != 3) throw std::runtime_error(file + ": a cell is neither a triangle nor a line");
    result.triangles.push_back({corner(0), corner(1), corner(2)});
  }
  result.of_cells = numbers_of(data->GetCellData());
  result.of_points = numbers_of(data->GetPointData());
  result.numbers = numbers_of(data->GetFieldData());
  result.texts = texts_of(data->GetFieldData());
  return result;
}

}  // namespace clerestory
