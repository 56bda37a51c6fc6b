#include "pipeline/tradeoff/field_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kFacesAsOne = 0.7;  ///< cosine; facets of a curved surface turn a little when they are simplified

using Corners = std::array<Vec3, 3>;

/// Of the point of a triangle that is nearest to p: barycentric coordinates.
/// Source: Ericson, "Real-Time Collision Detection", 2005, 5.1.5.
Vec3 nearest_weights(const Corners& c, const Vec3& p) {
  const Vec3 ab = c[1] - c[0], ac = c[2] - c[0], ap = p - c[0];
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bp = p - c[1];
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const Vec3 cp = p - c[2];
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4, along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {0, 1 - along, along};
  const double all = va + vb + vc;
  return {va / all, vb / all, vc / all};
}

/// Illuminance of the nearest triangle within `tolerance`; less than 0: there is none.
double value_at(const ReferencePoint& at, const WrittenResult& result, const std::vector<float>& E, double tolerance) {
  double nearest = tolerance * tolerance, found = -1;
  for (const auto& t : result.triangles) {
    const Corners c = {result.points[t[0]], result.points[t[1]], result.points[t[2]]};
    bool is_beside = false;
    for (const auto axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
      const auto [low, high] = std::minmax({c[0].*axis, c[1].*axis, c[2].*axis});
      is_beside |= at.p.*axis < low - tolerance || at.p.*axis > high + tolerance;
    }
    if (is_beside) continue;
    const Vec3 n = cross(c[1] - c[0], c[2] - c[0]);
    if (!(dot(n, at.n) > kFacesAsOne * length(n))) continue;
    const Vec3 w = nearest_weights(c, at.p);
    const Vec3 off = c[0] * w.x + c[1] * w.y + c[2] * w.z - at.p;
    if (!(dot(off, off) <= nearest)) continue;
    nearest = dot(off, off);
    found =
        w.x * static_cast<double>(E[t[0]]) + w.y * static_cast<double>(E[t[1]]) + w.z * static_cast<double>(E[t[2]]);
  }
  return found;
}

}  // namespace

FieldValues values_at(const std::vector<ReferencePoint>& points, const WrittenResult& result, double tolerance) {
  FieldValues found{std::vector<double>(points.size())};
  const std::vector<float>& E = result.of_points.at("illuminance").value;
  parallel_for(points.size(), 16, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) found.E[i] = value_at(points[i], result, E, tolerance);
  });
  for (double& value : found.E)
    if (value < 0) value = 0, ++found.not_shown;
  return found;
}

FieldError error_of(const SweepReference& reference, const std::vector<double>& E) {
  std::vector<Comparison> all;
  std::vector<std::vector<Comparison>> of_room(reference.rooms().size());
  for (std::size_t i = 0; i < E.size(); ++i) {
    const ReferencePoint& at = reference.points()[i];
    all.push_back({.x = E[i],
                   .r = at.E,
                   .std_error = at.std_error,
                   .weight = at.weight,
                   .part = at.room,
                   .gather = at.gather,
                   .other_gather = at.other_gather});
    of_room[at.room].push_back(all.back());
  }
  FieldError error{summarise(all), {}, 0};
  for (std::size_t k = 0; k < of_room.size(); ++k) {
    if (!reference.rooms()[k].is_large || !reference.tells(static_cast<std::uint32_t>(k))) continue;
    const ErrorFigures figures = summarise(of_room[k]);
    if (figures.samples > 0 && (error.worst.samples == 0 || figures.rms_relative > error.worst.rms_relative))
      error.worst = figures, error.room = static_cast<std::uint32_t>(k);
  }
  if (error.worst.samples == 0) error.worst = error.all;
  return error;
}

}  // namespace clerestory
