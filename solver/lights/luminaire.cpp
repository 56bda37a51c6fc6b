#include "solver/lights/luminaire.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/lights/point_luminaire.h"
#include "solver/lights/spot_luminaire.h"
#include "solver/lights/web_luminaire.h"

namespace clerestory {
namespace {

/// Kinds with an opening; the light of others comes from their position.
template <class Kind>
concept HasOpening = requires(const Kind& kind, const Vec3& p) {
  opening_rays(kind, p, p);
};

/// What r2 counts as at least [m2].
double least_r2(const Luminaire& lamp) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return least_r2(kind);
        return 0.0;
      },
      lamp.kind);
}

}  // namespace

Spectrum intensity(const Luminaire& lamp, const Vec3& d) {
  return std::visit([&](const auto& kind) { return intensity(kind, d); }, lamp.kind);
}

Spectrum power(const Luminaire& lamp) {
  return std::visit([](const auto& kind) { return power(kind); }, lamp.kind);
}

LightBounds bounds(const Luminaire& lamp) {
  return std::visit([&](const auto& kind) { return bounds(kind, lamp.position); }, lamp.kind);
}

Luminaire image_of(Luminaire lamp, const MirrorPlane& mirror) {
  lamp.position = mirror.image_of(lamp.position);
  std::visit([&](auto& kind) { turn_into_image(kind, mirror); }, lamp.kind);
  return lamp;
}

double reach(const Luminaire& lamp) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return reach(kind);
        return 0.0;
      },
      lamp.kind);
}

int opening_rays(const Luminaire& lamp, const Vec3& p) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return opening_rays(kind, lamp.position, p);
        return 1;
      },
      lamp.kind);
}

OpeningPlace opening_place(const Luminaire& lamp, int k, int count) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return opening_place(kind, k, count);
        return OpeningPlace{};
      },
      lamp.kind);
}

Vec3 light_point(const Luminaire& lamp, const Vec3& p, double u, double v) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return light_point(kind, lamp.position, p, u, v);
        return lamp.position;
      },
      lamp.kind);
}

Spectrum open_irradiance(const Luminaire& lamp, const Vec3& q, const Vec3& p, const Vec3& n) {
  const Vec3 to_lamp = q - p;
  const double r2 = dot(to_lamp, to_lamp), r = std::sqrt(r2), cos_r = dot(n, to_lamp);
  if (!(cos_r > 0)) return Spectrum(0.0);
  return intensity(lamp, to_lamp / -r) * (cos_r / (std::max(r2, least_r2(lamp)) * r));
}

Spectrum open_irradiance(const Luminaire& lamp, const Vec3& p, const Vec3& n) {
  return open_irradiance(lamp, lamp.position, p, n);
}

Vec3 short_of(const Vec3& q, const Vec3& p, double lift) {
  const Vec3 back = p - q;
  const double r = length(back);
  return r > 0 ? q + back * std::min(0.5, 20 * lift / r) : q;
}

}  // namespace clerestory
