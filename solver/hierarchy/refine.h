#pragma once
// The oracle: which elements are halved.

#include <cstdint>

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/shortest_edge.h"
#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"

namespace clerestory {

struct RefineOptions {
  double tolerance = 0.1;
  ShortestEdge shortest_edge{};
  std::size_t most_elements = 1'000'000;
  std::uint64_t seed = 1;
};

/// What rays tell of the irradiance inside of a triangle, luminous [W/m2].
struct Variation {
  double E = 0;           ///< mean
  double difference = 0;  ///< between the two of its four parts that differ most, less three standard errors; >= 0
};

/// Four parts, halves of halves, send the same directions and ask the same points of bright sources: in the differences
/// most of the noise is gone. Sun and luminaires count, so an edge of their light is a difference.
///
/// light  as for trace_links(); B: radiosity of its patches.
Variation irradiance_variation(const Illumination& light, const Field& B, const std::array<Vec3, 3>& corners,
                               const Vec3& normal, std::uint64_t key, unsigned long long& rays);

/// Halves elements, and the halves again up to four times, while light varies inside of them by more than
///   difference > tolerance E   and   rho (A / A0) difference > tolerance / 2 * max(E, a quarter of the median E).
/// A0 is the size of a patch of the room if all were alike, of 2,000 to 10,000; the median is the room's. What a small
/// or a dark element gets wrong is little of the light that goes on from it. Each looks with its own rays at the light
/// as it was found on the leaves before.
///
/// returns  elements halved for their own sake; neighbours that conformity asks for are not counted.
std::size_t refine(ElementMesh& mesh, const Illumination& light, const Field& E, const Field& B,
                   const RefineOptions& options, unsigned long long& rays, const Monitor& monitor = {});

}  // namespace clerestory
