#include "solver/particles/luminaire_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "solver/sampling/unit_square.h"

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Which of a web's angles directions lie closer together by: the weight of solid angle.
bool weighs_horizontal(WebType type) { return type == WebType::B; }
bool weighs_by_sine(WebType type) { return type == WebType::C; }

/// x in [a, b] up to which the function that is f_a at a, f_b at b, linear between, times sine or cosine of x, has the
/// share u of its integral. Newton's steps, halved where they leave what is left.
double inverse(double a, double b, double f_a, double f_b, bool sine, double u) {
  const auto integral_to = [&](double x) {
    const AngleWeights w = angle_weights(a, x, sine);
    return f_a * w.low + (f_a + (f_b - f_a) * ((x - a) / (b - a))) * w.high;
  };
  const double wanted = u * integral_to(b);
  double low = a, high = b, x = a + (b - a) * u;
  for (int step = 0; step < 60; ++step) {
    const double miss = integral_to(x) - wanted;
    (miss > 0 ? high : low) = x;
    const double slope = (f_a + (f_b - f_a) * ((x - a) / (b - a))) * (sine ? std::sin(x) : std::cos(x));
    double next = x - miss / slope;
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (std::abs(next - x) <= 1e-13) return next;
    x = next;
  }
  return x;
}

/// The same of a linear function without weight, over [0, 1].
double inverse_linear(double f_0, double f_1, double u) {
  const double root = std::sqrt(std::max(0.0, f_0 * f_0 + u * (f_1 * f_1 - f_0 * f_0)));
  return f_0 + root > 0 ? std::min(1.0, u * (f_0 + f_1) / (f_0 + root)) : u;
}

}  // namespace

WebDirections::WebDirections(const PhotometricWeb& web) : web_(web), horizontal_(web.horizontal) {
  if (horizontal_.size() == 1)
    horizontal_ = web.type == WebType::C   ? std::vector<double>{0, 360}
                  : web.type == WebType::A ? std::vector<double>{-180, 180}
                                           : std::vector<double>{-90, 90};
  std::vector<double> flux;
  for (std::size_t k = 0; k < (horizontal_.size() - 1) * (web.vertical.size() - 1); ++k) {
    const Cell at = cell(k);
    const AngleWeights w = angle_weights(at.a, at.b, weighs_by_sine(web.type));
    flux.push_back(std::max(0.0, (at.d - at.c) / 2 * ((at.f_ac + at.f_ad) * w.low + (at.f_bc + at.f_bd) * w.high)));
  }
  cells_ = CumulativeTable(flux);
}

WebDirections::Cell WebDirections::cell(std::size_t number) const {
  const std::size_t n = web_.vertical.size(), h = number / (n - 1), v = number % (n - 1);
  const auto candela = [&](std::size_t i, std::size_t j) {
    return double{web_.candela[(web_.horizontal.size() == 1 ? 0 : h + i) * n + v + j]};
  };
  const double h_0 = horizontal_[h] * kDegree, h_1 = horizontal_[h + 1] * kDegree;
  const double v_0 = web_.vertical[v] * kDegree, v_1 = web_.vertical[v + 1] * kDegree;
  if (weighs_horizontal(web_.type))
    return {h_0, h_1, v_0, v_1, candela(0, 0), candela(1, 0), candela(0, 1), candela(1, 1)};
  return {v_0, v_1, h_0, h_1, candela(0, 0), candela(0, 1), candela(1, 0), candela(1, 1)};
}

Vec3 WebDirections::sample(double u, double v) const {
  const auto [number, probability, rest] = cells_.choose(u);
  const Cell at = cell(number);
  const double x = inverse(at.a, at.b, at.f_ac + at.f_ad, at.f_bc + at.f_bd, weighs_by_sine(web_.type), rest);
  const double t = (x - at.a) / (at.b - at.a);
  const double y =
      at.c + (at.d - at.c) * inverse_linear(at.f_ac + (at.f_bc - at.f_ac) * t, at.f_ad + (at.f_bd - at.f_ad) * t, v);
  const auto [V, H] = weighs_horizontal(web_.type) ? std::pair(y, x) : std::pair(x, y);
  switch (web_.type) {
    case WebType::C:
      return {std::sin(V) * std::cos(H), std::sin(V) * std::sin(H), -std::cos(V)};
    case WebType::B:
      return {std::cos(H) * std::sin(V), -std::sin(H), -std::cos(H) * std::cos(V)};
    case WebType::A:
      break;
  }
  return {std::cos(V) * std::cos(H), -std::cos(V) * std::sin(H), std::sin(V)};
}

Vec3 sample_direction(const PointLuminaire&, double u, double v) { return sphere_direction(u, v); }

Vec3 sample_direction(const SpotLuminaire& luminaire, double u, double v) {
  // Of s = 1 - cosine: even up to the inner cone, then the square of a ramp that ends at the outer one; as intensity().
  const double whole = 1 - std::cos(luminaire.outer_angle);
  const double width = std::max(1e-3, std::cos(luminaire.inner_angle) - std::cos(luminaire.outer_angle));
  const double even = std::max(0.0, whole - width), top = std::min(1.0, whole / width);  // of the ramp
  const double in_ramp = width * top * top * top / 3, at = u * (in_ramp + even);
  const double s = at < in_ramp ? whole - width * std::cbrt(3 * at / width) : even - (at - in_ramp);
  const double r = std::sqrt(std::max(0.0, s * (2 - s))), phi = 2 * std::numbers::pi * v;
  return Frame(luminaire.direction).to_world(r * std::cos(phi), r * std::sin(phi), 1 - s);
}

Vec3 sample_direction(const WebLuminaire& luminaire, const WebDirections& directions, double u, double v) {
  const Vec3 d = directions.sample(u, v);
  return luminaire.axes.x * d.x + luminaire.axes.y * d.y + luminaire.axes.z * d.z;
}

}  // namespace clerestory
