#pragma once
// Solution -> .vtp for ParaView. VTK stays inside.

#include <filesystem>

#include "io/atomic_file.h"
#include "io/run_report.h"
#include "solver/model/layered_light.h"
#include "solver/model/patch_set.h"
#include "solver/model/scene_around.h"
#include "solver/model/solution.h"
#include "solver/model/vertex_lightmap.h"
#include "solver/model/written_result.h"

namespace clerestory {

/// Writes the patches as one-sided triangles, oriented by vertex order, in the scene's frame: into a file that the
/// caller commits, or a whole one.
///
/// Cells and points: irradiance, radiosity [W/m2], illuminance [lx], luminance [cd/m2]; daylight_factor [%] when there
/// is a reference for it. Cells only: material, surface, level, area [m2], and irradiance_std_error [W/m2] when the
/// solution has it. Field data: the report's repeatable figures and its text, the tables material_names and
/// surface_names, and what is around the surfaces. Layers have arrays of their own, see WrittenResult. Equal solutions
/// give equal bytes.
///
/// layers  of around.layers, in that order; empty where there are none.
/// throws  InputError when the file cannot be written; std::runtime_error when a value is not finite.
void write_result(AtomicFile& file, const PatchSet& patches, const VertexLightmap& lightmap, const Solution& solution,
                  const SceneAround& around, const RunReport& report, const LayeredLight& layers = {});
void write_result(const std::filesystem::path& file, const PatchSet& patches, const VertexLightmap& lightmap,
                  const Solution& solution, const SceneAround& around, const RunReport& report);

/// The same of a result as it stands in a file, with another report; its texts and figures are those of the report.
void write_result(AtomicFile& file, const WrittenResult& result, const RunReport& report);

/// Writes the patches before a solve, with quality: min_angle [deg], aspect (longest edge / its height, 1.15 when
/// equilateral), longest_edge [m], area [m2], material, surface.
void write_patches(AtomicFile& file, const PatchSet& patches, const RunReport& report);
void write_patches(const std::filesystem::path& file, const PatchSet& patches, const RunReport& report);

}  // namespace clerestory
