#pragma once
// What each layer of a result gives: parts of the light that can be dimmed.

#include "solver/model/channels.h"

namespace clerestory {

/// Layers side by side, lane layer * channels + channel. Their sums are the E and B of the whole light.
struct LayeredLight {
  Field E;           ///< P x lanes, by point of the lightmap [W/m2]; empty: there are no layers
  Field E_elements;  ///< N x lanes [W/m2]
  /// Of points and elements [W/m2]; empty where surfaces neither glow nor pass light on: then B is in proportion to E.
  Field B, B_elements;

  bool empty() const { return E.value.empty(); }
};

}  // namespace clerestory
