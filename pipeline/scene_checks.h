#pragma once
// What a person would notice at a look and a solver would not.

#include <vector>

#include "pipeline/observer.h"
#include "solver/evaluate/sensor_planes.h"
#include "solver/illumination/problem.h"
#include "solver/model/method.h"
#include "solver/model/scene.h"

namespace clerestory {

/// Whether anything that is used in the scene gives light.
bool has_light(const Scene& scene);

/// throws  InputError that says how to add light, when nothing in the scene gives any.
void require_light(const Scene& scene);

/// What the reader assumed or left out, and material rules that match nothing.
void warn_about_scene(const Scene& scene, Observer& observer);

/// Luminaires outside every room, sensors inside solids, and light off mirrors that the method does not follow.
///
/// returns  numbers of the sensors' planes that lie inside solids, ascending.
std::vector<std::size_t> warn_about_places(const Problem& problem, const Scene& scene, const SensorPlanes& sensors,
                                           Method method, Observer& observer);

}  // namespace clerestory
