#pragma once
// Light straight from luminaires and suns at the very place that is seen: finer than the vertices of a result.

#include <cstdint>
#include <optional>
#include <span>

#include "solver/illumination/gloss_light.h"
#include "solver/illumination/problem.h"
#include "solver/lights/light_choice.h"
#include "solver/model/sensors.h"
#include "solver/view/caustic_photons.h"

namespace clerestory {

/// A place on a surface, and who sees it.
struct SeenPlace {
  Vec3 p;                      ///< scene's frame [m]
  Vec3 facet;                  ///< unit normal there, on the eye's side
  Vec3 n;                      ///< the same of the surface that facets stand for; light falls and shines by this one
  Vec3 to_eye;                 ///< unit
  Spectrum diffuse{1.0};       ///< what is sent to the eye of irradiance; 1: the irradiance itself is asked for
  const Lobe* lobe = nullptr;  ///< of a glossy surface: sends on besides
};

/// Point `number` of a sequence that belongs to `key`: the first 2^k together are well spread.
struct Draw {
  std::uint64_t key = 0;
  std::uint32_t number = 0;
};

/// What a point receives straight from lights, and within which bounds that is certain: a point on the edge of a
/// shadow may have all or nothing.
struct StraightLight {
  Spectrum E{0.0}, low{0.0}, high{0.0};  ///< [W/m2]
};

/// Suns and luminaires have an area: each place looks at one point of it, so that many places show soft shadows. Up to
/// 8 shadow rays a place; where more lights could be seen, or of more than 64 any, they go to those that would be
/// brightest there, as often as they would be, so that the mean is right. Thread safe.
class FineLight {
 public:
  /// problem  the scene that was solved, with images of its lights; outlives this
  /// points   null, or the lightmap of its patches, for its caustics; outlives this
  explicit FineLight(const Problem& problem, const VertexLightmap* points = nullptr);

  /// There are no luminaires and no suns.
  bool empty() const { return luminaires() + suns() == 0; }

  /// What the place sends to the eye of light that comes to it straight from luminaires and suns, over mirrors and
  /// through panes too: diffuse E + sum of lobe E_light. All light at a place that is sharper than the field of
  /// vertices is this and caustics().
  Spectrum sent_on(const SeenPlace& at, const Draw& draw) const;
  /// The same of caustics, by the photons around it: smooth within a pixel.
  Spectrum caustics(const SeenPlace& at) const;

  /// Irradiance by caustics at points (scene's frame), as a result has it: P x channels [W/m2]; empty without any.
  Field caustics_at(std::span<const SensorPoint> points) const;

  /// Irradiance of a plane of unit normal n at p (scene's frame), by up to 16 shadow rays to each light.
  StraightLight at_point(const Vec3& p, const Vec3& n) const;
  /// Irradiance there of their light that glossy surfaces turn to it, by `pairs` of rays (gloss_light.h).
  Spectrum by_gloss(const Vec3& p, const Vec3& n, int pairs, std::uint64_t key) const;
  /// Whether there is any of that.
  bool has_gloss() const { return !gloss_.empty(); }

 private:
  struct Candidate;
  std::uint32_t luminaires() const { return static_cast<std::uint32_t>(problem_.lights.luminaires.size()); }
  std::uint32_t suns() const { return static_cast<std::uint32_t>(problem_.lights.suns.size()); }
  Candidate candidate(std::uint32_t light, const Vec3& p, const SeenPlace& at, double u, double v) const;

  const Problem problem_;
  std::optional<CausticPhotons> caustics_;
  LightChoice choice_;  ///< empty unless lights are too many to look at all
  GlossLight gloss_;
};

}  // namespace clerestory
