#include "pipeline/tradeoff/field_error.h"

#include <algorithm>

#include "solver/geometry/triangle.h"
#include "solver/model/parallel.h"

namespace clerestory {
namespace {

constexpr double kFacesAsOne = 0.7;  ///< cosine; facets of a curved surface turn a little when they are simplified

using Corners = std::array<Vec3, 3>;

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
    const Vec3 x = nearest_point(c, at.p), off = x - at.p;
    if (!(dot(off, off) <= nearest)) continue;
    nearest = dot(off, off);
    found = 0;
    for (std::size_t k = 0; k < 3; ++k)  // linear between the corners: by the parts of the area
      found += dot(cross(c[(k + 1) % 3] - x, c[(k + 2) % 3] - x), n) / dot(n, n) * static_cast<double>(E[t[k]]);
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
