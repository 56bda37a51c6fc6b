#include "solver/view/caustic_photons.h"

#include <algorithm>
#include <vector>

#include "solver/illumination/caustic_legs.h"
#include "solver/sampling/packed_direction.h"

namespace clerestory {
namespace {

constexpr double kLargest = 1.0 / 40;  // radius over the scene's diameter
constexpr std::size_t kPhotons = 128;  // that tell a place
constexpr double kReach = 1e-5;        // of the diameter: results are written as float

std::vector<Landing> photons_of(const Problem& problem) {
  std::vector<Landing> photons;
  const auto at = [](double x) { return static_cast<float>(x); };
  each_landing(problem, problem.lights.caustics.legs, [&](const CausticLanding& l) {
    photons.push_back(
        {{at(l.place.x), at(l.place.y), at(l.place.z)},
         {at(l.flux[0]), at(l.flux[1]), at(l.flux[2])},
         l.patch.value,
         pack_direction(-l.direction) | static_cast<std::uint32_t>(ParticleWay::turned) << kDirectionBits});
  });
  return photons;
}

}  // namespace

CausticPhotons::CausticPhotons(const Problem& problem, const VertexLightmap& points)
    : problem_(problem),
      map_(photons_of(problem)),
      surface_(problem.patches, points),
      radius_(kLargest * problem.rays.diameter()) {}

Spectrum CausticPhotons::sent_on(const Vec3& p, const Vec3& n, const Vec3& to_eye, const Spectrum& diffuse,
                                 const Lobe* lobe) const {
  const double reach = kReach * problem_.rays.diameter();
  const Hit below = problem_.rays.first_hit(problem_.patches, {p + n * reach, -n});
  if (below.reflected || !below.patch.valid() || below.distance > 2 * reach) return Spectrum(0.0);
  thread_local PhotonsAround room;
  Spectrum sent(0.0);
  photons_around(map_, surface_, p, below.patch, kPhotons, radius_, room, [&](const Landing& photon, double weight) {
    const auto& [r, g, b] = photon.flux;
    Spectrum share = diffuse;
    if (lobe) share += lobe->evaluate(n, photon.direction(), to_eye);
    sent += share * Spectrum(double{r}, double{g}, double{b}) * weight;
  });
  return {std::max(0.0, sent[0]), std::max(0.0, sent[1]), std::max(0.0, sent[2])};
}

}  // namespace clerestory
