#pragma once
// How much memory a solve takes, known from counts before it is taken.

#include <cstddef>
#include <optional>

namespace clerestory {

/// What decides the memory of a solve.
struct MemoryCounts {
  std::size_t input_triangles = 0;  ///< of the model as it was read
  std::size_t triangles = 0;        ///< of the mesh, before anything is halved
  std::size_t sides = 0;            ///< of these, that take part
  std::size_t elements = 0;         ///< sides, or what they were halved into
  std::size_t points = 0;           ///< of the lightmap
  std::size_t links = 0;
  std::size_t lanes = 0;  ///< layers x channels, of layers beside the joint light
};

/// Peak of the whole process [bytes], without a matrix, by constants fitted to measured peaks (the table is in
/// memory_estimate.cpp); within a factor of 1.5 of them. It is the same on any machine and with any number of threads,
/// so a result that was made to fit is as well.
std::size_t predicted_memory(const MemoryCounts& counts);

/// How far the hierarchical method may go.
struct MemoryPlan {
  std::size_t most_points = 0;    ///< of the lightmap
  std::size_t most_elements = 0;  ///< for transport
  int bundle_rays = 0, bright_rays = 0;
};

/// Rays below which nobody goes, and nothing halved: for patches that leave no room for more.
inline constexpr MemoryPlan kLeastPlan{.bundle_rays = 32, .bright_rays = 16};

/// What `wish` becomes so that the peak stays below `limit` [bytes]: fewer points first, then fewer rays and so fewer
/// links. Nothing when the patches alone are too many for it.
///
/// whole  counts before anything is halved: as many elements as sides, no links.
std::optional<MemoryPlan> plan_memory(const MemoryCounts& whole, const MemoryPlan& wish, std::size_t limit);

/// The limit below which there is no plan for these patches [bytes].
std::size_t least_memory(const MemoryCounts& whole);

/// Triangles of a mesh that plan_memory() will find a plan for, if about all of their sides take part; 0 when there is
/// no room for any.
std::size_t triangles_that_fit(std::size_t input_triangles, std::size_t limit);

}  // namespace clerestory
