#pragma once
// Triangles of a result -> charts that can be laid flat without one part reaching into another's texels.

#include <vector>

#include "solver/model/lightmap_atlas.h"
#include "solver/model/monitor.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Flat parts of a surface are charts by projection on their plane; smaller facets that bend by at most 25 degrees are
/// projected together. A chart hangs together over edges whose two points are shared, is turned to its smallest
/// rectangle, and cut where
/// - a lookup would mix triangles that do not hang together there and differ by more than a percent in their light: two
///   sides of a partition on one floor; or parts of a bent surface that lie over each other,
/// - it is longer than kLongestChart, or
/// - it leaves much of its rectangle empty.
/// Cuts follow edges; no triangle is divided.
///
/// texels_per_metre  > 0; a chart has at least so many, and at least two texels each way.
/// returns           charts by their lowest triangle; x and y are not set. Every triangle is in one chart, unless the
///                   monitor stopped it.
/// Threads: same bits for any thread count. Cost: O(texels + triangles log triangles).
std::vector<AtlasChart> find_charts(const WrittenResult& result, double texels_per_metre, const Monitor& monitor = {});
inline constexpr int kLongestChart = 2048;  ///< texels, where it can be cut

}  // namespace clerestory
