#include "solver/openings/openings.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "solver/form_factors/point_to_polygon.h"
#include "solver/model/random_stream.h"
#include "solver/sampling/unit_square.h"

namespace clerestory {

double way_out(const LightArea& opening, const Vec3& p, const Vec3& d) {
  if (!OpeningSphere(opening).is_passed(p, d)) return -1;
  const double t = dot(p - opening.centre, opening.normal) / -dot(d, opening.normal);
  if (!(t > 0)) return -1;
  const Vec3 x = p + d * t;
  for (const auto& [a, b, c] : opening.triangles) {
    const double ab = dot(cross(b - a, x - a), opening.normal), bc = dot(cross(c - b, x - b), opening.normal),
                 ca = dot(cross(a - c, x - c), opening.normal);
    if (ab >= 0 && bc >= 0 && ca >= 0) return t;
  }
  return -1;
}

bool is_passed(const LightArea& opening, const Vec3& p, const Vec3& d, double distance) {
  const double out = way_out(opening, p, d);
  if (out >= 0) return out <= distance;
  const Vec3 towards = opening.centre - p;
  if (!(dot(d, opening.normal) > 0) || !(dot(towards, opening.normal) > 0)) return false;  // not from behind it
  const double beyond = dot(towards, d) + 2 * opening.radius;
  const double in = way_out(opening, p + d * beyond, -d);
  return in >= 0 && beyond - in >= 0 && beyond - in <= distance;
}

std::uint32_t first_way_out(std::span<const LightArea> openings, std::span<const std::uint32_t> numbers, const Vec3& p,
                            const Vec3& d, double distance) {
  for (const std::uint32_t k : numbers) {
    const double out = way_out(openings[k], p, d);
    if (out >= 0 && out <= distance) return k;
  }
  return kNoOpening;
}

bool sees_much_sky(std::span<const Hit> hits) {
  constexpr double kMuch = 0.3;
  return static_cast<double>(std::ranges::count_if(hits, &Hit::escaped)) > kMuch * static_cast<double>(hits.size());
}

double most_it_gives(const LightArea& opening, const Vec3& p, const Vec3& n) {
  const Vec3 d = opening.centre - p;
  const double height = -dot(d, opening.normal), above = dot(d, n) + opening.radius;
  if (!(height > 0) || !(above > 0)) return 0;
  const double r = length(d), nearest = r - opening.radius;
  if (nearest < opening.radius) return 1;
  const double cos_p = std::min(1.0, above / nearest), cos_o = std::min(1.0, height / nearest);
  return opening.area * cos_p * cos_o / (std::numbers::pi * nearest * nearest);
}

double form_factor(const LightArea& opening, const Vec3& p, const Vec3& n) {
  double F = 0;
  for (const auto& triangle : opening.triangles) F += point_to_polygon(p, n, triangle);
  return F;
}

bool is_slit(const LightArea& opening) {
  constexpr double kNarrow = 0.02;  // of its length: windows are wider
  return opening.area < kNarrow * 4 * opening.radius * opening.radius;
}

std::vector<LightArea> slits_among(std::span<const LightArea> openings) {
  std::vector<LightArea> slits;
  std::ranges::copy_if(openings, std::back_inserter(slits), is_slit);
  return slits;
}

namespace {

/// The triangle where the running sum of areas passes `left`, which becomes what is left in it [m2].
const std::array<Vec3, 3>& triangle_at(const LightArea& opening, double& left) {
  for (const auto& triangle : opening.triangles) {
    const double area = length(cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
    if (left < area) return triangle;
    left -= area;
  }
  return opening.triangles.back();  // by rounding
}

}  // namespace

Vec3 point_of(const LightArea& opening, double u, double v) {
  double left = u * opening.area;
  const auto& triangle = triangle_at(opening, left);
  const double area = length(cross(triangle[1] - triangle[0], triangle[2] - triangle[0])) / 2;
  return point_on_triangle(triangle, std::min(left / area, 1.0), v);
}

Ray ray_through(const LightArea& opening, const Vec3& side, std::uint64_t key, std::uint32_t k, double lift) {
  const auto u = sobol4(k, key);
  double left = sobol4(k, key + 1)[0] * opening.area;
  const auto& triangle = triangle_at(opening, left);
  // A little short of what is around: rounding would put the start behind it.
  const double inset = std::min(0.05, lift * 2 * opening.radius / opening.area);
  const Vec3 p = point_on_triangle(triangle, u[0], u[1]);
  return {p + (opening.centre - p) * inset + side * lift, cosine_direction(Frame(side), u[2], u[3])};
}

namespace {

/// Form factor, roughly but for slits and from nearby: as of discs around three points of each triangle; from afar
/// around the centre.
double about_form_factor(const LightArea& opening, const Vec3& p, const Vec3& n) {
  const Vec3 to_centre = opening.centre - p;
  const double height = -dot(to_centre, opening.normal), above = dot(to_centre, n), r2 = dot(to_centre, to_centre);
  if (!(height > 0)) return 0;
  const auto disc = [&](double area, double above_horizon, double square) {
    return area * std::max(0.0, above_horizon) * height / (square * (std::numbers::pi * square + area));
  };
  constexpr double kNear = 1.5, kAfar = 4;  // radii; from afar 2 % off at most where all of it is in view
  if (r2 > kAfar * kAfar * opening.radius * opening.radius && std::abs(above) > opening.radius)
    return disc(opening.area, above, r2);
  if (r2 < kNear * kNear * opening.radius * opening.radius || is_slit(opening)) return form_factor(opening, p, n);
  double F = 0;
  for (const auto& [a, b, c] : opening.triangles) {
    const double area = length(cross(b - a, c - a)) / 2;
    const Vec3 middle = (a + b + c) / 6 - p;
    for (const Vec3& corner : {a, b, c}) {
      const Vec3 d = middle + corner / 2;
      F += disc(area / 3, dot(d, n), dot(d, d));
    }
  }
  return F;
}

}  // namespace

std::vector<std::uint32_t> areas_over(std::span<const LightArea> openings, const Vec3& p, const Vec3& n,
                                      std::size_t most, double least_of_best) {
  constexpr double kNothing = 1e-9;
  // Form factors cost more than all the rest: those that may give most come first, until none can give as much.
  thread_local std::vector<std::pair<double, std::uint32_t>> may_give;
  may_give.clear();
  for (std::uint32_t k = 0; k < openings.size(); ++k)
    if (const double bound = most_it_gives(openings[k], p, n); bound > kNothing)
      may_give.emplace_back(bound * openings[k].brightness, k);
  std::make_heap(may_give.begin(), may_give.end());
  std::vector<std::pair<double, std::uint32_t>> found;  // by light, the most first
  while (!may_give.empty() && (found.size() < most || may_give.front().first > -found.back().first)) {
    std::pop_heap(may_give.begin(), may_give.end());
    const std::uint32_t k = may_give.back().second;
    may_give.pop_back();
    const double F = about_form_factor(openings[k], p, n), gives = F * openings[k].brightness;
    if (!(F > kNothing)) continue;
    found.insert(std::upper_bound(found.begin(), found.end(), std::pair{-gives, k}), {-gives, k});
    if (found.size() > most) found.pop_back();
  }
  std::vector<std::uint32_t> numbers;
  for (const auto& [F, k] : found)
    if (F <= least_of_best * found.front().first) numbers.push_back(k);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

}  // namespace clerestory
