#include "solver/run/check_laws.h"

#include <algorithm>
#include <string>

#include "solver/evaluate/light_laws.h"
#include "solver/evaluate/transport_laws.h"
#include "solver/model/random_stream.h"
#include "solver/model/streams.h"
#include "solver/run/accuracy.h"
#include "solver/spaces/closure.h"

namespace clerestory {
namespace {

/// Means of rooms are better than values between vertices, by this.
constexpr double kOfMeans = 0.2;
constexpr double kHalf = 0.5;

LawCheck not_checked(Law law, std::string why) { return {law, {}, std::move(why)}; }

int rays_per_patch(std::size_t patches) {
  constexpr double kAll = 4e6;
  return std::clamp(static_cast<int>(kAll / static_cast<double>(std::max<std::size_t>(patches, 1))), 8, 256);
}

}  // namespace

std::vector<LawCheck> check_laws(const Problem& problem, const Problem& unhalved, const VertexLightmap& lightmap,
                                 const Solution& solution, const UsedTransport& used, const SolveOptions& options,
                                 const Monitor& monitor) {
  std::vector<LawCheck> laws;
  monitor.report("laws", 0);
  const bool has_links = used.links.complete, has_matrix = used.matrix.complete && used.matrix.n > 0;
  if (monitor.should_stop() || !(has_links || has_matrix)) {
    const bool has_none =
        is_by_paths(options.method) || options.method == Method::progressive || options.method == Method::particles;
    const std::string why =
        has_none ? "the method keeps no form factors" : "the solve was stopped before its form factors were complete";
    laws = {not_checked(Law::reciprocity, why), not_checked(Law::row_sums, why)};
  } else {
    const PatchSet& patches = has_links ? used.links.elements : problem.patches;
    const int rays = rays_per_patch(patches.patch_count());
    // A half of the time each, of what is left: to add up, for rays, and what remains for energy.
    const auto half = [&] { return monitor.within(kHalf * monitor.seconds_left()); };
    laws.push_back(has_links ? reciprocity_of_links(patches, used.links.tree, used.links.transport, half())
                             : reciprocity_of_matrix(patches, used.matrix, half()));
    const Closure closure =
        measure_closure({patches, problem.rays, problem.lights}, rays, stream_key(options.seed, kLawClosure), half());
    if (!closure.complete)
      laws.push_back(not_checked(Law::row_sums, "there was no time"));
    else
      laws.push_back(has_links ? row_sums_of_links(patches, used.links.tree, used.links.transport, closure, rays)
                               : row_sums_of_matrix(patches, used.matrix, closure, rays));
  }
  laws.push_back(no_negative_light(problem.patches, lightmap, solution));
  laws.push_back(radiosity_from_irradiance(problem.patches, solution));
  laws.push_back(monitor.should_stop()
                     ? not_checked(Law::energy, "the solve was stopped early")
                     : energy_of_rooms(problem, unhalved, solution,
                                       kOfMeans * effort(options.accuracy).vertex_tolerance, options.seed, monitor));
  return laws;
}

}  // namespace clerestory
