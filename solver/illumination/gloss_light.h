#pragma once
// Light of luminaires and suns that glossy surfaces send on by their lobes: what no shadow ray finds.

#include <array>
#include <cstdint>
#include <optional>

#include "solver/illumination/light_rows.h"
#include "solver/illumination/problem.h"
#include "solver/lights/light_choice.h"
#include "solver/model/random_stream.h"

namespace clerestory {

/// Irradiance [W/m2] by lobes, of light that is there straight from luminaires and suns.
struct GlossIrradiance {
  Spectrum luminaires{0.0}, suns{0.0};

  Spectrum sum() const { return luminaires + suns; }
};

/// A receiver looks for it in two ways, weighted by the balance heuristic: by a ray all around, and by one about where
/// the plane of a glossy surface shows the image of a light, as narrow as the lobe is from there. Where either ends on
/// a glossy surface, a light is chosen for a shadow ray from that place, and counts by the lobe's value:
///   E = integral over the directions d of cos(d) L(d),   L = f(from the light, to the receiver) E_light at the place
/// The first kind also follows what panes turn back and lobes send on, to glossy surfaces behind. Both are unbiased;
/// but what the first finds alone is the noisier the narrower the lobe, and of one narrower than its rays can tell
/// nothing is found in practice: gloss behind gloss, mirrors or panes. Where Lights::caustics are known, light that
/// meets a narrow lobe in none of the 64 planes first is theirs, and left out here.
class GlossLight {
 public:
  /// problem  outlives this.
  explicit GlossLight(const Problem& problem);

  /// There is no gloss, or no such light.
  bool empty() const { return lights_.empty(); }

  /// At p (lifted) on a plane of unit normal n, by `count` pairs of rays; 0 when empty.
  /// row: null, or where to add what comes of each light.
  GlossIrradiance irradiance(const Vec3& p, const Vec3& n, int count, std::uint64_t key, LightRow* row = nullptr) const;
  /// The same by one pair of the caller's numbers in [0, 1).
  using Numbers = std::array<std::array<double, 4>, 3>;
  GlossIrradiance by_one_pair(const Vec3& p, const Vec3& n, const Numbers& u, RandomStream& random,
                              LightRow* row = nullptr) const;

  static constexpr unsigned kRaysOfPair = 5;

 private:
  /// Of a light, as a luminaire's or sun's number is, in a glossy plane.
  struct Image {
    std::uint32_t plane, light;
  };
  Image image(std::uint32_t number) const;
  std::optional<std::uint32_t> number_of_image(const Image& image) const;
  struct Place;
  class Look;

  const Problem& problem_;
  bool leaves_narrow_;  ///< lobes of no plane, which particles follow (Lights::caustics)
  LightChoice lights_, images_;
  std::uint32_t planes_with_images_ = 0;
};

}  // namespace clerestory
