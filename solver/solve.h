#pragma once
// Problem -> Solution, by the method asked for.

#include <cstdint>

#include "solver/model/method.h"
#include "solver/model/monitor.h"
#include "solver/model/solution.h"
#include "solver/problem.h"

namespace clerestory {

struct SolveOptions {
  Method method = Method::hierarchical;
  Accuracy accuracy = Accuracy::standard;
  std::uint64_t seed = 1;
  std::size_t memory_limit = 0;  ///< the peak of the process stays below by making the result coarser [bytes]; 0: none
  int tighten = 0;               ///< times that the ray counts were doubled to reach a target error
};

/// Triangles to aim for when no longest edge is given; few where elements are halved later.
double target_triangles(Method method, Accuracy accuracy);

/// Paths from each patch or vertex by the method `path`; sensors get four times as many.
int paths_per_point(const SolveOptions& options);

/// Radiosity and irradiance of every patch, by any method but the hierarchical one, which makes patches of its own
/// (solve_hierarchical.h).
///
/// throws   InputError when the method needs more memory than there is.
/// Stops early when the monitor says so, and returns what is solved so far, marked in Solution::stop.
/// Threads: same bits for any thread count.
Solution solve(const Problem& problem, const SolveOptions& options, const Monitor& monitor = {});

}  // namespace clerestory
