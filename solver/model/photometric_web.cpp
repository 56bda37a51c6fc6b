#include "solver/model/photometric_web.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Interval of ascending `at` that x lies in, and where between its ends.
struct Place {
  std::size_t below = 0;
  double part = 0;
  bool outside = false;
};

Place find(const std::vector<double>& at, double x) {
  constexpr double kSlack = 1e-9;  // a direction computed from 90 degrees may come back as a little more [deg]
  if (x < at.front() - kSlack || x > at.back() + kSlack) return {0, 0, true};
  // Most files have even steps: try there first.
  const std::size_t last = at.size() - 2;
  const double step = (at.back() - at.front()) / static_cast<double>(at.size() - 1);
  auto i = std::min(last, static_cast<std::size_t>(std::max(0.0, (x - at.front()) / step)));
  if (!(at[i] <= x && x <= at[i + 1])) {
    const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, x);
    i = static_cast<std::size_t>(above - at.begin()) - 1;
  }
  return {i, std::clamp((x - at[i]) / (at[i + 1] - at[i]), 0.0, 1.0), false};
}

double interpolated(const std::vector<double>& at, const std::vector<double>& value, double x) {
  if (x <= at.front()) return value.front();
  if (x >= at.back()) return value.back();
  const Place p = find(at, x);
  return value[p.below] * (1 - p.part) + value[p.below + 1] * p.part;
}

/// Integral over ascending angles [deg] of the function linear between value(i), with weight sin, cos or 1.
enum class Weight { sine, cosine, one };
template <class Value>
double integral(const std::vector<double>& at, Weight weight, const Value& value) {
  double sum = 0;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    const double a = at[i] * kDegree, b = at[i + 1] * kDegree;
    const AngleWeights w =
        weight == Weight::one ? AngleWeights{(b - a) / 2, (b - a) / 2} : angle_weights(a, b, weight == Weight::sine);
    sum += value(i) * w.low + value(i + 1) * w.high;
  }
  return sum;
}

}  // namespace

AngleWeights angle_weights(double a, double b, bool sine) {
  const double h = b - a;
  // Antiderivative of w, and of that one; the second integral is [t W] - 1/h [WW].
  const auto W = [&](double x) { return sine ? -std::cos(x) : std::sin(x); };
  const auto WW = [&](double x) { return sine ? -std::sin(x) : -std::cos(x); };
  if (h < 1e-4) {  // the difference of differences below would lose its digits
    const double w = sine ? std::sin((a + b) / 2) : std::cos((a + b) / 2);
    return {w * h / 2, w * h / 2};
  }
  const double high = W(b) - (WW(b) - WW(a)) / h;
  return {W(b) - W(a) - high, high};
}

Vec3 beam_axis(WebType type) { return type == WebType::A ? Vec3{1, 0, 0} : Vec3{0, 0, -1}; }

LuminaireAxes aimed(WebType type, const Vec3& aim, double rotation_deg) {
  const Vec3 beam = beam_axis(type);
  const double c = dot(beam, aim);
  // Half a turn has no shortest way.
  const Vec3 half_turn = type == WebType::A ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  const Vec3 k = cross(beam, aim), back = -aim;
  const double angle = rotation_deg * kDegree, cos_r = std::cos(angle), sin_r = std::sin(angle);
  const auto turned = [&](const Vec3& v) {
    const Vec3 there =
        c > -1 + 1e-12 ? v * c + cross(k, v) + k * (dot(k, v) / (1 + c)) : half_turn * (2 * dot(half_turn, v)) - v;
    return there * cos_r + cross(back, there) * sin_r + back * (dot(back, there) * (1 - cos_r));
  };
  return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
}

double candela_towards(const PhotometricWeb& web, const Vec3& d) {
  const auto arc_sine = [](double s) { return std::asin(std::clamp(s, -1.0, 1.0)) / kDegree; };
  double v = 0, h = 0;
  switch (web.type) {
    case WebType::C:
      // atan2 and not acos: acos loses half its digits near straight down.
      v = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), -d.z) / kDegree;
      if (web.horizontal.size() > 1) h = std::atan2(d.y, d.x) / kDegree;
      if (h < 0) h += 360;
      break;
    case WebType::B:
      v = std::atan2(d.x, -d.z) / kDegree;
      h = arc_sine(-d.y);
      break;
    case WebType::A:
      v = arc_sine(d.z);
      h = std::atan2(-d.y, d.x) / kDegree;
      break;
  }
  const std::size_t n = web.vertical.size();
  const Place pv = find(web.vertical, v);
  if (pv.outside) return 0;
  const auto along = [&](std::size_t k) {
    const float* row = web.candela.data() + k * n + pv.below;
    return row[0] * (1 - pv.part) + row[1] * pv.part;
  };
  if (web.horizontal.size() == 1) return along(0);
  const Place ph = find(web.horizontal, h);
  if (ph.outside) return 0;
  return along(ph.below) * (1 - ph.part) + along(ph.below + 1) * ph.part;
}

double peak_candela(const PhotometricWeb& web) {
  return web.candela.empty() ? 0.0 : *std::max_element(web.candela.begin(), web.candela.end());
}

double luminous_flux(const PhotometricWeb& web) {
  const std::size_t n = web.vertical.size();
  const Weight of_v = web.type == WebType::C ? Weight::sine : web.type == WebType::A ? Weight::cosine : Weight::one;
  const Weight of_h = web.type == WebType::B ? Weight::cosine : Weight::one;
  const auto plane = [&](std::size_t h) {
    return integral(web.vertical, of_v, [&](std::size_t v) { return double{web.candela[h * n + v]}; });
  };
  if (web.horizontal.size() > 1) return integral(web.horizontal, of_h, plane);
  return plane(0) * (web.type == WebType::B ? 2 : 2 * std::numbers::pi);
}

double tilt_factor(const PhotometricWeb& web, double tilt_deg) {
  return web.tilt_deg.empty() ? 1.0 : interpolated(web.tilt_deg, web.tilt_factor, tilt_deg);
}

}  // namespace clerestory
