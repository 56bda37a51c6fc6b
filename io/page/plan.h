#pragma once
// A plan in false colour, with lines of equal illuminance, as SVG.

#include <optional>
#include <string>
#include <vector>

#include "io/page/lattice.h"

namespace clerestory {

using PlanLine = std::vector<PlanPoint>;

/// In metres; what lies outside of the frame is cut off.
struct Plan {
  struct Dot {
    PlanPoint at;
    double lux = 0;
  };
  struct Isolux {
    double lux = 0;
    PlanLine line;
  };
  struct Mark {
    PlanPoint at;
    std::string name;
  };
  std::string title;               ///< for those who cannot see it
  PlanPoint low, high;             ///< corners of the frame
  std::optional<Lattice> lattice;  ///< a cell each
  std::vector<Dot> dots;           ///< of points that are no lattice
  std::vector<Isolux> isolux;
  std::vector<PlanLine> walls, panes;
  std::vector<Mark> luminaires;
  double lowest = 0, highest = 1;  ///< of the colours [lx]
  bool by_logarithm = false;
  std::optional<double> target;  ///< its line is drawn stronger [lx]
  /// Light of each layer at all places of the lattice, or at all dots, one layer after the other [lx]; a page with it
  /// draws the plan anew while layers are dimmed. Empty: it has none.
  std::vector<float> layers;
};

/// Levels of isolux lines between two illuminances: those that standards name (20, 30, 50, 75, 100 ...), at most 8;
/// even steps where that were less than 3.
std::vector<double> isolux_levels(double lowest, double highest);

/// The lines of a lattice, linear on triangles.
std::vector<Plan::Isolux> isolux_lines(const Lattice& lattice, const std::vector<double>& levels);

/// An element for a page. `number` is one that no other plan of the page has.
std::string svg_of(const Plan& plan, std::size_t number);

}  // namespace clerestory
