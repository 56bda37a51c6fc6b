#include "meshing/atlas/smallest_rectangle.h"

#include <algorithm>
#include <cmath>

namespace clerestory {
namespace {

using Point = std::array<double, 2>;

double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Counter-clockwise, by Andrew's monotone chains.
std::vector<Point> convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  std::vector<Point> hull;
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t start = hull.size();
    for (const Point& p : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

TurnedRectangle around(const std::vector<Point>& points, const Point& axis) {
  TurnedRectangle r{.axis = axis, .low = {1e300, 1e300}, .high = {-1e300, -1e300}};
  for (const Point& p : points) {
    const Point at = {p[0] * axis[0] + p[1] * axis[1], p[1] * axis[0] - p[0] * axis[1]};
    for (std::size_t k = 0; k < 2; ++k) r.low[k] = std::min(r.low[k], at[k]), r.high[k] = std::max(r.high[k], at[k]);
  }
  return r;
}

double area(const TurnedRectangle& r) { return (r.high[0] - r.low[0]) * (r.high[1] - r.low[1]); }

}  // namespace

TurnedRectangle smallest_rectangle(std::vector<std::array<double, 2>> points) {
  const std::vector<Point> hull = convex_hull(std::move(points));
  TurnedRectangle best = around(hull, {1, 0});
  for (std::size_t k = 0; k < hull.size(); ++k) {
    const Point &a = hull[k], &b = hull[(k + 1) % hull.size()];
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (!(length > 0)) continue;
    const TurnedRectangle r = around(hull, {(b[0] - a[0]) / length, (b[1] - a[1]) / length});
    if (area(r) < area(best) * (1 - 1e-9)) best = r;
  }
  return best;
}

}  // namespace clerestory
