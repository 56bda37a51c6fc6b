#pragma once
// Caustics at the very place that is seen: a photon map of what lands there.

#include "solver/illumination/problem.h"
#include "solver/particles/photon_map.h"

namespace clerestory {

class CausticPhotons {
 public:
  /// problem  with its caustics; points: lightmap of its patches. Both outlive this.
  CausticPhotons(const Problem& problem, const VertexLightmap& points);

  /// What a place sends to the eye of them: diffuse E + sum of lobe E_photon.
  ///
  /// p  local frame; n: unit normal of the facet there, on the eye's side; to_eye: unit; lobe: null, or the place's.
  Spectrum sent_on(const Vec3& p, const Vec3& n, const Vec3& to_eye, const Spectrum& diffuse, const Lobe* lobe) const;

 private:
  const Problem& problem_;
  PhotonMap map_;
  SmoothSurface surface_;
  double radius_;
};

}  // namespace clerestory
