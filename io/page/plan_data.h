#pragma once
// What a page draws its plans anew from while its layers are dimmed, as elements of the page. io/page/layers.mjs reads
// it.
//
//   layers-head    JSON: colours from the least to the most
//   plan-N-head    JSON: columns and rows of the lattice, range of the colours, target; name and number of the set of
//                  sensors, none for a floor
//   plan-N-light   float32 [lx], layer by layer: of the lattice's places row by row, not a number where there is
//                  none; or of the dots
//
// Light is packed like that of io/page/solution_data.h.

#include <optional>
#include <span>
#include <string>

#include "io/page/plan.h"

namespace clerestory {

/// The bar of sliders, one a layer, with its words and colours: it comes before all that it changes.
std::string layer_sliders(std::span<const std::string> layers);

/// Of a plan with layers; nothing of others.
///
/// number  that the plan was drawn with
/// set     number of the set of sensors among those of the page's table
std::string plan_data(const Plan& plan, std::size_t number, const std::string& name, std::optional<std::size_t> set);

}  // namespace clerestory
