#pragma once
// Problem -> solved patches, irradiance at sensors and measured errors, by the method and accuracy asked for.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "solver/illumination/problem.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/kept_transport.h"
#include "solver/methods/layered_field.h"
#include "solver/model/hierarchy_debug.h"
#include "solver/model/laws.h"
#include "solver/model/method.h"
#include "solver/model/monitor.h"
#include "solver/model/point_irradiance.h"
#include "solver/model/sensors.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"

namespace clerestory {

/// A room that was good enough at an earlier, coarser level: its elements need not be smaller than there.
struct RoomLevel {
  std::string room;  ///< PatchSet::rooms
  Accuracy accuracy;
  int tighten;
  double longest_edge;  ///< of the mesh then [m]
};

struct SolveOptions {
  Method method = Method::hierarchical;
  Accuracy accuracy = Accuracy::standard;
  /// With a deadline a draft by the hierarchical method ends with its elements where they tell that the time is enough
  /// for a finer level, up to this, from the start: SolvedPatches::rather.
  Accuracy at_most = Accuracy::draft;
  Oracle oracle = Oracle::error;  ///< of the hierarchical method
  std::uint64_t seed = 1;
  std::size_t memory_limit = 0;  ///< the peak of the process stays below by making the result coarser [bytes]; 0: none
  bool check_laws = false;       ///< fill SolvedPatches::laws
  int tighten = 0;               ///< times that the effort was raised to reach a target error (accuracy.h)
  std::vector<RoomLevel> good_rooms{};  ///< of the hierarchical method
};

/// Triangles to aim for when no longest edge is given; twice as many each time that the effort was raised.
double target_triangles(const SolveOptions& options);

/// Whether a limit of memory leaves room for a solve on these patches, matrices aside.
///
/// lanes  layers x channels of layers that are asked for; 0: none are.
bool has_memory_for(const PatchSet& patches, const VertexLightmap& map, std::size_t lanes, const SolveOptions& options);

struct SolvedPatches {
  PatchSet elements;        ///< leaf elements, each on a triangle of its own; empty: they are the problem's patches
  VertexLightmap lightmap;  ///< of the elements, E filled
  Solution solution;        ///< of the elements
  Accuracy shown =
      Accuracy::draft;  ///< level of the gathers at vertices: with a deadline finer than the elements', perhaps
  std::optional<Accuracy> rather{};  ///< SolveOptions::at_most; if so, all else is empty
  std::vector<LawCheck> laws{};      ///< by check_laws.h; empty unless asked for
  LayeredField layers{};             ///< empty unless asked for, and where there was no time for them
};

/// What a solve must know of what its caller does before and after it, and what it leaves for that.
struct AroundSolve {
  // Looked at where there is a deadline.
  std::span<const SensorPoint> sensors{};  ///< of irradiance_at_sensors(), by the same deadline
  double seconds_before = 0;               ///< to prepare the patches
  // Of the hierarchical method.
  /// What vertices are gathered with, where the caller gathers there again and needs the places alone; empty: as the
  /// accuracy has it.
  std::optional<GatherQuality> vertices{};
  std::span<const Layer> layers{};  ///< parts that sum to the light of the problem; all else keeps its bits
  KeptTransport* keep = nullptr;    ///< filled with the transport, where nothing stopped it and no laws are checked
  HierarchyDebug* debug = nullptr;  ///< filled where it is there; nothing is computed for it otherwise
};

/// Solves by the method asked for, and shows the result at vertices.
///
/// map           the lightmap of problem.patches.
/// longest_edge  of the patches [m]; the hierarchical method halves them down to a share of it.
/// throws        InputError when the method needs more memory than there is, or cannot do what the scene has;
///               std::logic_error when a value comes out negative or as no number: nobody shall see it.
/// Stops early when the monitor says so, and returns what is solved so far, marked in Solution::stop; vertices that
/// were not reached then show the mean of their elements. With a deadline fewer rays are sent rather than that; where
/// that was so, Solution::stop tells. Threads: same bits for any thread count.
SolvedPatches solve(const Problem& problem, VertexLightmap map, double longest_edge, const SolveOptions& options,
                    const Monitor& monitor = {}, const AroundSolve& around = {});

/// The first half of that for any method but the hierarchical one, which makes elements of its own: radiosity and
/// irradiance of every patch.
///
/// keep_matrix  null, or where a method that has a matrix leaves it.
Solution solve_on_patches(const Problem& problem, const SolveOptions& options, const Monitor& monitor = {},
                          FormFactorMatrix* keep_matrix = nullptr);

/// Irradiance at each sensor point itself, by gather_point(), or by paths where these are the method. When the monitor
/// stops it, rough values are looked up at the elements; where a second is not enough for all points, the answer is not
/// complete.
///
/// problem  with the elements that the solution belongs to. points: in the scene's frame.
/// layers   null, or those that sum to its light, with their radiosity: PointIrradiance::layers, but by paths.
PointIrradiance irradiance_at_sensors(const Problem& problem, const Solution& solution,
                                      std::span<const SensorPoint> points, const SolveOptions& options,
                                      const Monitor& monitor = {}, const RowLight* layers = nullptr);

}  // namespace clerestory
