#pragma once
// One time of a series, from what was solved for all of them together.

#include <cstddef>

#include "pipeline/solved.h"

namespace clerestory {

/// What layer t of so many times says of its time, whose share of the mean it is.
Field light_of_time(const Field& lanes, std::size_t t, std::size_t times, int channels);

/// What is around the surfaces at time t of Scene::times: as a scene of that time alone would have it, but for its
/// polygons and materials, which the result has.
Scene scene_at(const Scene& series, std::size_t t);

/// The result of time t: its light on the elements, points and sensors of the series, its energy and its own error.
///
/// series  with layers; solved for a scene of several times.
Solved solved_at(const Solved& series, std::size_t t);

}  // namespace clerestory
