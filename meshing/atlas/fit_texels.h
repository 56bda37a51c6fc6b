#pragma once
// Values on points -> texels whose bilinear lookup is the field that is linear on triangles.

#include "solver/model/lightmap_atlas.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Texels x of a chart, by least squares over samples s of its triangles:
///   sum_s w_s (sum_i b_i(s) x_i - f(s))^2 + sum_i v_i (x_i - x0_i)^2,
///   w_s = weight / max(f(s), floor)^2,  v_i = small / max(x0_i, floor)^2,
/// b_i the bilinear weights of the four texels around s, x0 the planes of the triangles around continued to the texel's
/// centre: it tells the texels beyond a slanted rim that hardly any sample reaches. Weighted so, errors count as shares
/// of the light there. Samples lie 3 x 3 to a cell, and on all edges and points; on the chart's rim with more weight:
/// what lies beyond the seam is fitted to the same values there. Texels stay at or above 0 where values do.
///
/// value    P x channels; the first tells the weights.
/// returns  width x height x channels, row by row; those that no lookup reaches repeat the nearest.
/// Cost: O(texels + triangles); conjugate gradients, some 15 rounds.
std::vector<float> fit_texels(const WrittenResult& result, const AtlasChart& chart, const Field& value);

}  // namespace clerestory
