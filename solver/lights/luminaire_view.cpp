#include "solver/lights/luminaire_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/lights/luminaire.h"
#include "solver/model/units.h"

namespace clerestory {
namespace {

constexpr double kWide = 0.5;  // size / distance, from which on the light of an even luminaire varies over a triangle
constexpr double kOfAllFlux = 3e-5, kOfTriangle = 3e-3;  // that a cell may be wrong by: of what there is at most
constexpr double kFlat = 0.02;  // of the peak: bends no more than a formula for quadratic intensity knows
constexpr std::size_t kMostCells = 1 << 15;

/// Of the directions to the farthest corner and to the middle [rad].
double radius(const SphericalTriangle& t, const Vec3& middle) {
  const double chord = std::max({length(t[0] - middle), length(t[1] - middle), length(t[2] - middle)});
  return 2 * std::asin(std::min(1.0, chord / 2));
}

}  // namespace

bool wants_view(const Luminaire& luminaire, const Beam& beam, const std::array<Vec3, 3>& c) {
  const Vec3 middle = (c[0] + c[1] + c[2]) / 3;
  const double size = 2 * std::max({length(c[0] - middle), length(c[1] - middle), length(c[2] - middle)});
  const double gap = length(luminaire.position - middle) - size / 2 - reach(luminaire);
  // Over an opening near by each ray comes from another point of it: a narrow beam is no line there.
  const bool is_point = !beam.is_even && opening_rays(luminaire, middle) == 1;
  return size > (is_point ? std::min(kWide, 2 * beam.finest) : kWide) * gap;
}

double LuminaireView::intensity_towards(const Vec3& d) const {
  return beam_.is_even ? beam_.peak : luminous_mean(intensity(luminaire_, d));
}

LuminaireView::Cell LuminaireView::cell(const SphericalTriangle& to, const std::array<double, 3>& I) const {
  Cell c{to, I, solid_angle(to)};
  if (!(c.solid_angle > 0)) return c;
  // Exact where the intensity is quadratic.
  const double middle = beam_.is_even ? beam_.peak : intensity_towards(normalized(to[0] + to[1] + to[2]));
  const double corners = (I[0] + I[1] + I[2]) / 3;
  c.flux = c.solid_angle * (0.75 * middle + 0.25 * corners);
  c.bend = std::abs(middle - corners);
  return c;
}

LuminaireView::Place LuminaireView::place_of(const Cell& c) const {
  if (!(beam_.half_angle < std::numbers::pi)) return Place::inside;
  const Vec3 middle = normalized(c.to[0] + c.to[1] + c.to[2]);
  const double off = std::atan2(length(cross(middle, beam_.axis)), dot(middle, beam_.axis));
  const double half_width = radius(c.to, middle);
  if (off > beam_.half_angle + half_width) return Place::outside;
  const bool is_on_edge = off + half_width > beam_.edge_from && off - half_width < beam_.edge_to;
  return is_on_edge && half_width > beam_.edge_to - beam_.edge_from ? Place::on_edge : Place::inside;
}

void LuminaireView::add(const Cell& whole) {
  waiting_.assign(1, whole);
  while (!waiting_.empty()) {
    Cell c = waiting_.back();
    waiting_.pop_back();
    const Place place = place_of(c);
    if (!(c.solid_angle > 0) || place == Place::outside) continue;
    std::size_t k = 0;  // the longest edge starts at corner k
    double longest = -1;
    for (std::size_t j = 0; j < 3; ++j)
      if (const double edge = length(c.to[(j + 1) % 3] - c.to[j]); edge > longest) longest = edge, k = j;
    const bool is_full = cells_.size() + waiting_.size() >= kMostCells;
    const bool is_wide = longest > 2 * beam_.finest || place == Place::on_edge;
    const bool is_flat = !is_wide && c.bend < flat_;
    if (beam_.is_even || is_full || is_flat || c.solid_angle * beam_.peak <= most_off_) {
      if (c.flux > 0) cells_.push_back(c);
      continue;
    }
    const std::size_t next = (k + 1) % 3, apex = (k + 2) % 3;
    const Vec3 middle = normalized(c.to[k] + c.to[next]);
    const double I = intensity_towards(middle);
    const Cell first = cell({c.to[k], middle, c.to[apex]}, {c.I[k], I, c.I[apex]});
    const Cell second = cell({middle, c.to[next], c.to[apex]}, {I, c.I[next], c.I[apex]});
    const bool is_known = !is_wide && std::abs(first.flux + second.flux - c.flux) <= most_off_;
    for (const Cell& half : {first, second})
      if (!is_known)
        waiting_.push_back(half);
      else if (half.flux > 0)
        cells_.push_back(half);
  }
}

double LuminaireView::look_from(const Vec3& q, bool is_one_of_many) {
  q_ = q;
  flat_ = is_one_of_many ? kFlat * beam_.peak : 0;
  cells_.clear();
  const double height = dot(normal_, q - corners_[0]);
  if (!(height > 0)) return 0;
  SphericalTriangle to;
  std::array<double, 3> I;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 d = corners_[k] - q;
    if (!(dot(d, d) > 0)) return 0;
    to[k] = normalized(d);
  }
  const double whole = solid_angle(to);
  if (!(whole > 0)) return 0;
  most_off_ = std::min(kOfAllFlux * beam_.flux, kOfTriangle * whole * beam_.peak);
  for (std::size_t k = 0; k < 3; ++k) I[k] = intensity_towards(to[k]);
  // Near the plane the triangle is all but a great circle, which has no inside: its parts around the foot have one.
  const Vec3 foot = q - normal_ * height;
  bool is_above = true;
  for (std::size_t k = 0; k < 3; ++k)
    is_above = is_above && dot(normal_, cross(corners_[k] - foot, corners_[(k + 1) % 3] - foot)) > 0;
  if (is_above) {
    const double down = intensity_towards(-normal_);
    for (std::size_t k = 0; k < 3; ++k) add(cell({-normal_, to[k], to[(k + 1) % 3]}, {down, I[k], I[(k + 1) % 3]}));
  } else {
    add(cell(to, I));
  }
  double flux = 0;
  for (Cell& c : cells_) c.cumulative = flux += c.flux;
  return flux;
}

Vec3 LuminaireView::lit_point(double u, double v) const {
  const double at = u * cells_.back().cumulative;
  const auto found =
      std::upper_bound(cells_.begin(), cells_.end(), at, [](double x, const Cell& c) { return x < c.cumulative; });
  const Cell& c = found == cells_.end() ? cells_.back() : *found;
  const double share = std::clamp(1 - (c.cumulative - at) / c.flux, 0.0, 1.0);
  const Vec3 seen = point_on(c.to, c.solid_angle, share, v).direction;
  // As weights of the corners, none negative: rounding must not throw a point seen at a grazing angle off the triangle.
  const std::array<Vec3, 3> d{corners_[0] - q_, corners_[1] - q_, corners_[2] - q_};
  const double sign = dot(d[0], cross(d[1], d[2])) < 0 ? -1 : 1;
  Vec3 point;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double weight = std::max(0.0, sign * dot(seen, cross(d[(k + 1) % 3], d[(k + 2) % 3])));
    point += corners_[k] * weight;
    sum += weight;
  }
  if (!(sum > 0)) return (corners_[0] + corners_[1] + corners_[2]) / 3;
  return point / sum;
}

}  // namespace clerestory
