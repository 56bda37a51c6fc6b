#pragma once
// Particles of light as they leave luminaires, sun, sky and what glows.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "solver/illumination/illumination.h"

namespace clerestory {

/// A particle.
struct Emitted {
  static constexpr std::uint32_t kNone = 0xffffffff;

  Ray ray;                      ///< starts off its surface; of sun and sky where it enters the box around the scene
  Spectrum flux;                ///< [W]; black: this one went nowhere
  PatchId patch;                ///< that glows; invalid for other lights
  std::uint32_t light = kNone;  ///< number of the luminaire or sun, as Layer::lights counts; kNone for sky and patches
  Vec3 normal;                  ///< of the patch; of other lights the direction of the ray
  /// [1/m2], with the choice of the light; of sun and sky per area at right angles to the ray. Of a luminaire the
  /// probability of the choice alone [1]: its light comes from all of its opening alike, whoever chooses the place.
  double density_place = 0;
  double density_direction = 0;  ///< [1/sr]

  bool is_sky() const { return light == kNone && !patch.valid(); }
};

/// Chooses particles in proportion to the flux of what sends them, so that their luminous flux is one for all
/// luminaires and patches. Sun and sky are looked for over the box around the scene, so that nothing is missed, and in
/// scenes with openings over these as well: as many particles as are worth the flux through the openings, which is what
/// rooms get of it, and no more than a third of that over the box. Both count together as one choice (one-sample
/// balance heuristic), so particles outside of rooms carry more, and those that openings let in less by up to a
/// quarter.
///
/// Lights of a Lights in mirrors send nothing: mirrors turn particles. Luminaires with an opening send from all over
/// it, whatever the distance. Directions of sky: cells of a table, each taken by its mean, so the flux varies by what
/// the radiance varies in a cell.
///
/// Cost: 16 bytes a glowing patch; with a sky 130,000 look-ups. sample(): 0.1 to 1 us. Thread safe.
class Emission {
 public:
  explicit Emission(const Illumination& light);
  ~Emission();
  Emission(Emission&&) noexcept;
  Emission& operator=(Emission&&) noexcept;

  bool empty() const;
  /// What all lights send, of sun and sky what enters the box around the scene [W], luminous mean: the mean of
  /// luminous_mean(Emitted::flux). Exact but for skies (1e-3).
  double flux() const;

  /// pick  chooses the light, u its place (0, 1) and direction (2, 3); all in [0, 1).
  Emitted sample(double pick, const std::array<double, 4>& u) const;

  // What sample() has the density of; 0 where it never sends any.
  /// Emitted::density_place of a patch, at any of its points; its directions have the density cosine / pi.
  double density_of_patch(PatchId p) const;
  /// Probability of the choice of a luminaire, by number.
  double probability_of_luminaire(std::uint32_t number) const;
  /// Emitted::density_direction of a luminaire.
  double density_of_direction(std::uint32_t number, const Vec3& d) const;
  /// Emitted::density_place times density_direction for the sky along a whole line: through p, the light going along d
  /// (unit) [1/(m2 sr)].
  double density_of_sky(const Vec3& p, const Vec3& d) const;
  /// The same of a sun: number as in Emitted::light; d goes away from any point of its disc.
  double density_of_sun(std::uint32_t number, const Vec3& p, const Vec3& d) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace clerestory
