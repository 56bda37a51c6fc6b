#pragma once
// Cells of a drawn plane and the sheets they show. Include from .cpp files only: it brings CGAL.

#include "meshing/overlaps.h"
#include "meshing/planar_triangulation.h"

namespace clerestory {

struct Cells {
  std::vector<Sheet> sheets;    ///< by mark
  std::size_t count = 0;        ///< of cells that show a sheet
  std::size_t overlapping = 0;  ///< of them, covered by more than one face
};

/// Marks the faces of a drawn plane with the sheet they show, kOutside where there is none.
inline Cells mark_sheets(Cdt& cdt, const Covering& covering) {
  Cells cells;
  mark_cells(cdt, [&](Cdt::Face_handle f) {
    // The centre of the inscribed circle is as deep in the cell as this face tells.
    std::array<Point2, 3> p;
    std::array<double, 3> opposite;
    for (int k = 0; k < 3; ++k) p[static_cast<std::size_t>(k)] = {f->vertex(k)->point().x(), f->vertex(k)->point().y()};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 a = p[(k + 1) % 3], b = p[(k + 2) % 3];
      opposite[k] = std::hypot(b.x - a.x, b.y - a.y);
    }
    const double around = opposite[0] + opposite[1] + opposite[2];
    Point2 centre;
    for (std::size_t k = 0; k < 3; ++k) {
      centre.x += p[k].x * opposite[k] / around;
      centre.y += p[k].y * opposite[k] / around;
    }
    const auto found = covering.at(centre, 2 * cdt.triangle(f).area() / around);
    if (!found) return kOutside;
    ++cells.count;
    if (found->faces > 1) ++cells.overlapping;
    const auto known = std::find(cells.sheets.begin(), cells.sheets.end(), found->sheet);
    if (known != cells.sheets.end()) return static_cast<int>(known - cells.sheets.begin());
    cells.sheets.push_back(found->sheet);
    return static_cast<int>(cells.sheets.size()) - 1;
  });
  return cells;
}

}  // namespace clerestory
