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
double least_r2(const Luminaire& luminaire) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return least_r2(kind);
        return 0.0;
      },
      luminaire.kind);
}

}  // namespace

Spectrum intensity(const Luminaire& luminaire, const Vec3& d) {
  return std::visit([&](const auto& kind) { return intensity(kind, d); }, luminaire.kind);
}

Spectrum power(const Luminaire& luminaire) {
  return std::visit([](const auto& kind) { return power(kind); }, luminaire.kind);
}

LightBounds bounds(const Luminaire& luminaire) {
  return std::visit([&](const auto& kind) { return bounds(kind, luminaire.position); }, luminaire.kind);
}

Luminaire image_of(Luminaire luminaire, const MirrorPlane& mirror) {
  luminaire.position = mirror.image_of(luminaire.position);
  std::visit([&](auto& kind) { turn_into_image(kind, mirror); }, luminaire.kind);
  return luminaire;
}

double reach(const Luminaire& luminaire) {
  return std::visit(
      [](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return reach(kind);
        return 0.0;
      },
      luminaire.kind);
}

int opening_rays(const Luminaire& luminaire, const Vec3& p) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return opening_rays(kind, luminaire.position, p);
        return 1;
      },
      luminaire.kind);
}

OpeningPlace opening_place(const Luminaire& luminaire, int k, int count) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return opening_place(kind, k, count);
        return OpeningPlace{};
      },
      luminaire.kind);
}

Vec3 light_point(const Luminaire& luminaire, const Vec3& p, double u, double v) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return light_point(kind, luminaire.position, p, u, v);
        return luminaire.position;
      },
      luminaire.kind);
}

Vec3 rim_point(const Luminaire& luminaire, const Vec3& p, double around) {
  return std::visit(
      [&](const auto& kind) {
        if constexpr (HasOpening<decltype(kind)>) return rim_point(kind, luminaire.position, p, around);
        return luminaire.position;
      },
      luminaire.kind);
}

Spectrum open_irradiance(const Luminaire& luminaire, const Vec3& q, const Vec3& p, const Vec3& n) {
  const Vec3 to_luminaire = q - p;
  const double r2 = dot(to_luminaire, to_luminaire), r = std::sqrt(r2), cos_r = dot(n, to_luminaire);
  if (!(cos_r > 0)) return Spectrum(0.0);
  return intensity(luminaire, to_luminaire / -r) * (cos_r / (std::max(r2, least_r2(luminaire)) * r));
}

Spectrum open_irradiance(const Luminaire& luminaire, const Vec3& p, const Vec3& n) {
  return open_irradiance(luminaire, luminaire.position, p, n);
}

}  // namespace clerestory
