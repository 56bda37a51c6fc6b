#pragma once
// Figures of a written result by room and by surface: what a table of them shows.

#include <cstdint>
#include <string>
#include <vector>

#include "solver/model/written_result.h"

namespace clerestory {

/// Of lit sides; light is linear on each triangle.
struct LitFigures {
  double area = 0;                 ///< [m2]
  double mean = 0;                 ///< by area [lx]
  double lowest = 0, highest = 0;  ///< [lx]

  /// These and other sides together.
  void add(const LitFigures& other);
};

struct SurfaceFigures {
  std::uint32_t surface = 0;
  LitFigures lit;
};

struct RoomFigures {
  std::string name;
  LitFigures lit;
  std::vector<SurfaceFigures> surfaces;  ///< largest first
};

/// One a room that has lit sides, in the result's order; where no rooms are known there is one, "scene".
std::vector<RoomFigures> figures_by_room(const WrittenResult& result);

/// Area [m2] of what carries each material: lit sides, of panes one of their two.
std::vector<double> areas_of_materials(const WrittenResult& result);

}  // namespace clerestory
