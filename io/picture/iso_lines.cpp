#include "io/picture/iso_lines.h"

#include <vtkCellArray.h>
#include <vtkContourFilter.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStripper.h>

#include "io/vtp_file.h"

namespace clerestory {

std::vector<IsoLine> iso_lines(std::span<const Vec3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                               std::span<const float> value, std::span<const double> levels) {
  vtkNew<vtkPolyData> surface;
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const Vec3& p : points) places->InsertNextPoint(p.x, p.y, p.z);
  vtkNew<vtkCellArray> cells;
  for (const auto& t : triangles) {
    const vtkIdType corners[3] = {t[0], t[1], t[2]};
    cells->InsertNextCell(3, corners);
  }
  vtkNew<vtkFloatArray> values;
  values->SetName("value");
  for (const float v : value) values->InsertNextValue(v);
  surface->SetPoints(places);
  surface->SetPolys(cells);
  surface->GetPointData()->SetScalars(values);

  std::vector<IsoLine> lines;
  for (const double level : levels) {  // one after another: a line knows its level
    vtkNew<vtkContourFilter> contour;
    contour->SetInputData(surface);
    contour->SetNumberOfContours(1);
    contour->SetValue(0, level);
    vtkNew<vtkStripper> joined;
    joined->SetInputConnection(contour->GetOutputPort());
    joined->JoinContiguousSegmentsOn();
    joined->SetMaximumLength(1 << 20);
    joined->Update();
    vtkPolyData* found = joined->GetOutput();
    vtkCellArray* strips = found->GetLines();
    for (vtkIdType i = 0; i < strips->GetNumberOfCells(); ++i) {
      vtkIdType n = 0;
      const vtkIdType* on_line = nullptr;
      strips->GetCellAtId(i, n, on_line);
      if (n < 2) continue;
      IsoLine& line = lines.emplace_back();
      line.level = level;
      for (vtkIdType k = 0; k < n; ++k) {
        double p[3];
        found->GetPoint(on_line[k], p);
        line.points.push_back({p[0], p[1], p[2]});
      }
    }
  }
  return lines;
}

}  // namespace clerestory
