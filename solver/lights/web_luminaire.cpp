#include "solver/lights/web_luminaire.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/model/units.h"
#include "solver/sampling/gauss_legendre.h"

namespace clerestory {
namespace {

constexpr double kNear = 10;              // lengths of the opening, nearer than which it counts: a point errs by 0.3 %
constexpr double kSmallestShare = 256.0;  // of the opening, that one point stands for

double largest_length(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

/// The two larger lengths of the opening, and the axes they lie along.
struct Face {
  double a, b;
  Vec3 along_a, along_b;
  bool round;
};
Face face(const WebLuminaire& luminaire) {
  const auto& [size, round] = luminaire.web->opening;
  const auto& [x, y, z] = luminaire.axes;
  if (size.z <= std::min(size.x, size.y)) return {size.x, size.y, x, y, round};
  return size.x >= size.y ? Face{size.x, size.z, x, z, false} : Face{size.y, size.z, y, z, false};
}

Vec3 to_luminaire_frame(const WebLuminaire& luminaire, const Vec3& d) {
  return {dot(d, luminaire.axes.x), dot(d, luminaire.axes.y), dot(d, luminaire.axes.z)};
}

bool is_near(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p) {
  const double near = kNear * largest_length(luminaire.web->opening.size);
  const Vec3 d = p - position;
  return dot(d, d) < near * near;
}

}  // namespace

Spectrum intensity(const WebLuminaire& luminaire, const Vec3& d) {
  return luminaire.scale * candela_towards(*luminaire.web, to_luminaire_frame(luminaire, d));
}

Spectrum power(const WebLuminaire& luminaire) { return luminaire.scale * luminaire.web->flux; }

LightBounds bounds(const WebLuminaire& luminaire, const Vec3& position) {
  const auto& [x, y, z] = luminaire.axes;
  const Vec3 half = luminaire.web->opening.size / 2;
  const auto along = [&](int axis) {
    return std::abs(x[axis]) * half.x + std::abs(y[axis]) * half.y + std::abs(z[axis]) * half.z;
  };
  const Vec3 box{along(0), along(1), along(2)};
  const double cone = beam_half_angle(*luminaire.web);
  return {position - box, position + box, cone < std::numbers::pi ? -z : Vec3{}, cone,
          luminous_mean(luminaire.scale) * peak_candela(*luminaire.web)};
}

void turn_into_image(WebLuminaire& luminaire, const MirrorPlane& mirror) {
  for (Vec3* axis : {&luminaire.axes.x, &luminaire.axes.y, &luminaire.axes.z}) *axis = mirror.image_of_direction(*axis);
}

double reach(const WebLuminaire& luminaire) {
  const Face f = face(luminaire);
  return std::hypot(f.a, f.b) / 2;
}

int opening_rays(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p) {
  if (!is_near(luminaire, position, p)) return 1;
  const Vec3 at = to_luminaire_frame(luminaire, p - position), half = luminaire.web->opening.size / 2;
  const auto beside = [](double x, double limit) { return std::max(0.0, std::abs(x) - limit); };
  const double gap = length({beside(at.x, half.x), beside(at.y, half.y), beside(at.z, half.z)});
  const double size = largest_length(luminaire.web->opening.size);
  const Vec3 d = p - position;
  if (dot(d, d) >= 25 * size * size) return 4;
  return gap >= size ? 16 : gap >= size / 2 ? 64 : 256;
}

OpeningPlace opening_place(const WebLuminaire& luminaire, int k, int count) {
  static const GaussLegendre<1> one;
  static const GaussLegendre<2> two;
  static const GaussLegendre<4> four;
  static const GaussLegendre<8> eight;
  static const GaussLegendre<16> sixteen;
  static const GaussLegendre<32> thirty_two;
  const Face f = face(luminaire);
  const auto place = [&](const auto& across, const auto& along) -> OpeningPlace {
    const std::size_t n = along.node.size(), i = static_cast<std::size_t>(k) / n, j = static_cast<std::size_t>(k) % n;
    const double x = (1 + across.node[i]) / 2, y = (1 + along.node[j]) / 2, turn = 1.0 / static_cast<double>(n);
    if (f.round) return {x, (static_cast<double>(j) + 0.5) * turn, across.weight[i] / 2 * turn};  // even around
    const double weight = across.weight[i] * along.weight[j] / 4;
    return f.a <= f.b ? OpeningPlace{x, y, weight} : OpeningPlace{y, x, weight};
  };
  const bool tube = !f.round && std::max(f.a, f.b) > 3 * std::min(f.a, f.b);  // its shadows are as long
  switch (count) {
    case 1:
      return {};
    case 4:
      return tube ? place(one, four) : place(two, two);
    case 16:
      return tube ? place(two, eight) : place(four, four);
    case 64:
      return tube ? place(four, sixteen) : place(eight, eight);
    default:
      return tube ? place(eight, thirty_two) : place(sixteen, sixteen);
  }
}

Vec3 light_point(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p, double u, double v) {
  if (!is_near(luminaire, position, p)) return position;
  const Face f = face(luminaire);
  double a = u - 0.5, b = v - 0.5;
  if (f.round) {
    const double r = std::sqrt(u) / 2, phi = 2 * std::numbers::pi * v;
    a = r * std::cos(phi), b = r * std::sin(phi);
  }
  return position + f.along_a * (f.a * a) + f.along_b * (f.b * b);
}

Vec3 rim_point(const WebLuminaire& luminaire, const Vec3& position, const Vec3& p, double around) {
  constexpr double kRim = 1 - 1e-9;  // u and v end before 1
  if (face(luminaire).round) return light_point(luminaire, position, p, kRim, around);
  const double side = 4 * around, along = side - std::floor(side), back = kRim - along;
  if (side < 1) return light_point(luminaire, position, p, along, 0);
  if (side < 2) return light_point(luminaire, position, p, kRim, along);
  if (side < 3) return light_point(luminaire, position, p, back, kRim);
  return light_point(luminaire, position, p, 0, back);
}

double least_r2(const WebLuminaire& luminaire) {
  const Face f = face(luminaire);
  const double strip = std::max(f.a, f.b) / kSmallestShare;  // of an opening that is no more than a line
  return std::max(f.a * f.b / (kSmallestShare * std::numbers::pi), strip * strip);
}

double beam_half_angle(const PhotometricWeb& web) {
  if (web.type != WebType::C) return std::numbers::pi;
  const std::size_t n = web.vertical.size();
  std::size_t last = 0;  // highest angle with light
  for (std::size_t i = 0; i < web.candela.size(); ++i)
    if (web.candela[i] > 0) last = std::max(last, i % n);
  const double end = web.vertical[std::min(last + 1, n - 1)];
  return std::min(std::numbers::pi, end * std::numbers::pi / 180 + 1e-6);
}

}  // namespace clerestory
