#include "io/write_debug.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPolyData.h>

#include "io/atomic_file.h"
#include "io/output_folder.h"
#include "io/vtp_file.h"

namespace clerestory {
namespace {

template <std::size_t Corners>
void write_shapes(AtomicFile& file, const DebugShapes<Corners>& all, const Vec3& origin) {
  vtkNew<vtkPolyData> data;
  std::vector<Vec3> points;
  vtkNew<vtkCellArray> cells;
  for (const auto& shape : all.shapes) {
    cells->InsertNextCell(static_cast<int>(Corners));
    for (const Vec3& x : shape) {
      cells->InsertCellPoint(id(points.size()));
      points.push_back(x);
    }
  }
  set_points(data, points, origin);
  if constexpr (Corners == 2)
    data->SetLines(cells);
  else
    data->SetPolys(cells);
  for (const auto& [name, value] : all.values)
    add_values(data->GetCellData(), name.c_str(), value.size(), [&](std::size_t i) { return value[i]; });
  if (!all.values.empty()) data->GetCellData()->SetActiveScalars(all.values.front().first.c_str());
  write_vtp(file, data);
}

}  // namespace

std::array<std::filesystem::path, 4> debug_files(const std::filesystem::path& folder) {
  return {folder / "hierarchy.vtp", folder / "links.vtp", folder / "rays.vtp", folder / "error.vtp"};
}

void check_debug_folder(const std::filesystem::path& folder) {
  make_folder(folder);
  for (const auto& file : debug_files(folder)) check_writable(file);
}

void write_debug(Outputs& outputs, const std::filesystem::path& folder, const HierarchyDebug& debug,
                 const Vec3& origin) {
  const auto [hierarchy, links, rays, error] = debug_files(folder);
  write_shapes(outputs.open(hierarchy), debug.hierarchy, origin);
  write_shapes(outputs.open(links), debug.links, origin);
  write_shapes(outputs.open(rays), debug.rays, origin);
  write_shapes(outputs.open(error), debug.error, origin);
}

}  // namespace clerestory
