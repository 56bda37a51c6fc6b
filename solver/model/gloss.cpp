#include "solver/model/gloss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clerestory {
namespace {

constexpr double kPi = std::numbers::pi;

Vec3 mirrored(const Vec3& n, const Vec3& a) { return n * (2 * dot(n, a)) - a; }

/// Direction around `axis` with density (e + 1) / (2 pi) cos^e.
Vec3 around(const Vec3& axis, double e, double u, double v) {
  const double cosine = std::pow(1 - u, 1 / (e + 1)), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return Frame(axis).to_world(sine * std::cos(2 * kPi * v), sine * std::sin(2 * kPi * v), cosine);
}

/// Lambda of Smith's shadowing.
double hidden(double cosine, double alpha) {
  const double tan2 = (1 - cosine * cosine) / (cosine * cosine);
  return (std::sqrt(1 + alpha * alpha * tan2) - 1) / 2;
}

/// Distribution of the normals [1/sr] at cosine c to n.
double normals(double c, double alpha) {
  const double a2 = alpha * alpha, t = 1 - c * c + a2 * c * c;  // not c2 (a2 - 1) + 1, which loses small a2
  return a2 / (kPi * t * t);
}

/// A normal that is seen from `from`, in the frame of the surface.
Vec3 seen_normal(const Vec3& from, double alpha, double u, double v) {
  const Vec3 w = normalized({alpha * from.x, alpha * from.y, from.z});
  const double across = w.x * w.x + w.y * w.y;
  const Vec3 t1 = across > 0 ? Vec3{-w.y, w.x, 0} / std::sqrt(across) : Vec3{1, 0, 0}, t2 = cross(w, t1);
  const double r = std::sqrt(u), a = r * std::cos(2 * kPi * v), s = (1 + w.z) / 2;
  const double b = (1 - s) * std::sqrt(std::max(0.0, 1 - a * a)) + s * r * std::sin(2 * kPi * v);
  const Vec3 h = t1 * a + t2 * b + w * std::sqrt(std::max(0.0, 1 - a * a - b * b));
  return normalized({alpha * h.x, alpha * h.y, std::max(1e-9, h.z)});
}

/// Share that single facets reflect from an angle of that cosine. Steep facets are few, and what they lose is all that
/// smooth surfaces lose: u = 1 - w4.
double facets_reflect(double cosine, double alpha) {
  constexpr int kSteep = 96, kTurns = 64;
  const Vec3 from{std::sqrt(std::max(0.0, 1 - cosine * cosine)), 0, cosine};
  double sum = 0;
  for (int i = 0; i < kSteep; ++i) {
    const double w = (i + 0.5) / kSteep, w3 = w * w * w;
    for (int j = 0; j < kTurns; ++j) {
      const Vec3 h = seen_normal(from, alpha, 1 - w3 * w, (j + 0.5) / kTurns);
      const double up = 2 * dot(h, from) * h.z - from.z;
      if (up > 0) sum += 4 * w3 * (1 + hidden(cosine, alpha)) / (1 + hidden(cosine, alpha) + hidden(up, alpha));
    }
  }
  return sum / (kSteep * kTurns);
}

constexpr int kAngles = 192;

/// Albedo of a white Phong lobe: (e + 2) / (e + 1) times the mean of the cosine over its samples, of which those below
/// the surface count as 0. The mean over the turn around the mirror's direction is a closed form.
double phong_albedo(double cosine, double e) {
  constexpr int kSteps = 1024;
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) {
    const double c = std::pow((k + 0.5) / kSteps, 1 / (e + 1)), s = std::sqrt(std::max(0.0, 1 - c * c));
    const double x = c * cosine, y = s * sine;
    if (x >= y) {
      sum += x;
    } else if (x > -y) {
      const double half = std::acos(-x / y);
      sum += (x * half + y * std::sin(half)) / kPi;
    }
  }
  return (e + 2) / (e + 1) * sum / kSteps;
}

}  // namespace

Lobe::Lobe(const Gloss& gloss) : specular_(gloss.specular), is_phong_(gloss.exponent.has_value()) {
  if (is_phong_) {
    exponent_ = *gloss.exponent;
    return;
  }
  alpha_ = gloss.roughness * gloss.roughness;
  double all = 0;
  for (int k = 0; k <= kAngles; ++k) {
    const double root = std::max(1e-3, static_cast<double>(k) / kAngles);
    facet_albedo_.push_back(std::min(1.0, facets_reflect(root * root, alpha_)));
  }
  // 2 integral of A(c) c dc, exactly as it is looked up: c = t2, dc = 2 t dt.
  constexpr int kParts = 16;
  for (int k = 0; k < kAngles * kParts; ++k) {
    const double t = (k + 0.5) / (kAngles * kParts);
    all += 4 * t * t * t * facet_albedo(t * t) / (kAngles * kParts);
  }
  lost_ = std::max(0.0, 1 - all);
}

double Lobe::facet_albedo(double cosine) const {
  const double at = std::sqrt(cosine) * kAngles;
  const auto k = std::min<std::size_t>(static_cast<std::size_t>(at), kAngles - 1);
  return std::lerp(facet_albedo_[k], facet_albedo_[k + 1], at - static_cast<double>(k));
}

double Lobe::shape(const Vec3& n, const Vec3& a, const Vec3& b) const {
  const double cos_a = dot(n, a), cos_b = dot(n, b);
  if (!(cos_a > 0 && cos_b > 0)) return 0;
  if (is_phong_) {
    const double c = dot(mirrored(n, a), b);
    return c > 0 ? (exponent_ + 2) / (2 * kPi) * std::pow(c, exponent_) : 0;
  }
  const Vec3 h = normalized(a + b);
  const double seen = 1 / (1 + hidden(cos_a, alpha_) + hidden(cos_b, alpha_));
  const double given_back = lost_ > 0 ? (1 - facet_albedo(cos_a)) * (1 - facet_albedo(cos_b)) / (kPi * lost_) : 0;
  return normals(dot(n, h), alpha_) * seen / (4 * cos_a * cos_b) + given_back;
}

double Lobe::density(const Vec3& n, const Vec3& from, const Vec3& to) const {
  const double cosine = dot(n, from), cos_to = dot(n, to);
  if (!(cosine > 0 && cos_to > 0)) return 0;
  if (is_phong_) {
    const double c = dot(mirrored(n, from), to);
    return c > 0 ? (exponent_ + 1) / (2 * kPi) * std::pow(c, exponent_) : 0;
  }
  const double by_facets = facet_albedo(cosine);
  const Vec3 h = normalized(from + to);
  return by_facets * normals(dot(n, h), alpha_) / ((1 + hidden(cosine, alpha_)) * 4 * cosine) +
         (1 - by_facets) * cos_to / kPi;
}

Lobe::Sample Lobe::sample(const Vec3& n, const Vec3& from, double u, double v) const {
  if (!(dot(n, from) > 0)) return {};
  Sample s;
  if (is_phong_) {
    s.direction = around(mirrored(n, from), exponent_, u, v);
  } else if (const double by_facets = facet_albedo(dot(n, from)); u < by_facets) {
    const Frame frame(n);
    const Vec3 h = seen_normal({dot(from, frame.t), dot(from, frame.b), dot(from, frame.n)}, alpha_, u / by_facets, v);
    s.direction = mirrored(frame.to_world(h.x, h.y, h.z), from);
  } else {
    const double rest = (u - by_facets) / (1 - by_facets), r = std::sqrt(rest);
    s.direction = Frame(n).to_world(r * std::cos(2 * kPi * v), r * std::sin(2 * kPi * v), std::sqrt(1 - rest));
  }
  s.direction = normalized(s.direction);
  s.density = density(n, from, s.direction);
  if (s.density > 0) s.weight = evaluate(n, from, s.direction) * (dot(n, s.direction) / s.density);
  return s;
}

Spectrum Lobe::albedo(double cosine) const { return specular_ * (is_phong_ ? phong_albedo(cosine, exponent_) : 1.0); }

double Lobe::sharpness() const { return is_phong_ ? exponent_ : 1 / (2 * alpha_ * alpha_); }

}  // namespace clerestory
