#include "io/page/lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clerestory {
namespace {

constexpr double kOff = 0.01;          ///< how far a point may be from its place, of the lattice's distances
constexpr double kLeastAngle = 0.5;    ///< sine of it, between the two directions
constexpr std::size_t kMostEmpty = 8;  ///< places a point

PlanPoint minus(const PlanPoint& a, const PlanPoint& b) { return {a.x - b.x, a.y - b.y}; }
double cross(const PlanPoint& a, const PlanPoint& b) { return a.x * b.y - a.y * b.x; }
double size(const PlanPoint& a) { return std::hypot(a.x, a.y); }

/// The shortest way from `from` to another point, not along `along`; empty when there is none.
std::optional<PlanPoint> shortest(std::span<const PlanPoint> points, const PlanPoint& from,
                                  const std::optional<PlanPoint>& along) {
  std::optional<PlanPoint> best;
  for (const PlanPoint& p : points) {
    const PlanPoint d = minus(p, from);
    if (!(size(d) > 0) || (best && !(size(d) < size(*best) * (1 - 1e-9)))) continue;
    if (along && std::abs(cross(d, *along)) < kLeastAngle * size(d) * size(*along)) continue;
    best = d;
  }
  return best;
}

}  // namespace

std::optional<Lattice> lattice_of(std::span<const PlanPoint> points, std::span<const double> value) {
  if (points.size() < 4) return {};
  const PlanPoint from = points.front();
  auto u = shortest(points, from, {});
  if (!u) return {};
  auto v = shortest(points, from, u);
  if (!v) return {};
  // u is the one that is nearer to x, and neither points backwards.
  if (std::abs(v->x) * size(*u) > std::abs(u->x) * size(*v)) std::swap(u, v);
  if (u->x < 0) u = PlanPoint{-u->x, -u->y};
  if (cross(*u, *v) < 0) v = PlanPoint{-v->x, -v->y};
  const double area = cross(*u, *v);

  std::vector<std::pair<long, long>> at;
  long low_column = 0, high_column = 0, low_row = 0, high_row = 0;
  for (const PlanPoint& p : points) {
    const PlanPoint d = minus(p, from);
    const double column = cross(d, *v) / area, row = cross(*u, d) / area;
    if (!(std::abs(column) < 1e6 && std::abs(row) < 1e6)) return {};
    // What is rounded grows with the number of steps: coordinates of files have few digits.
    const double off = kOff * (1 + 0.05 * std::max(std::abs(column), std::abs(row)));
    if (std::abs(column - std::round(column)) > off || std::abs(row - std::round(row)) > off) return {};
    at.emplace_back(std::lround(column), std::lround(row));
    low_column = std::min(low_column, at.back().first), high_column = std::max(high_column, at.back().first);
    low_row = std::min(low_row, at.back().second), high_row = std::max(high_row, at.back().second);
  }
  Lattice lattice;
  lattice.u = *u, lattice.v = *v;
  lattice.columns = static_cast<std::size_t>(high_column - low_column) + 1;
  lattice.rows = static_cast<std::size_t>(high_row - low_row) + 1;
  if (lattice.columns < 2 || lattice.rows < 2 || lattice.columns * lattice.rows > kMostEmpty * points.size()) return {};
  lattice.origin = from;
  lattice.origin = lattice.place(static_cast<double>(low_column), static_cast<double>(low_row));
  lattice.value.assign(lattice.columns * lattice.rows, std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < points.size(); ++i) {
    double& place = lattice.value[static_cast<std::size_t>(at[i].second - low_row) * lattice.columns +
                                  static_cast<std::size_t>(at[i].first - low_column)];
    if (!std::isnan(place)) return {};  // one above another
    place = value[i];
  }
  return lattice;
}

}  // namespace clerestory
