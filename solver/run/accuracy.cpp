#include "solver/run/accuracy.h"

#include <cmath>

#include "solver/hierarchy/trace_links.h"
#include "solver/methods/hierarchical.h"
#include "solver/methods/particles.h"
#include "solver/methods/path.h"
#include "solver/methods/progressive.h"

namespace clerestory {
namespace {

// What they reach is in tests/bench/README.md and docs/accuracy.md.

constexpr Effort kDraft{
    .triangles_to_halve = 1400,
    .triangles = 2000,
    .bundle_rays = 128,
    .bright_rays = 64,
    .element_tolerance = 0.3,
    .vertex_tolerance = 0.1,
    .shortest_edge = 1.0 / 4,
    .most_points = 100'000,
    .caustic_particles = 131072,
    .caustic_legs = 800,
    .vertices = {.bundle = {8, 64, 256}, .area = {0, 1, 0.02, 128}, .bright_rays = 32, .sun_rays = 8, .noise = 0.1},
    .sensors = {.bundle = {16, 256, 512}, .area = {1, 3, 0.01, 512}, .bright_rays = 64, .sun_rays = 16, .noise = 0.1},
    .gathers_vertices = false,
    .direct = {.shadow_rays = 16, .edge_rays = 64, .sky_rays = 128},
    .closure_rays = 32,
    .stop_fraction = 1e-2,
    .rays_per_patch = 64,
    .noisy_patches = {.bundle = {16, 256, 256}, .area = {1, 3, 0.01, 512}, .bright_rays = 64, .sun_rays = 16},
    .paths = 64,
    .paths_of_sensor = 256,
    .particles = 100,
    .error = {.points = 64, .paths = 256, .rays = 6e4, .gather = {{8, 128, 1024}, {0, 2, 0.02, 256}, 32, 16, 0.07}},
    .year = {145, 12, 0, 8, 12, 128, 64},
};

constexpr Effort kStandard{
    .triangles_to_halve = 2800,
    .triangles = 6000,
    .bundle_rays = 256,
    .bright_rays = 128,
    .element_tolerance = 0.1,
    .vertex_tolerance = 0.05,
    .shortest_edge = 1.0 / 8,
    .most_points = 400'000,
    .caustic_particles = 524288,
    .caustic_legs = 1600,
    .vertices = {.bundle = {16, 256, 768}, .area = {1, 3, 0.01, 512}, .bright_rays = 32, .sun_rays = 16, .noise = 0.06},
    .sensors =
        {.bundle = {16, 256, 2048}, .area = {2, 6, 0.003, 8192}, .bright_rays = 256, .sun_rays = 32, .noise = 0.05},
    .gathers_vertices = true,
    .direct = {.shadow_rays = 16, .edge_rays = 256, .sky_rays = 256},
    .closure_rays = 64,
    .stop_fraction = 3e-3,
    .rays_per_patch = 256,
    .noisy_patches = {.bundle = {16, 256, 512}, .area = {1, 3, 0.01, 512}, .bright_rays = 64, .sun_rays = 16},
    .paths = 256,
    .paths_of_sensor = 1024,
    .particles = 400,
    .error = {.points = 256, .paths = 128, .rays = 1.5e5, .gather = {{16, 256, 2048}, {1, 3, 0.01, 512}, 32, 16, 0.04}},
    .year = {577, 8, 64, 16, 16, 256, 256},
};

// The kernels' own defaults are the recommended values: those of `standard`.
static_assert(HierarchyOptions{}.bundle_rays == kStandard.bundle_rays &&
              HierarchyOptions{}.bright_rays == kStandard.bright_rays &&
              HierarchyOptions{}.tolerance == kStandard.element_tolerance);
static_assert(LinkOptions{}.bundle_rays == kStandard.bundle_rays && LinkOptions{}.bright_rays == kStandard.bright_rays);
static_assert(DirectOptions{}.shadow_rays == kStandard.direct.shadow_rays &&
              DirectOptions{}.edge_rays == kStandard.direct.edge_rays &&
              DirectOptions{}.sky_rays == kStandard.direct.sky_rays);
static_assert(ShootOptions{}.stop_fraction == kStandard.stop_fraction &&
              ShootOptions{}.rays_per_patch == kStandard.rays_per_patch);
static_assert(PathOptions{}.paths == kStandard.paths && ParticleOptions{}.particles == kStandard.particles);

constexpr Effort kFine{
    .triangles_to_halve = 5000,
    .triangles = 20'000,
    .bundle_rays = 256,
    .bright_rays = 256,
    .element_tolerance = 0.05,
    .vertex_tolerance = 0.035,
    .shortest_edge = 1.0 / 16,
    .most_points = 1'600'000,
    .caustic_particles = 2097152,
    .caustic_legs = 3200,
    .vertices =
        {.bundle = {16, 512, 2048}, .area = {1, 4, 0.005, 2048}, .bright_rays = 128, .sun_rays = 32, .noise = 0.05},
    .sensors =
        {.bundle = {16, 1024, 8192}, .area = {2, 6, 0.0015, 16384}, .bright_rays = 512, .sun_rays = 64, .noise = 0.03},
    .gathers_vertices = true,
    .direct = {.shadow_rays = 64, .edge_rays = 1024, .sky_rays = 1024},
    .closure_rays = 128,
    .stop_fraction = 1e-3,
    .rays_per_patch = 1024,
    .noisy_patches = {.bundle = {16, 256, 1024}, .area = {1, 3, 0.01, 512}, .bright_rays = 64, .sun_rays = 16},
    .paths = 1024,
    .paths_of_sensor = 4096,
    .particles = 1600,
    .error = {.points = 512, .paths = 512, .rays = 1e6, .gather = {{16, 256, 4096}, {1, 3, 0.01, 512}, 64, 32, 0.03}},
    .year = {2305, 5, 256, 32, 24, 512, 1024},
};

void tighten(GatherQuality& quality, int times) {
  quality.bundle.rays <<= times;
  quality.bundle.most_rays <<= times;
  quality.area.most_rays <<= times;
  quality.noise *= std::pow(0.5, times / 2.0);  // as noise falls with rays
}

}  // namespace

Effort effort(Accuracy accuracy, int times) {
  Effort e = accuracy == Accuracy::draft ? kDraft : accuracy == Accuracy::standard ? kStandard : kFine;
  for (int* rays :
       {&e.bundle_rays, &e.bright_rays, &e.direct.edge_rays, &e.direct.sky_rays, &e.paths, &e.paths_of_sensor})
    *rays <<= times;
  e.rays_per_patch = std::ldexp(e.rays_per_patch, times);
  e.particles = std::ldexp(e.particles, times);
  e.caustic_particles = std::ldexp(e.caustic_particles, times);
  e.vertex_tolerance *= std::pow(kTighterEdge, times);
  tighten(e.vertices, times);
  tighten(e.sensors, times);
  // A small error needs a sharp measurement.
  e.error.points <<= times;
  e.error.rays *= std::pow(4.0, times);
  return e;
}

}  // namespace clerestory
