#pragma once
// Light followed from where it starts to where it ends, through a scene of rectangles: a tracer that shares nothing
// with the solver but its vectors. Slow and simple: it judges.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "solver/model/vec.h"

namespace clerestory::test {

/// A parallelogram with right angles: corner, and sides that are at right angles to each other.
struct TracedRectangle {
  enum Kind { diffuse, mirror, glass };
  Vec3 corner, u, v;
  Kind kind = diffuse;
  double value = 0.5;  ///< reflectance; of glass its transmittance at normal incidence
};

/// What a sheet of glass of refractive index 1.52 does, by Fresnel's equations and by following the light between its
/// two faces until nothing is left of it.
struct TracedSheet {
  double transmitted = 0, reflected = 0;

  TracedSheet(double cosine, double absorbed_within) {
    constexpr double kIndex = 1.52;
    const double inside = std::asin(std::sqrt(1 - cosine * cosine) / kIndex), outside = std::acos(cosine);
    const double within = std::exp(-absorbed_within / std::cos(inside));
    double face[2];
    if (outside < 1e-6) {
      face[0] = face[1] = std::pow((kIndex - 1) / (kIndex + 1), 2);
    } else {
      face[0] = std::pow(std::sin(outside - inside) / std::sin(outside + inside), 2);
      face[1] = std::pow(std::tan(outside - inside) / std::tan(outside + inside), 2);
    }
    for (const double R : face) {
      reflected += R / 2;
      double light = (1 - R) / 2;
      for (bool at_back = true; light > 1e-12; at_back = !at_back) {
        light *= within;
        (at_back ? transmitted : reflected) += light * (1 - R);
        light *= R;
      }
    }
  }

  /// What makes a sheet pass `transmittance` at normal incidence: bisected.
  static double absorption(double transmittance) {
    double low = 0, high = 50;
    for (int k = 0; k < 200; ++k) {
      const double middle = (low + high) / 2;
      (TracedSheet(1, middle).transmitted > transmittance ? low : high) = middle;
    }
    return low;
  }
};

/// Flux [W] that lands on each rectangle, on the side of cross(u, v) and on the other.
class PhotonTracer {
 public:
  struct Photon {
    Vec3 position, direction;
  };
  using Random = std::mt19937_64;

  explicit PhotonTracer(std::vector<TracedRectangle> scene) : scene_(std::move(scene)), landed_(scene_.size()) {
    for (const TracedRectangle& r : scene_) {
      normal_.push_back(normalized(cross(r.u, r.v)));
      absorption_.push_back(r.kind == TracedRectangle::glass ? TracedSheet::absorption(r.value) : 0);
    }
  }

  static double uniform(Random& random) { return std::uniform_real_distribution<double>(0, 1)(random); }
  static Vec3 anywhere(Random& random) {
    const double z = 1 - 2 * uniform(random), phi = 2 * std::numbers::pi * uniform(random), r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  /// In proportion to the cosine to n.
  static Vec3 scattered(const Vec3& n, Random& random) { return normalized(n + anywhere(random)); }

  /// Follows `count` photons that share `flux`.
  void follow(std::size_t count, double flux, const std::function<Photon(Random&)>& start, std::uint64_t seed = 1) {
    Random random(seed);
    for (std::size_t k = 0; k < count; ++k) follow(start(random), flux / static_cast<double>(count), random);
  }

  /// Mean irradiance on the side that the normal shows, or on the other [W/m2].
  double irradiance(std::size_t rectangle, bool front = true) const {
    const TracedRectangle& r = scene_[rectangle];
    return landed_[rectangle][front ? 0 : 1] / (length(r.u) * length(r.v));
  }
  double escaped() const { return escaped_; }

 private:
  void follow(Photon photon, double flux, Random& random) {
    for (;;) {
      std::size_t met = scene_.size();
      double nearest = 1e300;
      for (std::size_t k = 0; k < scene_.size(); ++k) {
        const TracedRectangle& r = scene_[k];
        const double along = dot(normal_[k], photon.direction);
        if (std::abs(along) < 1e-12) continue;
        const double t = dot(normal_[k], r.corner - photon.position) / along;
        if (!(t > 1e-9) || t >= nearest) continue;
        const Vec3 x = photon.position + photon.direction * t - r.corner;
        const double a = dot(x, r.u) / dot(r.u, r.u), b = dot(x, r.v) / dot(r.v, r.v);
        if (a < 0 || a > 1 || b < 0 || b > 1) continue;
        nearest = t, met = k;
      }
      if (met == scene_.size()) {
        escaped_ += flux;
        return;
      }
      const TracedRectangle& r = scene_[met];
      const double along = dot(normal_[met], photon.direction);
      const Vec3 up = along < 0 ? normal_[met] : -normal_[met];
      photon.position += photon.direction * nearest;
      const Vec3 turned = photon.direction - normal_[met] * (2 * along);
      if (r.kind == TracedRectangle::glass) {
        const TracedSheet sheet(std::min(1.0, std::abs(along)), absorption_[met]);
        const double u = uniform(random);
        if (u < sheet.reflected)
          photon.direction = turned;
        else if (u >= sheet.reflected + sheet.transmitted)
          return;
        continue;
      }
      if (r.kind == TracedRectangle::diffuse) landed_[met][along < 0 ? 0 : 1] += flux;
      if (uniform(random) >= r.value) return;
      photon.direction = r.kind == TracedRectangle::mirror ? turned : scattered(up, random);
    }
  }

  std::vector<TracedRectangle> scene_;
  std::vector<Vec3> normal_;
  std::vector<double> absorption_;
  std::vector<std::array<double, 2>> landed_;
  double escaped_ = 0;
};

}  // namespace clerestory::test
