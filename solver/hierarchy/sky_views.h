#pragma once
// What leaves see of the sky: rays of their bundles that left the scene, kept like links.

#include <cstdint>
#include <functional>
#include <span>

#include "solver/hierarchy/links.h"
#include "solver/lights/sky.h"
#include "solver/model/element_tree.h"
#include "solver/model/patch_set.h"

namespace clerestory {

SkyView pack_sky_view(const Vec3& direction, const Spectrum& passes);

/// E_p = sum over sky views of weight * pi * passes * L(direction), for several skies at once. No rays.
///
/// skies    each of them gets `channels` lanes.
/// returns  N x (skies * channels), by PatchId [W/m2].
/// Threads: same bits for any thread count. Cost: the look-ups, 9 to 15 ns a view and sky.
Field sky_irradiance(const PatchSet& patches, const ElementTree& tree, const Transport& transport,
                     std::span<const SkyRadiance* const> skies);

/// The same for parts of the sky that are white and of radiance 1 each: part_of(direction) of them, in any order; none
/// of them where it says `parts` or more.
Field sky_irradiance_by_part(const PatchSet& patches, const ElementTree& tree, const Transport& transport,
                             std::size_t parts, const std::function<std::size_t(const Vec3&)>& part_of);

}  // namespace clerestory
