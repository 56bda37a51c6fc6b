#pragma once
// The lobe of a glossy surface: light that it sends on around the direction of a mirror.

#include <array>
#include <optional>
#include <vector>

#include "solver/model/channels.h"
#include "solver/model/vec.h"

namespace clerestory {

/// What double tells from a mirror.
inline constexpr double kMostExponent = 1e6, kLeastRoughness = 0.01;

/// As a scene gives it.
struct Gloss {
  Spectrum specular{0.0};            ///< albedo of the lobe at normal incidence [1]
  std::optional<double> exponent{};  ///< of modified Phong, in [0, kMostExponent]
  double roughness = 0.3;  ///< of GGX, where there is no exponent: alpha is its square; in [kLeastRoughness, 1]

  friend bool operator==(const Gloss&, const Gloss&) = default;
};

/// Ready to be sampled. All directions are unit and away from the surface, whose unit normal n is on their side; from
/// below nothing comes and nothing goes there.
///
/// Modified Phong: f = specular (e + 2) / (2 pi) cos^e, of the angle to the mirror's direction. Its albedo is
/// `specular` at normal incidence and falls to grazing, where the surface cuts the lobe.
/// GGX: microfacets with height-correlated shadowing, and what they lose by it among themselves given back
/// (Kulla & Conty), so that the albedo is `specular` at all angles. No Fresnel term: the scene's number is the lobe's.
/// Both are reciprocal, and reflect no more than `specular` at any angle.
/// Sources: Lafortune & Willems, "Using the modified Phong reflectance model for physically based rendering", 1994;
/// Walter et al., "Microfacet models for refraction through rough surfaces", 2007; Heitz, "Sampling the GGX
/// distribution of visible normals", 2018; Kulla & Conty, "Revisiting physically based shading at Imageworks", 2017.
class Lobe {
 public:
  explicit Lobe(const Gloss& gloss);

  /// f [1/sr], the same for both orders.
  Spectrum evaluate(const Vec3& n, const Vec3& a, const Vec3& b) const { return specular_ * shape(n, a, b); }
  /// Of sample() [1/sr].
  double density(const Vec3& n, const Vec3& from, const Vec3& to) const;

  struct Sample {
    Vec3 direction;
    double density = 0;    ///< [1/sr]; 0: below the surface, and the light of it is lost
    Spectrum weight{0.0};  ///< f cos / density
  };
  /// u, v in [0, 1).
  Sample sample(const Vec3& n, const Vec3& from, double u, double v) const;

  /// Gloss::specular.
  const Spectrum& specular() const { return specular_; }
  /// Share that the lobe reflects of light from an angle of that cosine [1].
  Spectrum albedo(double cosine) const;
  /// How narrow it is: about the exponent e of a cos^e around the mirror's direction.
  double sharpness() const;

 private:
  double shape(const Vec3& n, const Vec3& a, const Vec3& b) const;
  double facet_albedo(double cosine) const;

  Spectrum specular_;
  bool is_phong_;
  double exponent_ = 0, alpha_ = 1;
  std::vector<double> facet_albedo_;  ///< of GGX without what is given back, by the root of the cosine
  double lost_ = 0;                   ///< its mean over the hemisphere, taken off 1
};

}  // namespace clerestory
