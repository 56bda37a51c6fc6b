#pragma once
// The times that light is the mean of, as layers over one transport.

#include <vector>

#include "solver/lights/layers.h"

namespace clerestory {

/// The light of time t of the mean, all of it; images of its suns are its own, openings those of the mean.
Lights lights_at(const Lights& mean, std::size_t t);

/// A layer a time, with its share of the mean: all luminaires and what surfaces emit, its suns and their images, its
/// sky. Their sum is the mean; the light of a time is its layer times Lights::times.
std::vector<Layer> layers_of_times(const Lights& mean, const PatchSet& patches);

}  // namespace clerestory
