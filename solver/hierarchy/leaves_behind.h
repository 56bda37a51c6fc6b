#pragma once
// Which leaves of a diffuser's two sides lie back to back.

#include <cstdint>
#include <span>

#include "solver/model/patch_set.h"

namespace clerestory {

/// Fills leaves.tau, behind_begin and behind when `patches` has diffusers. The two sides are halved apart, so a leaf
/// may have a part of one leaf behind it, or many: shares are areas of overlap, and light that goes through keeps its
/// flux.
///
/// patches        before any was halved.
/// leaves         its leaves in the order of the patches, patch by patch; all else filled.
/// patch_of_leaf  N of leaves, PatchId of `patches`.
void find_leaves_behind(const PatchSet& patches, std::span<const std::uint32_t> patch_of_leaf, PatchSet& leaves);

}  // namespace clerestory
