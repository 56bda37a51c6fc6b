#include "solver/run/solve.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "solver/gather/gather.h"
#include "solver/gather/gather_time.h"
#include "solver/illumination/caustic_legs.h"
#include "solver/illumination/caustic_light.h"
#include "solver/illumination/direct.h"
#include "solver/illumination/near_luminaires.h"
#include "solver/methods/form_factor_matrix.h"
#include "solver/methods/gauss_seidel.h"
#include "solver/methods/hierarchical_field.h"
#include "solver/methods/jacobi.h"
#include "solver/methods/near_points.h"
#include "solver/methods/noisy_patches.h"
#include "solver/methods/particles.h"
#include "solver/methods/path.h"
#include "solver/methods/progressive.h"
#include "solver/model/error.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/model/triangle_size.h"
#include "solver/paths/bidirectional.h"
#include "solver/paths/find_slit_gains.h"
#include "solver/paths/path_tracer.h"
#include "solver/paths/without_caustics.h"
#include "solver/run/accuracy.h"
#include "solver/run/check_laws.h"
#include "solver/run/level_in_time.h"
#include "solver/run/memory_estimate.h"
#include "solver/run/sound_result.h"
#include "solver/spaces/closure.h"

namespace clerestory {
namespace {

Effort effort_of(const SolveOptions& options) { return effort(options.accuracy, options.tighten); }

MemoryCounts whole(const PatchSet& patches, std::size_t points, std::size_t lanes = 0) {
  const std::size_t sides = patches.patch_count();
  return {.triangles = patches.triangle_count(), .sides = sides, .elements = sides, .points = points, .lanes = lanes};
}

/// How far the hierarchical method may go: as was asked for, or what a limit of memory leaves of it.
std::optional<MemoryPlan> memory_plan(const PatchSet& patches, const VertexLightmap& map, std::size_t lanes,
                                      const SolveOptions& options) {
  const Effort e = effort_of(options);
  const std::size_t points = map.position.size();
  const MemoryPlan wish{std::min(20 * points + 10'000, e.most_points), HierarchyOptions{}.most_elements, e.bundle_rays,
                        e.bright_rays};
  if (options.memory_limit == 0) return wish;
  return plan_memory(whole(patches, points, lanes), wish, options.memory_limit);
}

FormFactorOptions matrix_options(const PatchSet& patches, const SolveOptions& options) {
  FormFactorOptions matrix{.seed = options.seed};
  if (options.memory_limit > 0) {
    const std::size_t rest = predicted_memory(whole(patches, patches.patch_count()));
    matrix.memory_limit = options.memory_limit > rest ? options.memory_limit - rest : 1;
  }
  return matrix;
}

/// Before anything is computed: what cannot be is no news to wait for.
void require_possible(const Problem& problem, const SolveOptions& options) {
  const bool by_matrix = has_matrix(options.method);
  const bool by_bf = options.method == Method::hierarchical && options.oracle == Oracle::bf;
  if (by_matrix) require_matrix_fits(problem.patches.patch_count(), matrix_options(problem.patches, options));
  if ((by_matrix || by_bf) && problem.rays.has_mirrors())
    throw InputError(
        "the scene has mirrors, which form factors do not see; use " +
        std::string(by_bf ? "--oracle error" : "--method hierarchical, progressive, path, bidirectional or particles"));
}

ParticleOptions particle_options(const SolveOptions& options) {
  return {.particles = effort_of(options).particles, .seed = options.seed};
}

/// A room is resolved as it would be alone, in a model of its faces and as many behind them; one that was good enough
/// before, as it was then.
ShortestEdge shortest_edges(const PatchSet& patches, double longest_edge, const Effort& e,
                            const SolveOptions& options) {
  ShortestEdge edges = e.shortest_edge * longest_edge;
  if (patches.rooms.empty()) return edges;
  std::vector<double> area(patches.rooms.size());
  for (std::size_t i = 0; i < patches.patch_count(); ++i) area[patches.room[i]] += patches.area[i];
  const auto in_room = [&](std::size_t room, const Effort& level, int tighten, double longest) {
    const double alone = std::pow(kTighterEdge, tighten) * longest_edge_for(level.triangles_to_halve, 2 * area[room]);
    return level.shortest_edge * std::min(longest, alone);
  };
  for (std::size_t k = 0; k < area.size(); ++k) edges.in_room.push_back(in_room(k, e, options.tighten, longest_edge));
  for (const RoomLevel& good : options.good_rooms) {
    const auto k = static_cast<std::size_t>(std::ranges::find(patches.rooms, good.room) - patches.rooms.begin());
    if (k == area.size()) continue;
    edges.in_room[k] =
        std::max(edges.in_room[k], in_room(k, effort(good.accuracy, good.tighten), good.tighten, good.longest_edge));
  }
  return edges;
}

/// Qualities of the levels below, the finest first.
std::vector<GatherQuality> coarser_than(const SolveOptions& options, GatherQuality Effort::*quality) {
  std::vector<GatherQuality> coarser;
  if (options.accuracy == Accuracy::fine) coarser.push_back(effort(Accuracy::standard, options.tighten).*quality);
  if (options.accuracy != Accuracy::draft) coarser.push_back(effort(Accuracy::draft, options.tighten).*quality);
  return coarser;
}

SolvedPatches solve_by_hierarchy(const Problem& problem, VertexLightmap map, double longest_edge,
                                 const SolveOptions& options, const Monitor& monitor, const AroundSolve& around,
                                 KeptTransport* keep) {
  require_possible(problem, options);
  const Effort e = effort_of(options);
  const MemoryPlan plan =
      memory_plan(problem.patches, map, around.layers.size() * static_cast<std::size_t>(problem.patches.channels),
                  options)
          .value_or(kLeastPlan);
  const auto vertices_of = [&](const SolveOptions& level) {
    const Effort of_level = effort_of(level);
    return FieldOptions{.tolerance = of_level.vertex_tolerance,
                        .shortest_edge = shortest_edges(problem.patches, longest_edge, of_level, options),
                        .most_points = plan.most_points,
                        .quality = around.vertices.value_or(of_level.vertices),
                        .coarser = coarser_than(level, &Effort::vertices),
                        .seed = options.seed};
  };
  const FieldOptions vertices = vertices_of(options);
  const Gathers sensors{around.sensors.size(), sensor_points(around.sensors, problem.patches.origin, problem.rays),
                        e.sensors};
  Accuracy rather = options.accuracy, shown = options.accuracy;
  const double left_at_start = monitor.seconds_left();
  const auto goes_on = [&](const Problem& elements, const Solution& solution,
                           const VertexLightmap& points) -> std::optional<FieldOptions> {
    const bool hurries = monitor.has_deadline() && options.accuracy == Accuracy::draft;
    if (!hurries || options.at_most == Accuracy::draft) return vertices;
    const double left = monitor.seconds_left(), took = around.seconds_before + left_at_start - left;
    const LevelsInTime levels =
        levels_in_time({elements, solution, points, sensors, took, left, options.at_most, options.seed});
    rather = levels.from_the_start;
    if (rather > options.accuracy) return {};
    SolveOptions level = options;
    level.accuracy = shown = levels.from_here;
    return vertices_of(level);
  };
  HierarchicalFieldOptions how;
  how.vertices = vertices;
  how.later = sensors;
  how.goes_on = goes_on;
  how.layers = around.layers;
  how.elements.oracle = options.oracle;
  how.elements.bundle_rays = plan.bundle_rays;
  how.elements.bright_rays = plan.bright_rays;
  how.elements.tolerance = e.element_tolerance;
  how.elements.shortest_edge = vertices.shortest_edge;
  how.elements.most_elements = plan.most_elements;
  how.elements.seed = options.seed;
  how.elements.debug = around.debug;
  how.elements.keep = keep;
  HierarchicalField field = hierarchical_field(problem, std::move(map), how, monitor);
  if (!field.went_on) return {{}, {}, {}, shown, rather};
  SolvedPatches solved{std::move(field.elements), std::move(field.lightmap), std::move(field.solution), shown};
  solved.layers = std::move(field.layers);
  return solved;
}

/// The matrix methods know light as it arrives; a luminaire's flux that misses the patches belongs to the balance too.
void count_luminaires(EnergyBalance& energy, const PatchSet& patches, const DirectLight& direct) {
  energy += direct.energy;
  energy.emitted -= total_flux(patches, direct.E);  // what arrived of it is in there already
}

std::vector<std::uint32_t> numbers_of(const std::vector<bool>& chosen) {
  std::vector<std::uint32_t> numbers;
  for (std::uint32_t i = 0; i < chosen.size(); ++i)
    if (chosen[i]) numbers.push_back(i);
  return numbers;
}

/// use(estimator), of a method by paths.
template <class Use>
auto with_paths(const Illumination& light, Method method, const Use& use) {
  if (method == Method::path) return use(PathEstimator(light));
  const Bidirectional both(light);
  return use(both.estimator());
}

/// Of the receivers themselves, which paths do not find.
void add_caustics(const Problem& problem, const PointOf& point_of, PointIrradiance& at) {
  const CausticIrradiance found = caustic_irradiance(problem, at.done, point_of);
  for (std::size_t i = 0; i < at.done; ++i) {
    at.E.add(i, found.E[i]);
    for (int c = 0; c < at.E.channels; ++c)
      at.std_error.at(i, c) = std::hypot(at.std_error.at(i, c), std::sqrt(found.variance[i]));
  }
}

/// Irradiance at places by the method of the solution.
PointIrradiance irradiance_at(const Problem& problem, const Solution& solution, std::size_t count,
                              const PointOf& point_of, const GatherQuality& quality, int paths, Stream stream,
                              std::string_view stage, const SolveOptions& options, const Monitor& monitor,
                              const RowLight* layers = nullptr) {
  if (is_by_paths(options.method)) {
    const WithoutCaustics apart(problem);
    const Illumination light(apart.problem());
    PointIrradiance at = with_paths(light, options.method, [&](const PathEstimator& estimator) {
      return trace_paths_at(estimator, count, point_of, paths, stream_key(options.seed, stream), stage, monitor);
    });
    if (!problem.lights.caustics.legs.empty()) add_caustics(problem, point_of, at);
    return at;
  }
  return gather_at(gather_illumination_by_slits(problem, solution.B, solution.slit_light, options.seed, monitor), count,
                   point_of, GatherPattern(quality, options.seed), stage, monitor, layers);
}

/// The quality of this level, or what a deadline leaves of it.
GatherQuality quality_until(const Monitor& monitor, const Problem& problem, const Solution& solution,
                            const Gathers& gathers, const SolveOptions& options, GatherQuality Effort::*quality) {
  const GatherQuality wanted = effort_of(options).*quality;
  if (!monitor.has_deadline() || is_by_paths(options.method) || gathers.count == 0) return wanted;
  std::vector<GatherQuality> qualities{wanted};
  for (const GatherQuality& coarser : coarser_than(options, quality)) qualities.push_back(coarser);
  const Illumination light =
      gather_illumination_by_slits(problem, solution.B, solution.slit_light, options.seed, monitor);
  return quality_in_time(light, gathers, qualities, monitor.seconds_left(), options.seed);
}

/// What stopped solves take to show a rough value at their sensors, when they are more than take that long.
constexpr std::chrono::seconds kTimeForSensors{1};
constexpr std::size_t kQuickSensors = 2'000;

}  // namespace

double target_triangles(const SolveOptions& options) {
  const Effort e = effort(options.accuracy);
  return std::ldexp(options.method == Method::hierarchical ? e.triangles_to_halve : e.triangles, options.tighten);
}

bool has_memory_for(const PatchSet& patches, const VertexLightmap& map, std::size_t lanes,
                    const SolveOptions& options) {
  if (options.method == Method::hierarchical) return memory_plan(patches, map, lanes, options).has_value();
  return options.memory_limit == 0 || predicted_memory(whole(patches, map.position.size())) <= options.memory_limit;
}

Solution solve_on_patches(const Problem& problem, const SolveOptions& options, const Monitor& monitor,
                          FormFactorMatrix* keep_matrix) {
  const Effort e = effort_of(options);
  require_possible(problem, options);
  const Illumination light(problem);
  if (options.method == Method::particles) return trace_particles(light, particle_options(options), nullptr, monitor);
  DirectOptions direct_options = e.direct;
  direct_options.seed = options.seed;
  const DirectLight direct = direct_light(light, direct_options, monitor);
  const auto closure = [&] {
    constexpr int kLate = 16;
    monitor.report("closure", 0);
    return measure_closure(problem, monitor.should_stop() ? kLate : e.closure_rays, options.seed);
  };
  if (is_by_paths(options.method) || options.method == Method::progressive) {
    const Closure of_patches = closure();
    monitor.say_result();  // direct light, and an estimate of what follows from it
    if (is_by_paths(options.method)) {
      const WithoutCaustics apart(problem);
      const bool adds_caustics = !problem.lights.caustics.legs.empty();
      const Field caustics = adds_caustics ? caustics_on_patches(problem, problem.lights.caustics.legs) : Field{};
      const Illumination of_paths(apart.problem());
      return with_paths(of_paths, options.method, [&](const PathEstimator& estimator) {
        return path_trace(problem, estimator, kMethodNames[static_cast<std::size_t>(options.method)], direct,
                          of_patches, {e.paths, options.seed, adds_caustics ? &caustics : nullptr}, monitor);
      });
    }
    constexpr double kFewestRays = 64;  // a patch met by fewer is known to worse than 12 %
    Solution solution =
        shoot(problem, direct, of_patches,
              {.stop_fraction = e.stop_fraction, .rays_per_patch = e.rays_per_patch, .seed = options.seed}, monitor);
    const std::size_t gathered =
        gather_noisy_patches(problem, solution, kFewestRays, e.noisy_patches, options.seed, monitor);
    solution.log.push_back(std::to_string(gathered) + " patches met by few rays, gathered");
    return solution;
  }
  FormFactorMatrix F =
      form_factor_matrix(problem.patches, problem.rays, matrix_options(problem.patches, options), monitor);
  monitor.say_result();
  const auto gather = options.method == Method::jacobi ? jacobi : gauss_seidel;
  Solution solution = gather(problem.patches, F, direct.E, {}, monitor);
  count_luminaires(solution.energy, problem.patches, direct);
  solution.rays += direct.rays + F.rays;
  if (keep_matrix) *keep_matrix = std::move(F);
  return solution;
}

namespace {

/// What a deadline must leave for vertices after the patches: means of patches show far less.
double seconds_for_vertices(const Problem& problem, const Gathers& vertices, const SolveOptions& options, double left) {
  constexpr double kMost = 0.4, kLonger = 1.5;  // than gathers that know of no reflected light
  if (!std::isfinite(left)) return 0;
  const auto n = static_cast<double>(vertices.count);
  if (is_by_paths(options.method)) return left * n / (n + static_cast<double>(problem.patches.patch_count()));
  return std::min(kMost * left, kLonger * n * seconds_a_gather(Illumination(problem), vertices, options.seed));
}

SolvedPatches solve_by_other_method(const Problem& problem, VertexLightmap map, const SolveOptions& options,
                                    const Monitor& monitor, FormFactorMatrix* keep_matrix) {
  if (options.method == Method::particles) {
    SolvedPatches solved{{}, std::move(map), {}, options.accuracy};
    solved.solution = trace_particles(Illumination(problem), particle_options(options), &solved.lightmap, monitor);
    return solved;
  }
  const Effort e = effort_of(options);
  const auto gathers_at = [&](const VertexLightmap& m) {
    return Gathers{m.sample_position.size(), sample_points(m, problem.rays), e.vertices};
  };
  const double left = monitor.seconds_left();
  const Monitor for_patches = e.gathers_vertices
                                  ? monitor.within(left - seconds_for_vertices(problem, gathers_at(map), options, left))
                                  : monitor;
  SolvedPatches solved{
      {}, std::move(map), solve_on_patches(problem, options, for_patches, keep_matrix), options.accuracy};
  VertexLightmap& lightmap = solved.lightmap;
  Solution& solution = solved.solution;
  average_to_points(problem.patches, solution.E, lightmap);
  if (!e.gathers_vertices || monitor.should_stop()) return solved;
  const Gathers gathers = gathers_at(lightmap);
  const PointIrradiance at_samples =
      irradiance_at(problem, solution, gathers.count, gathers.place,
                    quality_until(monitor, problem, solution, gathers, options, &Effort::vertices), e.paths,
                    kPathsOfSample, "vertices", options, monitor);
  set_points(at_samples, lightmap);
  const std::vector<std::uint32_t> near = numbers_of(patches_near_luminaires(problem.patches, problem.lights));
  carry_flux_to_points(problem.patches, solution.E, near, lightmap);
  solution.rays += at_samples.rays;
  return solved;
}

}  // namespace

SolvedPatches solve(const Problem& problem, VertexLightmap map, double longest_edge, const SolveOptions& options,
                    const Monitor& monitor, const AroundSolve& around) {
  UsedTransport used;
  KeptTransport* const keep_links = options.check_laws ? &used.links : around.keep;
  FormFactorMatrix* const keep_matrix = options.check_laws ? &used.matrix : nullptr;
  constexpr double kShareToCheck = 0.1;  // of the time that is left
  const Monitor solving = options.check_laws ? monitor.within((1 - kShareToCheck) * monitor.seconds_left()) : monitor;
  SolvedPatches solved =
      options.method == Method::hierarchical
          ? solve_by_hierarchy(problem, std::move(map), longest_edge, options, solving, around, keep_links)
          : solve_by_other_method(problem, std::move(map), options, solving, keep_matrix);
  if (solved.rather) return solved;
  if (options.check_laws) {
    const PatchSet& elements = solved.elements.patch_count() > 0 ? solved.elements : problem.patches;
    solved.laws = check_laws({elements, problem.rays, problem.lights}, problem, solved.lightmap, solved.solution, used,
                             options, monitor);
  }
  require_sound(solved.solution.E, "irradiance of the elements");
  require_sound(solved.solution.B, "radiosity of the elements");
  require_sound(solved.lightmap.E, "irradiance at the points");
  require_sound(solved.layers.E, "irradiance of the layers at the points");
  require_sound(solved.layers.E_elements, "irradiance of the layers on elements");
  require_sound(solved.layers.B, "radiosity of the layers");
  return solved;
}

PointIrradiance irradiance_at_sensors(const Problem& problem, const Solution& solution,
                                      std::span<const SensorPoint> points, const SolveOptions& options,
                                      const Monitor& monitor, const RowLight* layers) {
  const PointOf point_of = sensor_points(points, problem.patches.origin, problem.rays);
  const Effort e = effort_of(options);
  SolveOptions finest = options;
  finest.accuracy = std::max(options.accuracy, options.at_most);
  PointIrradiance at_points =
      irradiance_at(problem, solution, points.size(), point_of,
                    quality_until(monitor, problem, solution, {points.size(), point_of}, finest, &Effort::sensors),
                    e.paths_of_sensor, kPathsOfSensor, "sensors", options, monitor, layers);
  if (!at_points.complete()) {
    // Paths have no bound on their length; looking at the elements has one, and serves any method when time is up.
    Monitor patient;
    patient.progress = monitor.progress;
    if (points.size() > kQuickSensors) patient.deadline = std::chrono::steady_clock::now() + kTimeForSensors;
    const GatherPattern rough(effort(Accuracy::draft, options.tighten).sensors, options.seed);
    at_points = gather_at(gather_illumination_by_slits(problem, solution.B, solution.slit_light, options.seed, patient),
                          points.size(), point_of, rough, "sensors", patient, layers);
  }
  require_sound(at_points.E, "irradiance at the sensors");
  require_sound(at_points.layers, "irradiance of the layers at the sensors");
  return at_points;
}

}  // namespace clerestory
