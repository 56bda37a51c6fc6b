#pragma once
// Colours of the map as style sheets write them.

#include <string>

namespace clerestory {

/// "#21918c" of t in [0, 1] (clipped): viridis.
std::string css_colour(double t);

}  // namespace clerestory
