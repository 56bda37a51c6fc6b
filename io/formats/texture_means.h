#pragma once
// Textures -> one colour a material.

#include <functional>
#include <string>

#include "io/formats/model.h"

namespace clerestory {

/// Multiplies what materials with a texture reflect and emit by the mean of the texture's pixels, in linear light;
/// their alpha does not count. What a texture cannot be read for keeps its plain colour; where that is white, which
/// exporters write under any texture, it becomes 0.5. Sets ModelMaterial::took and kept.
///
/// is_decided  materials that it is true for are left alone, and so are their files: the scene file says what they are.
/// All images are decoded in one child process (see run_apart.h), or each in its own where one of them ends that.
void take_texture_means(Model& model, const std::function<bool(const std::string& name)>& is_decided);

}  // namespace clerestory
