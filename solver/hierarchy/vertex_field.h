#pragma once
// Irradiance at vertices, with more of them where straight lines between them would be wrong.

#include "solver/hierarchy/element_mesh.h"
#include "solver/hierarchy/shortest_edge.h"
#include "solver/illumination/light_rows.h"
#include "solver/illumination/problem.h"
#include "solver/model/monitor.h"
#include "solver/model/slit_light.h"
#include "solver/sampling/gather_pattern.h"

namespace clerestory {

class FineRadiosity;

struct FieldOptions {
  double tolerance = 0.05;  ///< an element is halved where interpolation may err by more, of the irradiance there [1]
  ShortestEdge shortest_edge{};  ///< no edge up to this length is halved, a quarter where interpolation is far off
  /// Points that are gathered. Where the lightmap alone has more, those of the smallest elements are left to the
  /// caller, who knows what their element receives; else no element is halved beyond.
  std::size_t most_points = 400'000;
  GatherQuality quality;
  /// Taken instead, the first that fits, where the deadline comes too early for `quality`.
  std::vector<GatherQuality> coarser{};
  std::uint64_t seed = 1;
};

/// P x channels, by point of the mesh [W/m2].
struct VertexField {
  Field E;
  Field delta_light;              ///< part of E: from luminaires and suns, by shadow rays only
  Field layers;                   ///< P x lanes, E by layer; empty unless they were asked for
  Field delta_layers;             ///< part of layers, as delta_light of E
  std::vector<double> std_error;  ///< P, standard error of E, luminous mean
  unsigned long long rays = 0;
  std::size_t alike = 0;    ///< points that took the light of another beside them, but for sun and luminaires
  std::vector<bool> known;  ///< P, false: not gathered, E holds nothing
  bool complete = true;     ///< false: the monitor stopped it
  bool in_time = true;      ///< false: the deadline left time for a coarser quality only, or for fewer halves
};

/// Final gather at all points of the mesh, then halves elements, gathers the new points, and looks again.
///
/// What interpolation leaves out is told by how the gradient, averaged around each point, turns from one end of an edge
/// to the other: (g_b - g_a) . (b - a) / 8 is how far the middle lies off the straight line; where corners differ much,
/// at least a quarter of that, as a shadow may lie between them. What is less than the noise of its corners is taken
/// for noise. Shadow edges never agree, so there the shortest edge decides.
///
/// The worst elements are halved first: those of most error times the root of their area, as they add to a mean square.
/// In no round do more than half of the points that are left go, so these are halved again before others are at all.
///
/// With a deadline the quality is one by which all points of the lightmap and half as many more seem to be done by
/// then, and the worst elements are halved first, as many as there seems to be time for.
///
/// problem     with the patches that B belongs to; mesh: halves of theirs, or of what they are halves of.
/// layers      null, or layers that sum to this light: what each gives, by the same rays at the same points.
/// slit_light  of the same patches, or empty: it is found where it is needed.
/// fine        null, or made for the same patches on this mesh: what leaves them near a point, which it learns from the
///             vertices as they become known.
/// Threads: same bits for any thread count. Cost: 0.03 (standard) to 0.15 ms (fine) a point and core.
/// Source of the estimate: Zienkiewicz & Zhu, "A simple error estimator and adaptive procedure for practical
/// engineering analysis", 1987.
VertexField gather_field(const Problem& problem, const Field& B, ElementMesh& mesh, const FieldOptions& options,
                         const Monitor& monitor = {}, const RowLight* layers = nullptr,
                         const SlitLight& slit_light = {}, FineRadiosity* fine = nullptr);

}  // namespace clerestory
