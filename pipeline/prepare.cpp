#include "pipeline/prepare.h"

#include <cmath>
#include <limits>
#include <utility>

#include "meshing/build_patches.h"
#include "meshing/make_lightmap.h"
#include "pipeline/lap.h"
#include "pipeline/panel_hints.h"
#include "pipeline/parts_of_light.h"
#include "pipeline/scene_checks.h"
#include "pipeline/wording.h"
#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/place_lights.h"
#include "solver/model/error.h"
#include "solver/run/accuracy.h"
#include "solver/run/memory_estimate.h"
#include "solver/spaces/rooms.h"

namespace clerestory {
namespace {

LitSides all_sides(const PatchSet& patches) { return {std::vector<bool>(2 * patches.triangle_count(), true), {}}; }

/// That was asked for, shorter each time that the effort was raised.
std::optional<double> longest_edge(const Settings& s) {
  if (!s.max_element) return {};
  return *s.max_element * std::pow(kTighterEdge, s.solve.tighten);
}

/// Surfaces and rays; `lights` becomes as grey as these are. Nothing when interrupted.
std::optional<Prepared> surfaces_of(std::optional<double> fit_triangles, const Scene& scene, const Settings& settings,
                                    const Monitor& monitor, LightSpec& lights, StageSeconds& seconds) {
  Lap lap;
  MeshedScene meshed = build_patches(scene,
                                     {.max_element = longest_edge(settings),
                                      .detail = settings.detail,
                                      .target_triangles = target_triangles(settings.solve),
                                      .fit_triangles = fit_triangles},
                                     monitor);
  PatchSet& patches = meshed.patches;
  patches.channels = settings.channels.value_or(scene.channels());
  lap.add_to(seconds.mesh);
  if (monitor.is_interrupted()) return {};

  if (patches.channels == 1) make_grey(patches.materials), make_grey(lights);
  RayScene rays(patches);
  lap.add_to(seconds.build);
  return Prepared{std::move(patches), meshed.report, std::move(rays), {}, {}};
}

std::optional<Prepared> prepare_in(std::optional<double> fit_triangles, const Scene& scene, const Settings& settings,
                                   const Monitor& monitor, StageSeconds& seconds) {
  LightSpec lights = scene.lights;
  std::optional<Prepared> prepared = surfaces_of(fit_triangles, scene, settings, monitor, lights, seconds);
  if (!prepared) return {};
  Lap lap;
  Prepared& p = *prepared;
  p.lights = place_lights(lights, p.patches, p.rays);
  p.lit_sides = has_light(scene) ? find_lit_sides(p.problem(), settings.solve.seed, monitor) : all_sides(p.patches);
  make_patches(p.patches, p.lit_sides.wanted);
  if (!p.lit_sides.space.empty())
    for (std::size_t i = 0; i < p.patches.patch_count(); ++i)
      p.patches.space.push_back(p.lit_sides.space[2 * p.patches.triangle[i] + p.patches.side[i]]);
  lap.add_to(seconds.build);
  return prepared;
}

/// Memory that a limit leaves for the solve, when the model has been read.
std::size_t memory_after_reading(std::size_t limit, const MeshReport& repairs) {
  const std::size_t reading = predicted_memory({repairs.input_triangles}) - predicted_memory({});
  return limit > reading ? limit - reading : 1;
}

[[noreturn]] void refuse_memory(const Scene& scene, std::size_t needed, std::size_t limit) {
  throw InputError(scene.file + ": needs about " + bytes(needed) + ", more than the memory limit of " + bytes(limit) +
                   "; raise --memory-limit, or leave out detail of the model.");
}

/// Rooms, points to show the light on, and caustics.
std::optional<PreparedToSolve> with_points(std::optional<Prepared> prepared, const Scene& scene,
                                           const SolveOptions& options, const Monitor& monitor, StageSeconds& seconds) {
  if (!prepared) return {};
  if (prepared->patches.patch_count() == 0) {
    std::string why = scene.file + ": no light reaches any surface; move or aim the lights at the model.";
    for (const std::string& hint : hints_about_panels(prepared->problem())) why += " The " + hint;
    throw InputError(why);
  }
  Lap lap;
  Rooms rooms = find_rooms(prepared->problem(), {scene.spaces, scene.rooms}, monitor);
  prepared->patches.room = std::move(rooms.of_patch);
  prepared->patches.rooms = std::move(rooms.names);
  VertexLightmap map = make_lightmap(prepared->patches);
  const Effort e = effort(options.accuracy, options.tighten);
  prepared->lights.caustics = find_caustics(prepared->problem(), static_cast<std::size_t>(e.caustic_particles),
                                            static_cast<std::size_t>(e.caustic_legs), options.seed, monitor,
                                            options.method != Method::bidirectional);
  lap.add_to(seconds.build);
  return PreparedToSolve{std::move(*prepared), std::move(map)};
}

}  // namespace

std::optional<Prepared> prepare(const Scene& scene, const Settings& settings, const Monitor& monitor,
                                StageSeconds& seconds) {
  return prepare_in({}, scene, settings, monitor, seconds);
}

std::optional<Prepared> prepare_for_rays(const Scene& scene, const Settings& settings, const Monitor& monitor) {
  StageSeconds seconds;
  LightSpec lights = scene.lights;
  std::optional<Prepared> p = surfaces_of({}, scene, settings, monitor, lights, seconds);
  if (!p) return {};
  p->lights = place_lights_for_shadows(lights, p->patches, p->rays);
  p->lit_sides = all_sides(p->patches);
  make_patches(p->patches, p->lit_sides.wanted);
  return p;
}

std::optional<PreparedToSolve> prepare_to_solve(const Scene& scene, Settings& settings, Observer& observer,
                                                const Monitor& monitor, StageSeconds& seconds) {
  if (!settings.memory_limit)
    return with_points(prepare(scene, settings, monitor, seconds), scene, settings.solve, monitor, seconds);
  const std::size_t limit = *settings.memory_limit, faces = scene.polygons.face_count();
  const double asked = longest_edge(settings).value_or(0), wanted = target_triangles(settings.solve);
  std::size_t fit = triangles_that_fit(faces, limit);
  if (fit == 0) refuse_memory(scene, least_memory({faces, faces, faces, faces, faces}), limit);
  for (std::size_t last = std::numeric_limits<std::size_t>::max();; fit /= 2) {
    auto p = with_points(prepare_in(static_cast<double>(fit), scene, settings, monitor, seconds), scene, settings.solve,
                         monitor, seconds);
    if (!p) return {};
    const auto& [patches, repairs, rays, lights, lit_sides] = p->scene;
    settings.solve.memory_limit = memory_after_reading(limit, repairs);
    const std::size_t layers = parts_of_light(scene, settings, lights, patches).size();
    const std::size_t lanes = layers * static_cast<std::size_t>(patches.channels);
    if (has_memory_for(patches, p->lightmap, lanes, settings.solve)) {
      const bool coarser = asked > 0 ? repairs.max_element > 1.01 * asked : static_cast<double>(fit) < wanted;
      if (coarser)
        observer.warn("coarser than asked for, to stay below the memory limit of " + bytes(limit) +
                      ": elements of up to " + rounded(repairs.max_element) + " m" +
                      (asked > 0 ? " instead of " + rounded(asked) + " m." : "."));
      return p;
    }
    const std::size_t triangles = repairs.triangles, sides = patches.patch_count();
    if (triangles > last / 10 * 9)
      refuse_memory(
          scene,
          least_memory({repairs.input_triangles, triangles, sides, sides, p->lightmap.position.size(), 0, lanes}),
          limit);
    last = triangles;
  }
}

}  // namespace clerestory
