#pragma once
// All that a solve leaves behind.

#include <cstddef>
#include <optional>
#include <vector>

#include "pipeline/settings.h"
#include "solver/evaluate/measured_error.h"
#include "solver/lights/layers.h"
#include "solver/model/hierarchy_debug.h"
#include "solver/model/laws.h"
#include "solver/model/layered_light.h"
#include "solver/model/mesh_report.h"
#include "solver/model/patch_set.h"
#include "solver/model/scene_around.h"
#include "solver/model/solution.h"
#include "solver/model/stage_seconds.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/spaces/lit_sides.h"

namespace clerestory {

/// Parts of the light, which sum to all of it.
struct SolvedLayers {
  std::vector<Layer> layers;          ///< that were asked for
  LayeredLight light;                 ///< what they give; empty: there was no time
  Field sensor_E;                     ///< S x lanes [W/m2]; empty like Solved::sensor_E
  std::vector<EnergyBalance> energy;  ///< of each layer
};

/// Of one time of Scene::times; empty where it is dark, or was not measured.
struct ErrorAtTime {
  std::optional<MeasuredError> surfaces, sensors;
};

struct Solved {
  PatchSet patches;         ///< the elements
  VertexLightmap lightmap;  ///< of the elements, E filled
  Solution solution;        ///< of the elements
  Field sensor_E;  ///< S x channels, by sensor of all sets, one set after the other [W/m2]; empty: there was no time
  Field sensor_std_error;                             ///< of these; empty unless paths estimated them
  std::optional<MeasuredError> error, error_sensors;  ///< empty when not measured
  std::vector<LawCheck> laws;                         ///< empty unless asked for
  std::vector<PaneTriangle> panes;                    ///< glass and mirrors, which no patch is of
  std::size_t buried_sensors = 0;                     ///< inside solids: their error is not part of error_sensors
  MeshReport repairs;
  LitSides lit_sides;
  std::size_t openings = 0;           ///< through which the sky looks in
  HierarchyDebug debug;               ///< empty unless asked for
  SolvedLayers layers;                ///< empty unless asked for; of Scene::times one a time, its share of the mean
  std::vector<ErrorAtTime> error_at;  ///< by time; empty unless there are several
  Settings settings;                  ///< as they were in force for this result
  StageSeconds seconds;               ///< of all rounds
  std::optional<Accuracy> rather{};   ///< there is time for this level instead: nothing else is filled

  /// Stopped before there were patches to solve.
  bool empty() const { return patches.patch_count() == 0; }
};

/// Whether the target error is met for sure, in the worst room and the worst set of sensors: the measured error and
/// what is uncertain about it. True without a target.
bool meets_target(const Solved& solved);

/// Whether all laws hold that were checked. True when none was.
bool keeps_laws(const Solved& solved);
/// Whether no more than 1 % of the light went missing or was made.
bool keeps_its_light(const Solved& solved);

}  // namespace clerestory
