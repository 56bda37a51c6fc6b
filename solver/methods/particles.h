#pragma once
// Particle tracing with density estimation: particles of equal flux land on the mesh, and what lands is counted.

#include <cstdint>

#include "solver/illumination/illumination.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/particles/surface_kernels.h"

namespace clerestory {

struct ParticleOptions {
  double particles = 400;  ///< sent for each patch; at least 2^15 in all
  KernelShape kernel = KernelShape::epanechnikov;
  double radius = 1;  ///< of the kernels, over that which suits the mesh and the particles [1]; benchmarks turn both
  std::uint64_t seed = 1;
};

/// Follows particles from all lights until roulette by the albedo ends them, and estimates the irradiance of every
/// patch, flux / area, and by a kernel around each point of the lightmap (surface_kernels.h). Particles come in 32
/// batches, each a stratified sequence of its own: their spread tells the standard errors, which are no less than what
/// one particle would add, and a run that is stopped has fewer of them. The energy balance is what the particles did,
/// so its imbalance is their noise.
///
/// map      null, or where points get E and std_error.
/// Threads: same bits for any thread count. Cost: about 1 us of a core for each surface a particle meets; 40 MB.
/// Source: Shirley et al., "Global illumination via density-estimation", 1995.
Solution trace_particles(const Illumination& light, const ParticleOptions& options, VertexLightmap* map = nullptr,
                         const Monitor& monitor = {});

}  // namespace clerestory
